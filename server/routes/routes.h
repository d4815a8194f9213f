// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <shared_mutex>
#include <string>
#include <string_view>

#include "jobs/service.h"
#include "server/context/long_poll_limit.h"
#include "server/context/metrics.h"
#include "server/context/store_copy_limit.h"
#include "server/context/work_limit.h"
#include "server/messages/message.h"

namespace server {

struct Route;

/// @returns whether a request may take much memory or time: a table or an analysis, a study, a large body or
/// a large page of a listing
[[nodiscard]] bool is_heavy(const Route& route, const Request& request);

/// Answers requests: finds the route, calls its handler, and turns exceptions into answers. Thread-safe.
class Routes {
 public:
  /// @param metrics  counts the requests
  explicit Routes(jobs::Service& service, std::shared_ptr<Metrics> metrics = std::make_shared<Metrics>());

  /// Whatever goes wrong becomes an answer of type application/problem+json.
  /// @throws std::bad_alloc only, if there is no memory even for that
  [[nodiscard]] Response answer(const Request& request) const;

  /// Counts a request that was answered before it came to a route.
  void count_unrouted(const std::string& method, int status) const noexcept {
    metrics_->add_request(method, "", status, 0.0);
  }

  /// From now on nothing new is taken: whatever would change something is answered with 503, and /readyz too.
  void start_draining() { draining_ = true; }

  /// Permits of requests that wait for others, each of which holds a thread of the server.
  [[nodiscard]] WorkLimit& waiting_places() const { return waiting_places_; }

 private:
  /// Gives freed memory back to the system, if there is much of it.
  static void give_memory_back();
  /// @param pattern  set to that of the route, if there is one
  [[nodiscard]] Response dispatch(const Request& request, std::string_view& pattern) const;
  [[nodiscard]] Response run_route(const Route& route, const Request& request, std::string id) const;
  /// The same answer, with a permit to hold its body until it has been sent if that is large; or a refusal.
  [[nodiscard]] Response with_permit_to_send(Response answer) const;

  jobs::Service& service_;
  std::shared_ptr<Metrics> metrics_;
  std::atomic<bool> draining_ = false;
  /// Held during every change of what is there; with If-Match alone, from the look at it on
  mutable std::shared_mutex change_mutex_;
  mutable WorkLimit waiting_places_{20, 0};  // of the 32 threads that serve
  mutable LongPollLimit long_poll_limit_{waiting_places_};
  mutable StoreCopyLimit store_copy_limit_;
  // Each of these may take some 40 MB.
  mutable WorkLimit heavy_limit_{2, 20, give_memory_back, &waiting_places_};
  mutable WorkLimit stream_limit_{4, 0, give_memory_back};
  mutable WorkLimit export_limit_{2, 4, give_memory_back};
  mutable WorkLimit answer_limit_{8, 0, give_memory_back};
};

}  // namespace server
