// SPDX-License-Identifier: Apache-2.0
// Fits by features: whether motions diverge, how features scatter, and how sure the best values are.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "jobs/fits/features.h"
#include "jobs/fits/fit_cases.h"
#include "jobs/fits/fit_sampler.h"
#include "jobs/fits/observation.h"
#include "jobs/statistics/unit_points.h"

namespace jobs {
namespace {

/// Replicates of a point of the design, by which divergence and scatter are judged.
constexpr std::size_t kDivergenceReplicates = 2;
/// Points of the design with the nearest features, as far as the budget allows for each.
constexpr std::size_t kDivergenceCentres = 3;
constexpr std::size_t kBudgetOfCentre = 100;
/// Difference of the best and the measured signals, over the latter, up to which a search has come near.
constexpr double kNearMeasured = 0.2;
constexpr std::size_t kScatterReplicates = 8;
constexpr double kFeatureDesignShare = 0.15;  ///< of the points between which features choose the first basin
/// Least scale of a feature, as part of its measured value or, where that is 0, of its mean.
constexpr double kLeastFeatureScale = 0.02;
constexpr std::size_t kMostFeatureScan = 400;
constexpr double kScanReach = 3.0;  ///< of the scan by features, over that of the linearised intervals

/// Squared distance of two columns that is above those of 95 % of the pairs; 0: there is no pair.
double find_large_distance(const Eigen::MatrixXd& columns) {
  std::vector<double> pairs;
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    for (Eigen::Index k = 0; k < i; ++k)
      pairs.push_back((columns.col(i) - columns.col(k)).squaredNorm());
  if (pairs.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(pairs.size() - 1));
  std::ranges::nth_element(pairs, pairs.begin() + place);
  return pairs[static_cast<std::size_t>(place)];
}

}  // namespace

/// Point by point, quiet motions are nearer to a chaotic measurement than those of its kind. Their features
/// are not. Where only some of the design's motions diverge, a search point by point shows of which kind the
/// measured one is.
FitSampler::Points FitSampler::run_divergence() {
  Points centres{best_};
  for (FitPoint& near : nearest_by_features(std::min(kDivergenceCentres, problem_.budget / kBudgetOfCentre)))
    if (near != best_) centres.push_back(std::move(near));
  Points missing = missing_neighbours_of(centres);
  if (!missing.empty()) return missing;
  bool any_converges = false;
  for (const FitPoint& centre : centres) {
    const auto found = judge_divergence_at(centre);
    if (!found) continue;
    any_converges |= found->basis == FitBasis::kPointWise;
    if (divergence_ && found->ratio <= divergence_->ratio) continue;
    divergence_ = found;
    diverging_ = centre;
  }
  if (!divergence_)
    summary_.remarks.emplace_back(
        "Jobs beside the best point of the design failed, so that divergence was not measured.");
  const bool diverges = divergence_ && divergence_->basis == FitBasis::kFeatures;
  if (diverges && any_converges && !observer_->measured_features().empty()) {
    is_trial_ = true;
    begin_global();
  } else {
    decide_basis();
  }
  return {};
}

FitSampler::Points FitSampler::end_trial() {
  Points missing = missing_neighbours_of({best_});
  if (!missing.empty()) return missing;
  is_trial_ = false;
  const auto at_best = judge_divergence_at(best_);
  const std::vector<double> residuals = residuals_of_best();
  const std::vector<double> measured(residuals.size(), 0.0);
  const bool is_near = observer_->judge({measured, residuals}).ratio <= kNearMeasured;
  if (is_near && at_best && at_best->basis == FitBasis::kPointWise) {
    summary_.divergence = at_best;
    summary_.basis = FitBasis::kPointWise;
    begin_local(best_, 0);
  } else {
    population_.reset();
    decide_basis();
  }
  return {};
}

/// The basis by the largest divergence, if signals have features.
void FitSampler::decide_basis() {
  summary_.divergence = divergence_;
  const bool has_features = !observer_->measured_features().empty();
  set_basis(has_features && divergence_ ? divergence_->basis : FitBasis::kPointWise);
}

FitSampler::Points FitSampler::missing_neighbours_of(const Points& centres) const {
  Points points;
  for (const FitPoint& centre : centres) {
    points.push_back(centre);
    for (std::size_t k = 1; k <= kDivergenceReplicates; ++k)
      points.push_back(replicate_of(problem_, centre, k));
  }
  return missing_of(points);
}

std::optional<SignalDivergence> FitSampler::judge_divergence_at(const FitPoint& centre) {
  std::vector<std::vector<double>> residuals;
  for (std::size_t k = 0; k <= kDivergenceReplicates; ++k) {
    auto found = residuals_of(k == 0 ? centre : replicate_of(problem_, centre, k));
    if (found) residuals.push_back(std::move(*found));
  }
  return residuals.size() < 2 ? std::nullopt : std::optional(observer_->judge(residuals));
}

void FitSampler::set_basis(FitBasis basis) {
  summary_.basis = basis;
  if (is_point_wise()) return begin_global();
  summary_.stage = FitStage::kScatter;
  sum_features();
  choose_best(base_points_);
  const std::size_t n = problem_.parameters.size();
  const auto more = static_cast<std::size_t>(kFeatureDesignShare * static_cast<double>(problem_.budget));
  for (const auto& parts : sobol_points(more, n, problem_.seed))
    base_points_.push_back(point_at(problem_, parts));
}

/// Features count by how much runs scatter. Before any search, replicates of the point of the design that
/// diverges most give the first scale: quiet ones would give each feature the same small one. After a search,
/// replicates of the best point may only raise the scale.
FitSampler::Points FitSampler::run_scatter() {
  const bool is_first = !population_;
  const FitPoint& centre = is_first && !diverging_.empty() ? diverging_ : best_;
  Points points;
  for (std::size_t k = 1; k <= kScatterReplicates; ++k) points.push_back(replicate_of(problem_, centre, k));
  if (is_first) points.insert(points.end(), base_points_.begin(), base_points_.end());
  Points missing = missing_of(points);
  if (!missing.empty()) return missing;
  points.resize(kScatterReplicates);
  std::vector<std::vector<double>> replicates = features_of(points);
  replicates.insert(replicates.begin(), features_.at(centre));
  if (replicates.size() > 1) {
    set_feature_scale(replicates);
    sum_features();
    if (is_first) choose_best(base_points_);
  }
  if (is_first) begin_global();
  else begin_local(best_, 0);
  return {};
}

std::vector<std::vector<double>> FitSampler::features_of(const Points& points) const {
  std::vector<std::vector<double>> features;
  for (const FitPoint& point : points)
    if (const auto found = features_.find(point); found != features_.end()) features.push_back(found->second);
  return features;
}

void FitSampler::set_feature_scale(const std::vector<std::vector<double>>& replicates) {
  const FeatureScatter scatter = calc_scatter(replicates);
  const double mean_of = 1.0 + 1.0 / static_cast<double>(problem_.replicates);
  for (std::size_t k = 0; k < feature_scale_.size(); ++k) {
    const double measured = std::abs(observer_->measured_features()[k]);
    const double least = kLeastFeatureScale * (measured > 0.0 ? measured : scatter.mean[k]);
    const double known = population_ ? feature_scale_[k] : std::numeric_limits<double>::min();
    feature_scale_[k] = std::max({scatter.deviation[k] * std::sqrt(mean_of), least, known});
  }
}

Eigen::MatrixXd FitSampler::residuals_of_replicates() const {
  std::vector<std::vector<double>> all;
  for (const std::vector<double>& features : features_of(replicates_of(best_)))
    all.push_back(feature_residuals(features));
  const auto rows = static_cast<Eigen::Index>(feature_scale_.size());
  Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(all.size()));
  for (Eigen::Index k = 0; k < columns.cols(); ++k)
    columns.col(k) = Eigen::Map<const Eigen::VectorXd>(all[static_cast<std::size_t>(k)].data(), rows);
  return columns;
}

