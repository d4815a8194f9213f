#pragma once

#include <atomic>
#include <string>

#include "jobs/service.h"
#include "server/message.h"

namespace server {

/// Answers requests: the one place that knows which route does what and which error is which status.
/// May be called from any thread.
class Routes {
 public:
  explicit Routes(jobs::Service& service) : service_(service) {}

  /// Never throws: whatever goes wrong becomes an answer of type application/problem+json.
  [[nodiscard]] Response answer(const Request& request) const;

  /// From now on nothing new is taken: whatever would change something is answered with 503, and /readyz too.
  void start_draining() { draining_ = true; }

 private:
  [[nodiscard]] Response dispatch(const Request& request) const;

  jobs::Service& service_;
  std::atomic<bool> draining_ = false;
};

/// What a route is called with.
struct Call {
  jobs::Service& service;
  const Request& request;
  std::string id;  ///< what stands in the place of {id} in the route's pattern
  bool draining;
};

/// True for a text that may be an id: 1 to 64 letters, digits, '-' or '_'.
[[nodiscard]] bool is_id(const std::string& text);

/// An answer that holds one JSON text.
[[nodiscard]] Response make_json(int status, std::string text);

}  // namespace server
