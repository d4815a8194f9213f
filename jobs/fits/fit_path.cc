// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/errors.h"
#include "jobs/parameters/unit_scale.h"

namespace jobs {
namespace {

constexpr double kShorterDifference = 0.125;  // of a step, if the simulations on both sides fail

Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

FitPath::FitPath(const LeastSquaresProblem& problem, const Evaluations& evaluations)
    : problem_(problem), evaluations_(evaluations) {
  engine::require(problem.start.size() == problem.spans.size(), "start", "as long as spans");
  std::vector<double> parts;
  for (std::size_t i = 0; i < problem.spans.size(); ++i) {
    const Span& span = problem.spans[i];
    engine::require(span.from < span.to && (!span.logarithmic || span.from > 0.0),
                    "spans." + std::to_string(i), "ascending, and above 0 if logarithmic");
    engine::require(problem.start[i] >= span.from && problem.start[i] <= span.to,
                    "start." + std::to_string(i), "within its span");
    if (std::ranges::find(problem.fixed, i) != problem.fixed.end()) continue;
    free_.push_back(i);
    parts.push_back(std::clamp(part_at(span, problem.start[i]), 0.0, 1.0));
  }
  start_ = as_vector(parts);
}

FitPoint FitPath::point_at(const Eigen::VectorXd& parts) const {
  FitPoint point = problem_.start;
  for (Eigen::Index k = 0; k < parts.size(); ++k) {
    const std::size_t i = free_[static_cast<std::size_t>(k)];
    if (parts[k] != start_[k]) point[i] = decimal_between(problem_.spans[i], parts[k], kSearchSteps);
  }
  return point;
}

FitPath::Neighbour FitPath::neighbour(const Eigen::VectorXd& parts, Eigen::Index column,
                                      double distance) const {
  Eigen::VectorXd beside = parts;
  beside[column] += distance;
  FitPoint point = point_at(beside);
  const std::size_t i = free_[static_cast<std::size_t>(column)];
  const double exact = part_at(problem_.spans[i], point[i]) - part_at(problem_.spans[i], point_at(parts)[i]);
  return {std::move(point), exact};
}

double FitPath::step_of(Eigen::Index column) const {
  const std::vector<double>& steps = problem_.options.steps;
  return steps.empty() ? problem_.options.step : steps[free_[static_cast<std::size_t>(column)]];
}

std::vector<double> FitPath::first_distances(double part, Eigen::Index column) const {
  const double h = step_of(column);
  if (part + h > 1.0) return {-h};
  if (problem_.options.differences == Differences::kForward || part - h < 0.0) return {h};
  return {h, -h};
}

std::vector<double> FitPath::fallback_distances(double part, Eigen::Index column) const {
  const double h = step_of(column);
  std::vector<double> distances{h, -h, kShorterDifference * h, -kShorterDifference * h};
  std::erase_if(distances, [&](double d) { return part + d > 1.0 || part + d < 0.0; });
  return distances;
}

const std::optional<std::vector<double>>* FitPath::visit(const FitPoint& point) {
  visited_.insert(point);
  const auto* const told = evaluations_.find(point);
  if (told == nullptr && std::ranges::find(missing_, point) == missing_.end()) missing_.push_back(point);
  return told;
}

void FitPath::speculate(const Eigen::VectorXd& parts) {
  std::size_t left = problem_.options.processors - std::min<std::size_t>(problem_.options.processors, 1);
  for (Eigen::Index k = 0; k < parts.size(); ++k) {
    for (const double distance : first_distances(parts[k], k)) {
      if (left == 0) return;
      --left;
      visit(neighbour(parts, k, distance).point);
    }
  }
}

FitPath::Step FitPath::stop(FitEnd end, std::string message) {
  stopped_ = true;
  result_.end = end;
  result_.message = std::move(message);
  return Step::kStopped;
}

FitPath::Step FitPath::try_step(const Eigen::VectorXd& parts, Eigen::VectorXd& residuals) {
  if (stopped_) return Step::kStopped;
  const FitPoint point = point_at(parts);
  if (!visited_.contains(point) && visited_.size() >= problem_.options.max_evaluations)
    return stop(FitEnd::kMostEvaluations, "The fit ended at its largest number of evaluations, " +
                                              std::to_string(problem_.options.max_evaluations) + ".");
  const auto* const told = visit(point);
  speculate(parts);
  if (told == nullptr) {
    stopped_ = true;
    return Step::kStopped;
  }
  missing_.clear();  // the neighbours of speculate(): the path need not stop for them
  if (!told->has_value()) {
    ++failed_steps_;
    return Step::kFailed;
  }
  residuals = as_vector(**told);
  return Step::kEvaluated;
}

FitPath::Step FitPath::accept(const Eigen::VectorXd& parts) {
  if (stopped_) return Step::kStopped;
  const FitPoint point = point_at(parts);
  const auto* const told = visit(point);
  if (told != nullptr && !told->has_value())
    return stop(FitEnd::kStartFailed, "The simulation at the start of the fit failed.");
  const LeastSquaresResult before = result_;
  const auto n = static_cast<Eigen::Index>(problem_.spans.size());
  if (told != nullptr) {
    result_.x = point;
    result_.residuals = as_vector(**told);
    result_.sum = result_.residuals.squaredNorm();
    result_.jacobian = Eigen::MatrixXd::Zero(result_.residuals.size(), n);
  }
  for (Eigen::Index k = 0; k < parts.size(); ++k) {
    if (add_column(parts, k)) continue;
    const std::string name = name_of(free_[static_cast<std::size_t>(k)]);
    if (before.x.empty())
      return stop(FitEnd::kStartFailed,
                  "The simulations beside the start of the fit failed, on both sides of " + name + ".");
    result_ = before;
    return stop(FitEnd::kNoDerivative,
                "The fit ended where the simulations on both sides of " + name + " fail.");
  }
  if (!missing_.empty()) {
    stopped_ = true;
    return Step::kStopped;
  }
  accepted_ = parts;
  failed_steps_ = 0;
  return Step::kEvaluated;
}

std::string FitPath::name_of(std::size_t parameter) const {
  return problem_.names.empty() ? "parameter " + std::to_string(parameter) : problem_.names[parameter];
}

/// Adds the column of the Jacobian, or the points that it wants. @returns whether there may be one
bool FitPath::add_column(const Eigen::VectorXd& parts, Eigen::Index column) {
  std::vector<Neighbour> used;
  bool waits = false;
  for (const double distance : first_distances(parts[column], column)) {
    Neighbour beside = neighbour(parts, column, distance);
    const auto* const told = visit(beside.point);
    waits = waits || told == nullptr;
    if (told != nullptr && told->has_value()) used.push_back(std::move(beside));
  }
  if (waits) return true;
  for (const double distance : fallback_distances(parts[column], column)) {
    if (!used.empty()) break;
    Neighbour beside = neighbour(parts, column, distance);
    const auto* const told = visit(beside.point);
    if (told == nullptr) return true;
    if (told->has_value()) used.push_back(std::move(beside));
  }
  if (used.empty()) return false;
  if (result_.residuals.size() > 0) set_column(column, used);
  return true;
}

void FitPath::set_column(Eigen::Index column, const std::vector<Neighbour>& used) {
  const auto residuals_at = [&](const Neighbour& at) { return as_vector(**evaluations_.find(at.point)); };
  const auto i = static_cast<Eigen::Index>(free_[static_cast<std::size_t>(column)]);
  if (used.size() == 1) {
    result_.jacobian.col(i) = (residuals_at(used[0]) - result_.residuals) / used[0].distance;
  } else {
    result_.jacobian.col(i) =
        (residuals_at(used[0]) - residuals_at(used[1])) / (used[0].distance - used[1].distance);
  }
}

Eigen::MatrixXd FitPath::calc_descent_jacobian() const {
  Eigen::MatrixXd jacobian(result_.residuals.size(), accepted_.size());
  for (Eigen::Index k = 0; k < accepted_.size(); ++k) {
    jacobian.col(k) = result_.jacobian.col(static_cast<Eigen::Index>(free_[static_cast<std::size_t>(k)]));
    const double slope = jacobian.col(k).dot(result_.residuals);
    const bool held = (accepted_[k] <= 0.0 && slope > 0.0) || (accepted_[k] >= 1.0 && slope < 0.0);
    if (held) jacobian.col(k).setZero();
  }
  return jacobian;
}

}  // namespace jobs
