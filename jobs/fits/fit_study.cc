// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_study.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/fits/fit_json.h"
#include "jobs/fits/fit_sampler.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/expand.h"
#include "jobs/store/sweep_reader.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Cache of the values that were used last, by their keys.
template <typename T>
class RecentlyUsed {
 public:
  std::optional<T> find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(kept_, key, &Entry::first);
    if (found == kept_.end()) return std::nullopt;
    kept_.splice(kept_.begin(), kept_, found);
    return found->second;
  }

  void keep(const std::string& key, T value) {
    const std::lock_guard lock(mutex_);
    kept_.remove_if([&](const Entry& one) { return one.first == key; });
    kept_.emplace_front(key, std::move(value));
    if (kept_.size() > kMostKept) kept_.pop_back();
  }

 private:
  using Entry = std::pair<std::string, T>;
  static constexpr std::size_t kMostKept = 4;
  std::mutex mutex_;  // guards the rest
  std::list<Entry> kept_;
};

using Observers = RecentlyUsed<std::shared_ptr<const FitObserver>>;  ///< by the request

/// Summary, and the state of the study and the last change of its jobs when it was made.
struct KnownSummary {
  std::shared_ptr<const FitSummary> summary;
  std::string state;
  std::int64_t change = 0;
};
using Summaries = RecentlyUsed<KnownSummary>;  ///< by the id of the study

std::int64_t last_change(const SweepResults& results) {
  std::int64_t last = 0;
  for (const ResultRow& job : results.rows) last = std::max(last, job.change);
  return last;
}

/// Sampler that shows others how far it is.
class ShownSampler final : public StudySampler {
 public:
  ShownSampler(std::string id, std::shared_ptr<const FitObserver> observer, const SweepResults& results,
               Summaries& summaries)
      : id_(std::move(id)),
        sampler_(std::move(observer), &results),
        change_(last_change(results)),
        summaries_(summaries) {}

  void tell(const ResultRow& ended) override {
    sampler_.tell(ended);
    change_ = std::max(change_, ended.change);
  }

  [[nodiscard]] NextCases ask() override {
    NextCases next = sampler_.ask();
    summaries_.keep(id_, {.summary = std::make_shared<const FitSummary>(sampler_.summary()),
                          .state = next.end_state.value_or("running"),
                          .change = change_});
    return next;
  }

  [[nodiscard]] double progress() const override { return sampler_.progress(); }

 private:
  std::string id_;
  FitSampler sampler_;
  std::int64_t change_;
  Summaries& summaries_;
};

/// Faults of the first point as faults of the request.
InvalidRequest faults_of_request(const InvalidRequest& invalid) {
  constexpr std::string_view kCase = "/cases/0";
  std::vector<Fault> faults;
  for (Fault fault : invalid.faults()) {
    if (fault.pointer.starts_with(kCase)) fault.pointer = "/over" + fault.pointer.substr(kCase.size());
    faults.push_back(std::move(fault));
  }
  return InvalidRequest(std::move(faults));
}

/// @throws InvalidRequest if features are to be compared and no signal has any
void check_features(const FitObserver& observer) {
  if (observer.problem().basis == FitBasis::kFeatures && observer.measured_features().empty())
    throw InvalidRequest(std::vector<Fault>{
        {"/basis", "\"features\" need a signal with more than 50 compared samples over two of its cycles"}});
}

class FitStudy final : public StudyType {
 public:
  FitStudy(const SweepReader& reader, FindMeasurement find_measurement)
      : reader_(reader), find_measurement_(std::move(find_measurement)) {}

  [[nodiscard]] std::string_view id_prefix() const override { return kFitPrefix; }

  [[nodiscard]] FirstSweep plan_first(const ordered_json& request, std::size_t max_jobs) const override {
    const auto observer = make_observer(request, max_jobs);
    check_features(*observer);
    observers_.keep(request.dump(), observer);
    FitSampler sampler(observer, nullptr);
    NextCases first = sampler.ask();
    if (first.cases.empty()) throw faults_of_request(sampler.first_invalid().value());
    ordered_json sweep = observer->problem().common_sweep;
    sweep["cases"] = std::move(first.cases);
    SweepPlan plan = plan_sweep(sweep, max_jobs);
    FirstSweep made{.request = std::move(sweep), .plan = std::move(plan)};
    for (const auto& measurement : request.at("measurements"))
      made.measurements.push_back(measurement.at("id").get<std::string>());
    return made;
  }

  [[nodiscard]] std::unique_ptr<StudySampler> make_sampler(const StudyRow& row,
                                                           const SweepResults& results) const override {
    return std::make_unique<ShownSampler>(row.id, observer_of(row), results, summaries_);
  }

  [[nodiscard]] json make_resource(const StudyRow& row, const SweepResults& results,
                                   int threads) const override {
    return fit_json(row, observer_of(row)->problem(), *summary_of(row, results), results, threads);
  }
  [[nodiscard]] json make_summary(const StudyRow& row) const override { return fit_summary_json(row); }
  [[nodiscard]] const std::vector<std::string>& listing_keys() const override { return fit_listing_keys(); }
  [[nodiscard]] ResultTable make_table(const StudyRow& row, const SweepResults& results) const override {
    return fit_point_table(row, observer_of(row)->problem(), *summary_of(row, results));
  }
  [[nodiscard]] std::optional<ResultTable> make_signal_table(const StudyRow& row,
                                                             const SweepResults& results) const override {
    return fit_signal_table(row, *observer_of(row), *summary_of(row, results));
  }

 private:
  [[nodiscard]] std::shared_ptr<const FitObserver> make_observer(const ordered_json& request,
                                                                 std::size_t max_jobs) const {
    auto problem =
        std::make_shared<const FitProblem>(parse_fit_request(request, find_measurement_, max_jobs));
    return std::make_shared<const FitObserver>(std::move(problem), reader_);
  }

  [[nodiscard]] std::shared_ptr<const FitObserver> observer_of(const StudyRow& row) const {
    if (auto known = observers_.find(row.request)) return *known;
    auto made = make_observer(ordered_json::parse(row.request), std::numeric_limits<std::size_t>::max());
    observers_.keep(row.request, made);
    return made;
  }

  [[nodiscard]] std::shared_ptr<const FitSummary> summary_of(const StudyRow& row,
                                                             const SweepResults& results) const {
    const std::int64_t change = last_change(results);
    if (const auto known = summaries_.find(row.id);
        known && known->state == row.state && (row.state == "running" || known->change == change))
      return known->summary;
    FitSampler sampler(observer_of(row), &results);
    (void)sampler.ask();
    auto made = std::make_shared<const FitSummary>(sampler.summary());
    if (row.state != "running")
      summaries_.keep(row.id, {.summary = made, .state = row.state, .change = change});
    return made;
  }

  const SweepReader& reader_;
  FindMeasurement find_measurement_;
  mutable Observers observers_;
  mutable Summaries summaries_;
};

}  // namespace

std::unique_ptr<StudyType> make_fit_study(const SweepReader& reader, FindMeasurement find_measurement) {
  return std::make_unique<FitStudy>(reader, std::move(find_measurement));
}

}  // namespace jobs
