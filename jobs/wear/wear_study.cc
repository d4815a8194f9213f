// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear_study.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/expand.h"
#include "jobs/store/sweep_reader.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "jobs/trajectories/trajectory_query.h"
#include "jobs/wear/wear_json.h"
#include "jobs/wear/wear_request.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

WearStudyRequest study_of(const StudyRow& row) {
  return parse_wear_request(ordered_json::parse(row.request), std::numeric_limits<std::size_t>::max());
}

/// Cache of the wear rates of jobs.
class WearRates {
 public:
  explicit WearRates(const SweepReader& reader) : reader_(reader) {}

  /// Empty if the job has no trajectory with the channels of wear.
  std::optional<WearGrid> find(const std::string& job_id, const WearGrid& depth_um,
                               const WearStudyRequest& study) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto known = rates_.find(job_id); known != rates_.end()) return known->second;
    }
    auto read_now = read(job_id, depth_um, study);
    const std::lock_guard lock(mutex_);
    if (rates_.size() >= kMostKept) rates_.clear();
    if (read_now) rates_.emplace(job_id, *read_now);
    return read_now;
  }

 private:
  static constexpr std::size_t kMostKept = 5000;

  [[nodiscard]] std::optional<WearGrid> read(const std::string& job_id, const WearGrid& depth_um,
                                             const WearStudyRequest& study) const {
    const auto blob = reader_.find_trajectory(job_id);
    if (!blob) return std::nullopt;
    try {
      return make_rates(std::as_bytes(std::span(*blob)), depth_um, study);
    } catch (const WrongState&) {  // it has no channels of wear
    } catch (const DamagedTrajectory&) {
    }
    return std::nullopt;
  }

  static WearGrid make_rates(std::span<const std::byte> trajectory, const WearGrid& depth_um,
                             const WearStudyRequest& study) {
    json parameters = study.completed;
    parameters[kWearKey] = depth_um;
    const WornBearing bearing{.prefix = "", .parameters = parameters};
    const TrajectoryQuery steady{
        .channels = wear_channels(bearing), .from = parameters.at("run_up_s").get<double>(), .to = {}};
    WearQuery query = study.query;
    query.worn_clearance.reset();
    const ResultTable map = make_wear_map(bearing, read_trajectory(trajectory, steady), query);
    WearGrid rates = study.round_bore();
    for (std::size_t k = 0; k < map.rows.size(); ++k) {
      rates[k / query.sectors][k % query.sectors] = map.rows[k][kRateColumn].get<double>();
    }
    return rates;
  }

  static constexpr std::size_t kRateColumn = 5;  // rate_um_h

  const SweepReader& reader_;
  std::mutex mutex_;  // guards the rest
  std::map<std::string, WearGrid> rates_;  ///< by job
};

/// Sampler of a wear study. Its k-th job computes the k-th case of its sweep.
class WearSampler final : public StudySampler {
 public:
  WearSampler(WearStudyRequest study, const SweepResults& results, WearRates& rates)
      : study_(std::move(study)), rates_(rates), integrator_(study_.rule, study_.round_bore()) {
    const json request = json::parse(results.sweep.request);
    for (const ResultRow& job : results.rows) {  // fewer than cases after a deletion that found no room
      bores_.emplace(request.at("cases").at(jobs_.size()).at(kWearKey).get<WearGrid>(), jobs_.size());
      jobs_.push_back(job_of(job));
    }
    advance();
  }

  void tell(const ResultRow& ended) override {
    // One job runs at a time. It has no id yet if ask() added it since the sampler was made.
    const auto job = std::find_if(jobs_.rbegin(), jobs_.rend(),
                                  [&](const Job& one) { return one.id.empty() || one.id == ended.job_id; });
    *job = job_of(ended);
  }

