#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>

#include "jobs/service.h"
#include "server/copy_room.h"
#include "server/message.h"
#include "server/metrics.h"
#include "server/preference.h"

namespace server {

/// Answers requests: the one place that knows which route does what and which error is which status.
/// May be called from any thread.
class Routes {
 public:
  /// @param metrics  counts the requests
  explicit Routes(jobs::Service& service, std::shared_ptr<Metrics> metrics = std::make_shared<Metrics>());

  /// Whatever goes wrong becomes an answer of type application/problem+json.
  /// @throws std::bad_alloc only, if there is no memory even for that
  [[nodiscard]] Response answer(const Request& request) const;

  /// From now on nothing new is taken: whatever would change something is answered with 503, and /readyz too.
  void start_draining() { draining_ = true; }

 private:
  /// @param pattern  set to that of the route, if there is one
  [[nodiscard]] Response dispatch(const Request& request, std::string_view& pattern) const;

  jobs::Service& service_;
  std::shared_ptr<Metrics> metrics_;
  std::atomic<bool> draining_ = false;
  mutable WaitingRoom waiting_room_;
  mutable CopyRoom copy_room_;
};

/// What a route is called with.
struct Call {
  jobs::Service& service;
  const Request& request;
  std::string id;  ///< what stands in the place of {id} in the route's pattern
  bool draining;
  const Metrics& metrics;
  WaitingRoom& waiting_room;
  CopyRoom& copy_room;
};

/// True for a text that may be an id: 1 to 64 letters, digits, '-' or '_'.
[[nodiscard]] bool is_id(const std::string& text);

/// The client's Idempotency-Key, without the quotes that it may have; empty if there is none.
/// @throws HttpError 400 if it is empty or longer than 255 bytes, or has other than visible ASCII characters
[[nodiscard]] std::string find_key(const Request& request);

/// An answer that holds one JSON text.
[[nodiscard]] Response make_json(int status, std::string text);

}  // namespace server
