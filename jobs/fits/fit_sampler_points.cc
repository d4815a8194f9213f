// SPDX-License-Identifier: Apache-2.0
// Points of a fit, and the jobs that evaluate them.

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "jobs/fits/fit_cases.h"
#include "jobs/fits/fit_sampler.h"
#include "jobs/fits/observation.h"
#include "jobs/requests/expand.h"

namespace jobs {
namespace {

using nlohmann::ordered_json;

}  // namespace

FitSampler::Points FitSampler::missing_of(const Points& points) const {
  Points missing;
  for (const FitPoint& point : points)
    if (!indices_.contains(point) && std::ranges::find(missing, point) == missing.end())
      missing.push_back(point);
  return missing;
}

FitSampler::Points FitSampler::complete_points() const {
  Points complete = base_points_;
  std::erase_if(complete,
                [this](const FitPoint& point) { return !missing_of(replicates_of(point)).empty(); });
  return complete;
}

FitSampler::Points FitSampler::replicates_of(const FitPoint& point) const {
  Points points{point};
  for (std::size_t k = 1; k < replicates_; ++k)
    points.push_back(replicate_of(problem_, point, k));
  return points;
}

void FitSampler::add_point(const FitPoint& point, NextCases& next) {
  const auto [known, is_new] = indices_.try_emplace(point, summary_.points.size());
  if (!is_new) return;
  const std::size_t runs = problem_.runs.size();
  summary_.points.push_back(
      {.point = point, .stage = summary_.stage, .job_ids = std::vector<std::string>(runs)});
  swept_.emplace_back(runs);
  add_jobs(known->second, false, next);
}

void FitSampler::add_jobs(std::size_t index, bool held_back, NextCases& next) {
  std::vector<ordered_json> cases(problem_.runs.size());
  std::vector<std::string> swept = swept_[index];
  try {
    for (std::size_t run = 0; run < problem_.runs.size(); ++run) {
      if (is_fitted(problem_, run) == held_back) continue;
      ordered_json sweep = problem_.common_sweep;
      sweep["cases"] = ordered_json::array({case_of(problem_, run, summary_.points[index].point)});
      swept[run] = plan_sweep(sweep, 1).jobs.front().swept;
      cases[run] = sweep["cases"][0];
    }
  } catch (const InvalidRequest& invalid) {
    if (!first_invalid_) first_invalid_ = invalid;
    if (!held_back) return lose(index, "invalid_parameters");
    summary_.remarks.push_back(
        "A run that is held back has no prediction, as its parameters do not fit the best values: " +
        std::string(invalid.what()) + ".");
    summary_.stage = FitStage::kEnded;
    return;
  }
  for (std::size_t run = 0; run < swept.size(); ++run) {
    const Job queued{.id = "", .state = "queued", .error_reason = {}};
    if (!swept[run].empty() && jobs_.try_emplace(swept[run], queued).second)
      next.cases.push_back(std::move(cases[run]));
  }
  swept_[index] = std::move(swept);
  pending_.push_back(index);
}

void FitSampler::update_points() {
  const std::vector<std::size_t> pending = std::exchange(pending_, {});
  for (const std::size_t index : pending) update_point(index);
}

void FitSampler::update_point(std::size_t index) {
  FitPointSummary& point = summary_.points[index];
  bool waits = false;
  for (std::size_t run = 0; run < swept_[index].size(); ++run) {
    if (swept_[index][run].empty()) continue;
    const Job& job = jobs_.at(swept_[index][run]);
    point.job_ids[run] = job.id;
    waits |= job.state == "queued" || job.state == "running";
  }
  if (waits) return pending_.push_back(index);
  for (const std::string& swept : swept_[index]) {
    if (swept.empty()) continue;
    const Job& job = jobs_.at(swept);
    cancelled_ |= job.state == "cancelled";
    if (job.state == "succeeded") continue;
    if (point.state != FitPointState::kSucceeded) return lose(index, job.error_reason.value_or(job.state));
    summary_.remarks.push_back("A run that is held back has no prediction, as its job failed: " +
                               job.error_reason.value_or(job.state) + ".");
  }
  if (point.state == FitPointState::kSucceeded) return;
  const bool only_residuals = summary_.basis == FitBasis::kPointWise;
  auto observation = observer_->observe(
      point.point, point.job_ids,
      only_residuals ? FitObserver::Wanted::kResiduals : FitObserver::Wanted::kFeaturesToo);
  if (observation) take(index, std::move(*observation));
  else lose(index, "no_value");
}

void FitSampler::lose(std::size_t index, std::string reason) {
  summary_.points[index].state = FitPointState::kLost;
  summary_.points[index].lost_reason = std::move(reason);
}

void FitSampler::take(std::size_t index, Observation observation) {
  FitPointSummary& point = summary_.points[index];
  point.state = FitPointState::kSucceeded;
  features_.emplace(point.point, std::move(observation.features));
  point.sum =
      sum_of_squares(is_point_wise() ? observation.residuals : feature_residuals(features_.at(point.point)));
  if (is_point_wise()) point.deviations = observer_->calc_deviations(observation.residuals);
  point.loss = is_point_wise() ? observer_->calc_loss(point.deviations) : *point.sum;
  if (is_point_wise()) keep_residuals(point, std::move(observation.residuals));
}

/// Searches need the residuals of their best point alone.
void FitSampler::keep_residuals(const FitPointSummary& point, std::vector<double> residuals) {
  if (summary_.stage != FitStage::kLocal && summary_.stage != FitStage::kProfile &&
      summary_.stage != FitStage::kDivergence) {
    if (!(point.loss < least_loss_)) return;
    least_loss_ = point.loss;
    residuals_.clear();
  }
  residuals_.insert_or_assign(point.point, std::move(residuals));
}

std::optional<std::vector<double>> FitSampler::residuals_of(const FitPoint& point) {
  if (is_point_wise()) return point_wise_residuals_of(point);
  const auto mean = mean_features_of(point);
  return mean ? std::optional(feature_residuals(*mean)) : std::nullopt;
}

std::optional<std::vector<double>> FitSampler::point_wise_residuals_of(const FitPoint& point) const {
  const FitPointSummary& summary = summary_.points[indices_.at(point)];
  if (summary.state != FitPointState::kSucceeded) return std::nullopt;
  if (const auto found = residuals_.find(point); found != residuals_.end()) return found->second;
  auto again = observer_->observe(point, summary.job_ids, FitObserver::Wanted::kResiduals);
  return again ? std::optional(std::move(again->residuals)) : std::nullopt;
}

std::optional<std::vector<double>> FitSampler::mean_features_of(const FitPoint& point) const {
  std::vector<double> mean(feature_scale_.size(), 0.0);
  double count = 0.0;
  for (const FitPoint& replicate : replicates_of(point)) {
    const auto found = features_.find(replicate);
    if (found == features_.end()) continue;
    count += 1.0;
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += found->second[k];
  }
  if (count == 0.0) return std::nullopt;
  for (double& value : mean) value /= count;
  return mean;
}

std::vector<double> FitSampler::residuals_of_best() {
  auto residuals = residuals_of(best_);
  if (!residuals) throw std::runtime_error("the trajectories of the best point cannot be read again");
  return std::move(*residuals);
}

std::optional<double> FitSampler::loss_of(const FitPoint& point) {
  const FitPointSummary& known = summary_.points[indices_.at(point)];
  if (is_point_wise()) return known.sum ? std::optional(known.loss) : std::nullopt;
  const auto residuals = residuals_of(point);
  return residuals ? std::optional(sum_of_squares(*residuals)) : std::nullopt;
}

void FitSampler::choose_best(const Points& among) {
  std::optional<double> least;
  for (const FitPoint& point : among) {
    const auto loss = loss_of(point);
    if (!loss || !std::isfinite(*loss) || (least && !(*loss < *least))) continue;
    least = loss;
    best_ = point;
    summary_.best = indices_.at(point);
  }
}

double FitSampler::excess_of(const FitPointSummary& point) const {
  const double deviation = summary_.intervals->residual_deviation;
  return (point.sum.value() - local_->sum) / (deviation * deviation);
}

bool FitSampler::is_as_good(const FitPointSummary& point) const {
  if (!is_point_wise()) return point.sum && *point.sum <= most_feature_sum_;
  const FitPointSummary& best = summary_.points[summary_.best.value()];
  if (!point.sum || point.deviations.size() != best.deviations.size()) return false;
  if (leaves_noise_) return excess_of(point) <= summary_.intervals->quantile * summary_.intervals->quantile;
  for (std::size_t k = 0; k < best.deviations.size(); ++k)
    if (!(point.deviations[k] <= kAsGood * best.deviations[k])) return false;
  return true;
}

std::vector<ValueRange> FitSampler::find_ranges_of_points() const {
  std::vector<ValueRange> ranges;
  for (const double value : best_) ranges.push_back({value, value});
  for (const FitPointSummary& point : summary_.points) {
    if (!is_as_good(point)) continue;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      ranges[i].low = std::min(ranges[i].low, point.point[i]);
      ranges[i].high = std::max(ranges[i].high, point.point[i]);
    }
  }
  return ranges;
}

std::vector<ValueRange> FitSampler::find_ranges() const {
  std::vector<ValueRange> ranges = find_ranges_of_points();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const Estimate& interval = summary_.intervals->parameters[i];
    const Span& span = problem_.parameters[i].span;
    ranges[i].low = std::clamp(interval.low, span.from, ranges[i].low);
    ranges[i].high = std::clamp(interval.high, ranges[i].high, span.to);
  }
  return ranges;
}

void FitSampler::extend_profiles() {
  const FitIntervals& intervals = summary_.intervals.value();
  for (const FitPointSummary& point : summary_.points) {
    if (!point.sum || point.deviations.empty()) continue;
    for (std::size_t i = 0; i < best_.size(); ++i) {
      const double inflation = intervals.inflation[static_cast<Eigen::Index>(i)];
      if (!(excess_of(point) < inflation * intervals.quantile * intervals.quantile)) continue;
      ProfileInterval& interval = (*summary_.profiles)[i];
      interval.low.value = std::min(interval.low.value, point.point[i]);
      interval.high.value = std::max(interval.high.value, point.point[i]);
    }
  }
}

}  // namespace jobs
