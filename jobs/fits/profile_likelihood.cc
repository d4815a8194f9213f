// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/profile_likelihood.h"

#include <algorithm>
#include <cmath>

#include "jobs/parameters/unit_scale.h"

namespace jobs {
namespace {

constexpr double kRootTolerance = 0.02;  // of the root at the end, relative to the threshold
constexpr double kBetter = 1e-3;         // relative decrease of the sum that makes a point a better one

/// Distance from the best part with the root of the excess there.
struct ProfilePoint {
  double distance = 0.0, root = 0.0;
};

/// Search for one end of the interval of one parameter.
class EndSearch {
 public:
  EndSearch(const ProfileProblem& problem, const Evaluations& evaluations, std::size_t parameter, double side)
      : problem_(problem), evaluations_(evaluations), index_(parameter), side_(side) {
    part_ = part_at(span(), problem.best.x[index_]);
    reach_ = side > 0.0 ? 1.0 - part_ : part_;
  }

  /// @returns empty if simulations are missing
  std::optional<ProfileEnd> run(std::vector<FitPoint>& missing, std::optional<FitPoint>& better);

 private:
  [[nodiscard]] const Span& span() const { return problem_.spans[index_]; }
  [[nodiscard]] double threshold() const { return problem_.intervals.quantile; }
  [[nodiscard]] FitPoint start_at(double distance) const;
  [[nodiscard]] double root_of(double sum) const;
  [[nodiscard]] double next_distance() const;
  [[nodiscard]] ProfileEnd end_at(double distance) const {
    return {value_at(span(), part_ + side_ * distance), ProfileVerdict::kFound, ""};
  }
  [[nodiscard]] ProfileEnd interpolate() const;
  [[nodiscard]] ProfileEnd open_end() const;

  const ProfileProblem& problem_;
  const Evaluations& evaluations_;
  std::size_t index_;
  double side_, part_ = 0.0, reach_ = 0.0;
  ProfilePoint below_;
  std::optional<ProfilePoint> above_;
  std::optional<double> failed_;
};

/// Start of the other parameters: on the ridge of the linearised model.
FitPoint EndSearch::start_at(double distance) const {
  const Eigen::MatrixXd& covariance = problem_.intervals.covariance;
  const auto i = static_cast<Eigen::Index>(index_);
  FitPoint start = problem_.best.x;
  for (std::size_t j = 0; j < start.size(); ++j) {
    const double slope =
        j == index_
            ? 1.0
            : (covariance(i, i) > 0.0 ? covariance(static_cast<Eigen::Index>(j), i) / covariance(i, i) : 0.0);
    if (slope == 0.0) continue;
    const double part = part_at(problem_.spans[j], start[j]) + side_ * distance * slope;
    start[j] = decimal_between(problem_.spans[j], std::clamp(part, 0.0, 1.0), kSearchSteps);
  }
  return start;
}

double EndSearch::root_of(double sum) const {
  const double deviation = problem_.intervals.residual_deviation;
  const double inflation = problem_.intervals.inflation[static_cast<Eigen::Index>(index_)];
  return std::sqrt(std::max(sum - problem_.best.sum, 0.0) / inflation) / deviation;
}

double EndSearch::next_distance() const {
  const double from = below_.distance;
  if (above_) {
    const double width = above_->distance - from;
    const double part = (threshold() - below_.root) / (above_->root - below_.root);
    return from + width * std::clamp(part, 0.1, 0.9);
  }
  if (failed_) return 0.5 * (from + *failed_);
  const double factor = below_.root > 0.0 ? 1.05 * threshold() / below_.root : 3.0;
  return std::min(reach_, from * std::clamp(factor, 1.2, 3.0));
}

ProfileEnd EndSearch::interpolate() const {
  const double part = (threshold() - below_.root) / (above_->root - below_.root);
  return end_at(below_.distance + part * (above_->distance - below_.distance));
}

ProfileEnd EndSearch::open_end() const {
  const std::string bound = side_ > 0.0 ? "upper" : "lower";
  return {side_ > 0.0 ? span().to : span().from, ProfileVerdict::kOpen,
          "The interval is open: the measured channels agree with values up to the " + bound + " bound."};
}

std::optional<ProfileEnd> EndSearch::run(std::vector<FitPoint>& missing, std::optional<FitPoint>& better) {
  if (!(problem_.intervals.residual_deviation > 0.0)) return end_at(0.0);
  if (!(reach_ > 0.0)) return open_end();
  const double linear = threshold() * problem_.intervals.deviations[static_cast<Eigen::Index>(index_)];
  double distance = std::clamp(linear, 1e-6 * reach_, reach_);
  for (std::size_t k = 0; k < problem_.max_values; ++k) {
    const LeastSquaresProblem others{problem_.spans, start_at(distance), {index_}, problem_.refit};
    const LeastSquaresAnswer answer = solve_least_squares(others, evaluations_);
    if (!answer.result) {
      missing.insert(missing.end(), answer.points.begin(), answer.points.end());
      return std::nullopt;
    }
    if (answer.result->end == FitEnd::kStartFailed) {
      failed_ = distance;
    } else {
      if (answer.result->sum < (1.0 - kBetter) * problem_.best.sum) better = answer.result->x;
      const ProfilePoint at{distance, root_of(answer.result->sum)};
      if (at.root >= threshold()) above_ = at;
      else below_ = at;
      if (std::abs(at.root - threshold()) <= kRootTolerance * threshold()) {
        const double end = distance * threshold() / at.root;
        return end > reach_ ? open_end() : end_at(end);
      }
      if (!above_ && distance >= reach_) return open_end();
    }
    distance = next_distance();
  }
  if (above_) return interpolate();
  return ProfileEnd{value_at(span(), part_ + side_ * below_.distance), ProfileVerdict::kLost,
                    failed_ ? "The end was not found: simulations beyond this value fail."
                            : "The end was not found with the largest number of values."};
}

}  // namespace

ProfileAnswer profile_likelihood(const ProfileProblem& problem, const Evaluations& evaluations) {
  ProfileAnswer answer;
  std::vector<ProfileInterval> found;
  for (std::size_t i = 0; i < problem.spans.size(); ++i) {
    ProfileInterval interval;
    const auto low = EndSearch(problem, evaluations, i, -1.0).run(answer.points, interval.better);
    const auto high = EndSearch(problem, evaluations, i, 1.0).run(answer.points, interval.better);
    if (low) interval.low = *low;
    if (high) interval.high = *high;
    found.push_back(std::move(interval));
  }
  std::ranges::sort(answer.points);
  answer.points.erase(std::ranges::unique(answer.points).begin(), answer.points.end());
  if (answer.points.empty()) answer.result = std::move(found);
  return answer;
}

}  // namespace jobs