  [[nodiscard]] NextCases ask() override {
    advance();
    NextCases next;
    if (history().next && bores_.emplace(*history().next, jobs_.size()).second) {
      next.cases.push_back(case_of(*history().next));
      jobs_.push_back({.id = "", .state = "queued", .error_reason = {}});
    }
    if (history().verdict == WearVerdict::kLost) {
      const bool cancelled = std::ranges::find(jobs_, "cancelled", &Job::state) != jobs_.end();
      next.end_state = cancelled ? "cancelled" : "failed";
      if (!cancelled) next.error = describe_loss();
    } else if (history().verdict != WearVerdict::kOpen) {
      next.end_state = "succeeded";
    }
    return next;
  }

  [[nodiscard]] double progress() const override { return calc_progress(study_, history()); }

  [[nodiscard]] const WearStudyRequest& study() const { return study_; }
  [[nodiscard]] const WearHistory& history() const { return integrator_.history(); }

 private:
  struct Job {
    std::string id, state;
    std::optional<std::string> error_reason;
  };

  static Job job_of(const ResultRow& row) {
    return {.id = row.job_id, .state = row.state, .error_reason = row.error_reason};
  }

  [[nodiscard]] std::string describe_loss() const {
    const auto failed = std::ranges::find(jobs_, "failed", &Job::state);
    if (failed == jobs_.end()) return "a job has no trajectory that tells its wear";
    return failed->id + " has no result: " + failed->error_reason.value_or(failed->state);
  }

  void advance() {
    integrator_.advance([this](const WearGrid& depth_um) -> std::optional<WearEvaluation> {
      const auto found = bores_.find(depth_um);
      return found == bores_.end() ? std::nullopt : std::optional(evaluate(found->second, depth_um));
    });
  }

  [[nodiscard]] WearEvaluation evaluate(std::size_t index, const WearGrid& depth_um) const {
    using State = WearEvaluation::State;
    const Job& job = jobs_.at(index);
    if (job.state == "queued" || job.state == "running") return {.state = State::kPending, .job = index};
    if (job.state != "succeeded") return {.state = State::kLost, .job = index};
    auto rates = rates_.find(job.id, depth_um, study_);
    if (!rates) return {.state = State::kLost, .job = index};
    return {.state = State::kDone, .job = index, .rate_um_h = std::move(*rates)};
  }

  WearStudyRequest study_;
  WearRates& rates_;
  std::map<WearGrid, std::size_t> bores_;  ///< index of each bore's job
  std::vector<Job> jobs_;
  WearIntegrator integrator_;
};

class WearStudy final : public StudyType {
 public:
  explicit WearStudy(const SweepReader& reader) : rates_(reader) {}

  [[nodiscard]] std::string_view id_prefix() const override { return kWearStudyPrefix; }

  [[nodiscard]] FirstSweep plan_first(const ordered_json& request, std::size_t max_jobs) const override {
    ordered_json sweep = first_sweep_of(request, parse_wear_request(request, max_jobs));
    SweepPlan plan = plan_sweep(sweep, max_jobs);
    return {std::move(sweep), std::move(plan)};
  }

  [[nodiscard]] std::unique_ptr<StudySampler> make_sampler(const StudyRow& row,
                                                           const SweepResults& results) const override {
    return std::make_unique<WearSampler>(study_of(row), results, rates_);
  }

  [[nodiscard]] json make_resource(const StudyRow& row, const SweepResults& results,
                                   int threads) const override {
    const WearSampler sampler(study_of(row), results, rates_);
    return wear_study_json(row, sampler.study(), results, sampler.history(), threads);
  }
  [[nodiscard]] json make_summary(const StudyRow& row) const override { return wear_summary_json(row); }
  [[nodiscard]] const std::vector<std::string>& listing_keys() const override { return wear_listing_keys(); }
  [[nodiscard]] ResultTable make_table(const StudyRow& row, const SweepResults& results) const override {
    const WearSampler sampler(study_of(row), results, rates_);
    return wear_table(row, sampler.study(), results, sampler.history());
  }

 private:
  mutable WearRates rates_;  // guards itself
};

}  // namespace

std::unique_ptr<StudyType> make_wear_study(const SweepReader& reader) {
  return std::make_unique<WearStudy>(reader);
}

}  // namespace jobs