/// Searches crowd about their best points: how far values may lie from them is seen beyond the linearised
/// intervals.
void FitSampler::begin_feature_scan() {
  summary_.stage = FitStage::kScan;
  scan_.clear();
  const std::size_t left = problem_.budget - std::min(problem_.budget, summary_.points.size());
  const std::size_t count = std::min(left, kMostFeatureScan);
  for (UnitPoint parts : sobol_points(count, best_.size(), problem_.seed + 1)) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const double reach = kScanReach * summary_.intervals->quantile *
                           summary_.intervals->deviations[static_cast<Eigen::Index>(i)];
      const double best = part_at(problem_.parameters[i].span, best_[i]);
      parts[i] = std::lerp(std::max(0.0, best - reach), std::min(1.0, best + reach), parts[i]);
    }
    scan_.push_back(point_at(problem_, parts));
  }
}

/// The measured features and those of a run with the true values differ as two runs of one point do. So
/// values are as good as the best if theirs differ no more than 95 % of such pairs, of the best point or,
/// where that is quieter than the one of the scales, as such pairs do in the mean; or about as much as those
/// of the best itself, which is chosen because they differ little.
void FitSampler::end_features() {
  most_feature_sum_ = 2.0 * static_cast<double>(feature_scale_.size());
  most_feature_sum_ = std::max(most_feature_sum_, find_large_distance(residuals_of_replicates()));
  most_feature_sum_ = std::max(most_feature_sum_, kAsGood * kAsGood * local_->sum);
  summary_.ranges = find_ranges();
  for (std::size_t i = 0; i < summary_.ranges.size(); ++i)
    if (!is_decided(summary_.ranges[i], problem_.parameters[i].span))
      summary_.remarks.push_back(problem_.parameters[i].path +
                                 " is hardly decided: runs with values over half its span have features as "
                                 "near to the measured ones as runs are to each other.");
  if (!leaves_noise_)
    summary_.remarks.emplace_back(
        "The features of the best jobs differ from the measured ones by more than those of runs differ from "
        "each other: the search may have missed better values, or the linkage is not that of the "
        "measurement. The intervals are wider by as much.");
}

void FitSampler::sum_features() {
  for (FitPointSummary& point : summary_.points)
    if (point.sum) point.loss = *point.sum = sum_of_squares(feature_residuals(features_.at(point.point)));
}

FitSampler::Points FitSampler::nearest_by_features(std::size_t count) const {
  std::map<double, FitPoint> ranked;
  for (const FitPoint& point : base_points_)
    if (const auto found = features_.find(point); found != features_.end() && !found->second.empty())
      ranked.emplace(sum_of_squares(feature_residuals(found->second)), point);
  Points nearest;
  for (const auto& [sum, point] : ranked)
    if (nearest.size() < count) nearest.push_back(point);
  return nearest;
}

std::vector<double> FitSampler::feature_residuals(const std::vector<double>& features) const {
  std::vector<double> residuals;
  for (std::size_t k = 0; k < features.size(); ++k)
    residuals.push_back((features[k] - observer_->measured_features()[k]) / feature_scale_[k]);
  return residuals;
}

}  // namespace jobs
