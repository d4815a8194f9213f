// SPDX-License-Identifier: Apache-2.0
#include "server/context/metrics.h"

#include <algorithm>
#include <mutex>
#include <new>

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include "jobs/base/program_info.h"
#include "jobs/runs/run_record.h"
#include "server/messages/safe_log.h"

namespace server {

namespace {

const prometheus::Histogram::BucketBoundaries kJobSeconds{0.01, 0.03, 0.1, 0.3, 1,    3,
                                                          10,   30,   100, 300, 1000, 3600};
const prometheus::Histogram::BucketBoundaries kRequestSeconds{0.001, 0.003, 0.01, 0.03, 0.1, 0.25, 1, 3, 10};

const char* kind_of(const jobs::JobSpec& spec) {
  if (spec.linkage) {
    return std::ranges::any_of(spec.linkage->bodies, [](const auto& body) { return body.beam.has_value(); })
               ? "flexible"
               : "rigid";
  }
  const engine::RpsupParameters& p = spec.parameters;
  for (const engine::LinkModel link : {p.coupler, p.crank.model, p.rod.model, p.cross.model})
    if (link == engine::LinkModel::kFlexible) return "flexible";
  return "rigid";
}

/// A method that no route knows is a text of the client's: not one more series for each.
std::string known_method(const std::string& method) {
  for (const char* const known : {"GET", "HEAD", "POST", "PATCH", "DELETE", "OPTIONS"}) {
    if (method == known) return method;
  }
  return "other";
}

}  // namespace

class Metrics::Impl {
 public:
  Impl() {
    prometheus::BuildGauge()
        .Name("rpsup_build_info")
        .Help("Always 1; the labels say which program this is")
        .Register(registry_)
        .Add({{"version", std::string(jobs::kProgramVersion)},
              {"commit", std::string(jobs::kProgramCommit)},
              {"compiler", std::string(jobs::kProgramCompiler)}})
        .Set(1);
    // Series that may come are there from the beginning: a rate needs the zero before the first.
    for (const char* const kind : {"rigid", "flexible"}) job_seconds_.Add({{"kind", kind}}, kJobSeconds);
    for (const char* const reason : {"internal", "time_limit", "memory_limit"})
      failures_.Add({{"reason", reason}});
  }

  void add_run(const jobs::JobSpec& spec, const jobs::RunRecord& run) {
    if (run.end == jobs::RunRecord::End::kStopped) return;
    const bool failed = run.end == jobs::RunRecord::End::kFailed;
    if (failed) failures_.Add({{"reason", run.error_reason}}).Increment();
    const bool began = !failed || run.error_t_s;
    if (began) job_seconds_.Add({{"kind", kind_of(spec)}}, kJobSeconds).Observe(run.wall_time_s);
  }

  void add_request(const std::string& method, std::string_view route, int status, double seconds) {
    request_seconds_
        .Add({{"method", known_method(method)},
              {"route", route.empty() ? "none" : std::string(route)},
              {"status", std::to_string(status)}},
             kRequestSeconds)
        .Observe(seconds);
  }

  std::string text(const jobs::QueueStats& load, const nlohmann::json& executors) {
    const std::lock_guard lock(load_mutex_);
    queued_.Set(static_cast<double>(load.queued));
    running_.Set(static_cast<double>(load.running));
    store_bytes_.Set(static_cast<double>(load.store_bytes));
    for (const auto& executor : executors.at("items")) set_executor(executor);
    return prometheus::TextSerializer().Serialize(registry_.Collect());
  }

 private:
  void set_executor(const nlohmann::json& executor) {
    const auto name = executor.at("name").get<std::string>();
    slots_.Add({{"executor", name}}).Set(executor.at("slots").get<double>());
    problems_.Add({{"executor", name}}).Set(static_cast<double>(executor.at("problems").size()));
    if (executor.at("tasks").is_null()) return;
    for (const char* const state : {"pending", "running"})
      tasks_.Add({{"executor", name}, {"state", state}}).Set(executor.at("tasks").at(state).get<double>());
    nodes_.Add({{"executor", name}}).Set(static_cast<double>(executor.at("nodes").size()));
  }

  prometheus::Family<prometheus::Gauge>& add_gauges(const char* name, const char* help) {
    return prometheus::BuildGauge().Name(name).Help(help).Register(registry_);
  }
  prometheus::Gauge& add_gauge(const char* name, const char* help) {
    return prometheus::BuildGauge().Name(name).Help(help).Register(registry_).Add({});
  }

  prometheus::Registry registry_;  // before all that stands in it
  std::mutex load_mutex_;          // guards the gauges of the load between being set and being written
  prometheus::Gauge& queued_ = add_gauge("rpsup_jobs_queued", "Jobs that wait");
  prometheus::Gauge& running_ = add_gauge("rpsup_jobs_running", "Jobs that are being computed");
  prometheus::Gauge& store_bytes_ = add_gauge("rpsup_store_bytes", "Size of the store on disk, with its log");
  prometheus::Family<prometheus::Gauge>& slots_ =
      add_gauges("rpsup_executor_slots", "Jobs that an executor computes at a time");
  prometheus::Family<prometheus::Gauge>& tasks_ =
      add_gauges("rpsup_executor_tasks", "Tasks in Slurm's queue, by state");
  prometheus::Family<prometheus::Gauge>& nodes_ =
      add_gauges("rpsup_executor_nodes", "Machines of the cluster that compute now");
  prometheus::Family<prometheus::Gauge>& problems_ =
      add_gauges("rpsup_executor_problems", "What somebody should look at; /v1/executors says what");
  prometheus::Family<prometheus::Histogram>& job_seconds_ =
      prometheus::BuildHistogram()
          .Name("rpsup_job_duration_seconds")
          .Help(
              "Time that jobs took on this machine, by kind of links: rigid, or with a flexible one")
          .Register(registry_);
  prometheus::Family<prometheus::Counter>& failures_ =
      prometheus::BuildCounter()
          .Name("rpsup_job_failures_total")
          .Help("Runs of jobs on this machine that failed since the program began, by reason")
          .Register(registry_);
  prometheus::Family<prometheus::Histogram>& request_seconds_ =
      prometheus::BuildHistogram()
          .Name("rpsup_http_request_duration_seconds")
          .Help("Time in which requests were answered, from their last byte on")
          .Register(registry_);
};

Metrics::Metrics() : impl_(std::make_unique<Impl>()) {}
Metrics::~Metrics() = default;

void Metrics::add_run(const jobs::JobSpec& spec, const jobs::RunRecord& run) noexcept {
  try {
    impl_->add_run(spec, run);
  } catch (const std::bad_alloc&) {  // the job has its result all the same
    log_error("a run is missing in the metrics: no memory");
  }
}

void Metrics::add_request(const std::string& method, std::string_view route, int status,
                          double seconds) noexcept {
  try {
    impl_->add_request(method, route, status, seconds);
  } catch (const std::bad_alloc&) {  // the request has taken effect, and is answered
    log_error("a request is missing in the metrics: no memory");
  }
}

std::string Metrics::text(const jobs::QueueStats& load, const nlohmann::json& executors) const {
  return impl_->text(load, executors);
}

}  // namespace server
