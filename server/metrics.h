#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "jobs/service.h"

namespace server {

/// What a monitoring system asks a service for, in the text format of Prometheus. All members may be called from any thread.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// A runner that also counts what the runs of another one take, by kind of links, and why they fail. Runs that were asked to stop
  /// are no jobs that have ended.
  /// @param runner  computes; this outlives what is returned
  [[nodiscard]] jobs::Runner measured(jobs::Runner runner);

  /// Counts a request that has been answered.
  /// @param route  pattern of the path, so that there are not as many as ids; empty: no route
  void add_request(const std::string& method, std::string_view route, int status, double seconds);

  /// Everything, with the load as it is now. @param executors  Service::list_executors()
  [[nodiscard]] std::string text(const jobs::Load& load, const nlohmann::json& executors = {{"items", nlohmann::json::array()}}) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace server
