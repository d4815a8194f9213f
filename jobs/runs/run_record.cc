// SPDX-License-Identifier: Apache-2.0
#include "jobs/runs/run_record.h"

#include <chrono>
#include <cmath>
#include <ctime>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/simulate_linkage.h"
#include "engine/simulate_rpsup.h"
#include "jobs/runs/job_limits.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {
namespace {

using nlohmann::json;

double thread_cpu_time_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

json metric_value(const engine::QuantityInfo& info, double value) {
  if (!std::isfinite(value)) return nullptr;
  return info.integer ? json(std::llround(value)) : json(value);
}

json metrics_json(const std::vector<double>& values, std::span<const engine::QuantityInfo> table) {
  if (values.size() != table.size())
    throw std::logic_error("the run has " + std::to_string(values.size()) + " metrics instead of " +
                           std::to_string(table.size()));
  json metrics = json::object();
  for (std::size_t i = 0; i < values.size(); ++i) metrics[table[i].key] = metric_value(table[i], values[i]);
  return metrics;
}

void take_trajectory(engine::Trajectory trajectory, RunRecord& record) {
  record.trajectory = std::move(trajectory);
  check_is_table(record.trajectory);
  // Single precision resolves a column to 6e-8 of itself; the metrics keep all their digits.
  for (engine::QuantityInfo& channel : record.trajectory.channels)
    channel.single_precision = channel.key != "t_s";
}

void take_result(engine::RunResult result, const JobSpec& spec, RunRecord& record) {
  take_trajectory(std::move(result.trajectory), record);
  if (result.status == engine::RunStatus::kSucceeded) {
    record.metrics = spec.linkage
                         ? metrics_json(result.metrics, engine::linkage_tables(*spec.linkage).metrics)
                         : metrics_json(result.metrics, engine::metric_table());
    return;
  }
  record.end =
      result.status == engine::RunStatus::kStopped ? RunRecord::End::kStopped : RunRecord::End::kFailed;
  record.error_reason = engine::status_name(result.status);
  record.error_detail = std::move(result.detail);
  record.error_t_s = result.t_end;
}

void take_exception(const char* reason, const std::string& what, RunRecord& record) {
  record.end = RunRecord::End::kFailed;
  record.error_reason = reason;
  // The text may come from anywhere; JSON takes UTF-8 only.
  record.error_detail = json::parse(json(what).dump(-1, ' ', false, json::error_handler_t::replace));
  record.trajectory = {};
}

/// Wall time since its construction.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void fail_for_time(double most_s, RunRecord& record) {
  record.end = RunRecord::End::kFailed;
  record.error_reason = "time_limit";
  record.error_detail = "the job was stopped after " + std::to_string(std::llround(most_s)) +
                        " s of computing, the most that this service allows";
}

}  // namespace

RunRecord run_and_record(const JobSpec& spec, const Runner& runner, const engine::StopQuery& stop_requested,
                         double most_s) {
  RunRecord record;
  const Stopwatch watch;
  bool late = false;
  const engine::StopQuery stopped_or_late = [&](double t) {
    if (stop_requested(t)) return true;
    late = most_s > 0.0 && watch.seconds() > most_s;
    return late;
  };
  const double cpu_start_s = thread_cpu_time_s();
  try {
    take_result(runner(spec, stopped_or_late), spec, record);
    if (!spec.keeps_trajectory) record.trajectory = {};
    if (late && record.end == RunRecord::End::kStopped) fail_for_time(most_s, record);
  } catch (const NeedsTooMuchMemory& error) {
    take_exception("memory_limit", error.what(), record);
  } catch (const std::bad_alloc&) {
    take_exception("memory_limit", "the machine had no memory left for this job", record);
  } catch (const std::exception& error) {
    take_exception("internal", error.what(), record);
  } catch (...) {
    take_exception("internal", "something was thrown that is no exception", record);
  }
  record.wall_time_s = watch.seconds();
  record.cpu_time_s = thread_cpu_time_s() - cpu_start_s;
  return record;
}

Runner engine_runner() {
  return [](const JobSpec& spec, const engine::StopQuery& stop_requested) {
    if (spec.linkage)
      return engine::simulate_linkage(*spec.linkage, spec.options, spec.parameters.run_up, stop_requested);
    return engine::simulate_rpsup(spec.parameters, spec.options, stop_requested);
  };
}

}  // namespace jobs
