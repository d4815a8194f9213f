// SPDX-License-Identifier: Apache-2.0
// Population searches of a fit, in boxes around its best point.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "jobs/fits/fit_cases.h"
#include "jobs/fits/fit_sampler.h"
#include "jobs/parameters/unit_scale.h"

namespace jobs {
namespace {

/// Part of the budget that is spent before the profile likelihood.
constexpr double kGlobalShare = 0.8;
constexpr double kSearchShare = 0.12;        ///< of one population search
constexpr double kFeatureSearchShare = 0.2;  ///< of one by features
constexpr double kPolishShare = 0.5;         ///< up to which searches around what leaves noise may begin
/// Least size of the box of a search, as part of a span.
constexpr double kLeastBox = 1e-3;
constexpr double kFailedFitness = 1e200;
/// Gain of the loss after which least squares begin anew.
constexpr double kLeastGain = 0.01;

}  // namespace

void FitSampler::begin_global() {
  summary_.stage = FitStage::kGlobal;
  replicates_ = 1;  // single runs tell far from near, and more of them are seen
  const auto part_of_budget = [this](double part) {
    return static_cast<std::size_t>(part * static_cast<double>(problem_.budget));
  };
  global_limit_ = part_of_budget(kGlobalShare);
  polish_limit_ = part_of_budget(kPolishShare);
  const std::size_t search = part_of_budget(is_point_wise() ? kSearchShare : kFeatureSearchShare);
  search_limit_ = std::min(global_limit_, summary_.points.size() + search);
  box_centre_ = best_;
  PopulationOptions options{.dimensions = best_.size(),
                            .population = problem_.population,
                            .seed = static_cast<unsigned>(problem_.seed + search_)};
  // Another search by features begins elsewhere: their basins are wide.
  if (is_point_wise() || search_ == 0) options.start = box_parts_of(best_);
  population_.emplace(options);
}

std::pair<double, double> FitSampler::box_of(std::size_t i) const {
  const double centre = part_at(problem_.parameters[i].span, box_centre_[i]);
  const double from = std::clamp(centre - 0.5 * box_sizes_[i], 0.0, 1.0 - box_sizes_[i]);
  return {from, from + box_sizes_[i]};
}

/// Sets the next search's box: at its sides residuals have changed by as much as they are, by the derivatives
/// of the first pass.
void FitSampler::set_box(const LeastSquaresResult& result) {
  for (std::size_t i = 0; i < box_sizes_.size(); ++i) {
    const double slope = result.jacobian.col(static_cast<Eigen::Index>(i)).norm();
    const double size = 2.0 * std::sqrt(result.sum);
    box_sizes_[i] = size < slope ? std::max(size / slope, kLeastBox) : 1.0;
  }
}

FitPoint FitSampler::point_in_box(const UnitPoint& parts) const {
  std::vector<double> in_spans;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto [from, to] = box_of(i);
    in_spans.push_back(std::clamp(std::lerp(from, to, parts[i]), 0.0, 1.0));
  }
  return point_at(problem_, in_spans);
}

UnitPoint FitSampler::box_parts_of(const FitPoint& point) const {
  UnitPoint parts;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const auto [from, to] = box_of(i);
    parts.push_back((part_at(problem_.parameters[i].span, point[i]) - from) / (to - from));
  }
  return parts;
}

FitSampler::Points FitSampler::run_global() {
  while (true) {
    const auto unknown =
        population_->ask([this](const UnitPoint& parts) -> std::optional<std::vector<double>> {
          const FitPoint point = point_in_box(parts);
          if (!missing_of(replicates_of(point)).empty()) return std::nullopt;
          return std::vector<double>{loss_of(point).value_or(kFailedFitness)};
        });
    if (unknown.empty() || summary_.points.size() >= search_limit_) break;
    Points missing;
    for (const UnitPoint& parts : unknown) {
      const FitPoint point = point_in_box(parts);
      base_points_.push_back(point);
      const Points more = missing_of(replicates_of(point));
      missing.insert(missing.end(), more.begin(), more.end());
    }
    if (!missing.empty()) return missing;
  }
  choose_best(complete_points());
  if (is_trial_) return end_trial();
  if (is_point_wise()) begin_local(best_, 0);
  else summary_.stage = FitStage::kScatter;
  return {};
}

/// @returns whether the best point is enough better than an earlier one to search on from it
bool FitSampler::gains_since(const FitPoint& earlier) {
  const double gain = loss_of(earlier).value() - loss_of(best_).value();
  return gain > kLeastGain && summary_.points.size() < global_limit_;
}

}  // namespace jobs
