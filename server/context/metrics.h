// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "jobs/parameters/job_spec.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/queue_stats.h"

namespace server {

/// Figures of a service for a monitoring system, in the text format of Prometheus. All members may be called
/// from any thread.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// Counts a run: what it took, by kind of links, and why it failed. One that was asked to stop is no job
  /// that has ended.
  void add_run(const jobs::JobSpec& spec, const jobs::RunRecord& run) noexcept;

  /// Counts a request that has been answered.
  /// @param route  pattern of the path, so that there are not as many as ids; empty: no route
  void add_request(const std::string& method, std::string_view route, int status, double seconds) noexcept;

  /// Everything, with the load as it is now. @param executors  Service::list_executors()
  [[nodiscard]] std::string text(const jobs::QueueStats& load, const nlohmann::json& executors = {
                                                             {"items", nlohmann::json::array()}}) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace server
