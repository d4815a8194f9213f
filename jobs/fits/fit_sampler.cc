// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <utility>

#include "jobs/fits/features.h"
#include "jobs/fits/fit_cases.h"
#include "jobs/fits/observation.h"
#include "jobs/parameters/unit_scale.h"
#include "jobs/requests/expand.h"
#include "jobs/statistics/unit_points.h"

namespace jobs {
namespace {

using nlohmann::ordered_json;

/// Points of the design: so many a parameter, and at least so many.
constexpr std::size_t kDesignPoints = 6;
constexpr std::size_t kFewestDesignPoints = 20;
/// Steps of the differences of features, which scatter.
constexpr double kFeatureStep = 0.05;
/// Sum of squares of features over their number, above which more is left than runs scatter.
constexpr double kMostFeatureSum = 2.0;
constexpr std::size_t kFeatureIterations = 6;
/// Replicates of the points of the intervals: derivatives of means that scatter would be too steep.
constexpr std::size_t kIntervalReplicates = 16;
/// Profiles: steps of each refit, and values on each side.
constexpr std::size_t kRefitIterations = 3;
constexpr std::size_t kProfileValues = 6;
/// Scale of a feature before its scatter is known, as part of its measured value.
constexpr double kFirstFeatureScale = 0.1;
constexpr std::size_t kMostRestarts = 2;
/// Population searches, one after the other as long as residuals are no noise.
constexpr std::size_t kMostSearches = 8;
/// Scans: points of all parameters together, and values of each.
constexpr std::size_t kScanPoints = 160;
constexpr std::size_t kMostScanValues = 32;
constexpr std::size_t kFewestScanValues = 8;
/// Gain of the loss after which searches go on around what leaves noise.
constexpr double kLeastPolishGain = 1e-4;

/// Part of the sum of squares by which the noise of a measurement is known too little.
constexpr double kNoiseMisfit = 0.05;
/// Changes of the residuals, over the residuals, by the differences of the passes of least squares after the
/// first one: large ones lead across what is rugged, small ones to the bottom of what is smooth and bent.
/// Parameters differ in what they change.
constexpr std::array<double, 5> kChanges{0.0, 0.5, 0.2, 0.1, 0.005};
constexpr std::size_t kPassOfIntervals = 3;  ///< its differences are those of the intervals, too
constexpr double kFirstStep = 1e-2;          ///< of all parameters
constexpr double kShortestStep = 1e-5;
constexpr double kLongestStep = 0.1;

/// Steps of the parameters that change residuals by a norm. @param jacobian  by the parts of the spans
std::vector<double> find_steps(const Eigen::MatrixXd& jacobian, double change) {
  std::vector<double> steps;
  for (const auto& column : jacobian.colwise()) {
    const double slope = std::max(column.norm(), std::numeric_limits<double>::min());
    steps.push_back(std::clamp(change / slope, kShortestStep, kLongestStep));
  }
  return steps;
}

std::vector<double> as_vector(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

bool has_jobs(const FitPointSummary& point) {
  return std::ranges::any_of(point.job_ids, [](const std::string& id) { return !id.empty(); });
}

}  // namespace

FitSampler::FitSampler(std::shared_ptr<const FitObserver> observer, const SweepResults* results)
    : observer_(std::move(observer)), problem_(observer_->problem()) {
  for (const double feature : observer_->measured_features())
    feature_scale_.push_back(kFirstFeatureScale * std::abs(feature) + std::numeric_limits<double>::min());
  summary_.basis = problem_.basis;
  box_sizes_.assign(problem_.parameters.size(), 1.0);
  if (results == nullptr) return;
  for (const ResultRow& job : results->rows) tell(job);
}

void FitSampler::tell(const ResultRow& ended) {
  jobs_.insert_or_assign(ended.swept,
                         Job{.id = ended.job_id, .state = ended.state, .error_reason = ended.error_reason});
}

NextCases FitSampler::ask() {
  NextCases next;
  try {
    update_points();
    while (pending_.empty() && !cancelled_ && summary_.stage != FitStage::kEnded) {
      const FitStage stage = summary_.stage;
      for (const FitPoint& point : run_stage()) add_point(point, next);
      if (summary_.stage == FitStage::kPrediction) run_prediction(next);
      update_points();
      if (summary_.stage != stage) summarise_signals();
    }
  } catch (const StorageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // one fit that cannot go on must not keep others waiting
    next.cases.clear();
    next.end_state = "failed";
    next.error = error.what();
    return next;
  }
  return end_if_nothing_waits(std::move(next));
}

NextCases FitSampler::end_if_nothing_waits(NextCases next) {
  if (cancelled_) next.cases.clear();  // the stages were only followed as far as the results go
  else made_points_ = summary_.points.size();
  const bool waits = std::ranges::any_of(pending_, [&](std::size_t index) {
    return index < made_points_ || has_jobs(summary_.points[index]);
  });
  if (waits || !next.cases.empty()) return next;
  if (cancelled_) {
    next.end_state = "cancelled";
  } else if (best_.empty()) {
    const auto lost = std::ranges::find(summary_.points, FitPointState::kLost, &FitPointSummary::state);
    next.end_state = "failed";
    next.error = "no point has a sum of squares that is a number";
    if (lost != summary_.points.end())
      next.error =
          "no point has all its jobs; the first has not because of " + lost->lost_reason.value_or("");
  } else {
    next.end_state = "succeeded";
  }
  return next;
}

double FitSampler::progress() const {
  if (summary_.stage == FitStage::kEnded) return 1.0;
  return std::min(1.0, static_cast<double>(summary_.points.size()) / static_cast<double>(problem_.budget));
}

FitSampler::Points FitSampler::run_stage() {
  switch (summary_.stage) {
    case FitStage::kDesign:
      return run_design();
    case FitStage::kDivergence:
      return run_divergence();
    case FitStage::kScatter:
      return run_scatter();
    case FitStage::kGlobal:
      return run_global();
    case FitStage::kLocal:
      return run_local();
    case FitStage::kScan:
      return run_scan();
    case FitStage::kProfile:
      return run_profile();
    case FitStage::kPrediction:
    case FitStage::kEnded:
      break;
  }
  return {};
}

FitSampler::Points FitSampler::run_design() {
  if (base_points_.empty()) {
    const std::size_t n = problem_.parameters.size();
    const std::size_t count = std::min(std::max(kFewestDesignPoints, kDesignPoints * n), problem_.budget / 2);
    base_points_.push_back(start_of(problem_));
    for (const auto& parts : sobol_points(count - 1, n, problem_.seed))
      base_points_.push_back(point_at(problem_, parts));
  }
  Points missing = missing_of(base_points_);
  if (!missing.empty()) return missing;
  choose_best(base_points_);
  if (best_.empty() && !is_point_wise()) {
    scale_absent_features();
    choose_best(base_points_);
  }
  if (best_.empty()) summary_.stage = FitStage::kEnded;
  else if (!summary_.basis) summary_.stage = FitStage::kDivergence;
  else set_basis(*summary_.basis);
  return {};
}

/// Without that scale, no sum of squares is a number where all points have such features, as impacts.
void FitSampler::scale_absent_features() {
  for (std::size_t k = 0; k < feature_scale_.size(); ++k) {
    if (observer_->measured_features()[k] != 0.0) continue;
    for (const std::vector<double>& features : features_of(base_points_))
      feature_scale_[k] += kFirstFeatureScale * features[k] / static_cast<double>(base_points_.size());
  }
  sum_features();
}

void FitSampler::begin_local(const FitPoint& start, std::size_t pass) {
  if (pass == 0) {
    pass_start_ = start;
    steps_.assign(start.size(), kFirstStep);
  }
  summary_.stage = FitStage::kLocal;
  local_start_ = start;
  pass_ = pass;
  evaluations_ = {};
  residuals_.clear();
  factors_.assign(problem_.signals.size(), 1.0);
  if (is_point_wise() && !ends_) weigh_signals(start);
  const std::size_t left = problem_.budget - std::min(problem_.budget, summary_.points.size());
  if (!is_point_wise()) replicates_ = ends_ ? kIntervalReplicates : problem_.replicates;
  local_limit_ = left / replicates_;
}

LeastSquaresOptions FitSampler::local_options() const {
  LeastSquaresOptions options{.max_evaluations = local_limit_, .steps = steps_};
  if (is_point_wise()) return options;
  if (!ends_) options.steps.assign(steps_.size(), kFeatureStep);
  options.differences = Differences::kCentral;
  options.max_iterations = ends_ ? 0 : kFeatureIterations;
  return options;
}

/// Weighs signals as if their noise were their deviation at a point: what the model does not reproduce yet
/// should not lead astray what follows from the other signals.
void FitSampler::weigh_signals(const FitPoint& point) {
  const auto residuals = residuals_of(point);
  if (!residuals) return;
  const std::vector<double> deviations = observer_->calc_deviations(*residuals);
  double largest = std::numeric_limits<double>::min();
  for (std::size_t k = 0; k < deviations.size(); ++k) {
    if (problem_.signals[k].compared.t.empty()) continue;
    factors_[k] = problem_.signals[k].weight / deviations[k];
    largest = std::max(largest, factors_[k]);
  }
  for (double& factor : factors_) factor /= largest;
}

FitSampler::Points FitSampler::run_local() {
  while (true) {
    LeastSquaresAnswer answer = solve_least_squares({.spans = spans_of(problem_),
                                                     .start = local_start_,
                                                     .fixed = {},
                                                     .options = local_options(),
                                                     .names = names_of(problem_)},
                                                    evaluations_);
    if (answer.result) {
      end_local(std::move(*answer.result));
      if (summary_.stage != FitStage::kLocal) return {};
      continue;
    }
    Points missing = tell_least_squares(answer.points);
    if (!missing.empty()) return missing;
  }
}

void FitSampler::judge_residuals(const std::vector<double>& residuals) {
  const double allowed = std::max(kNoiseMisfit * sum_of_squares(residuals), observer_->misfit_of_noise());
  leaves_noise_ = observer_->is_noise(residuals) && observer_->misfit(residuals) < allowed;
}

/// After the last pass the best point is judged, and the search goes on as long as it leaves more than
/// noise.
void FitSampler::end_pass(const LeastSquaresResult& result) {
  base_points_.push_back(result.x);
  choose_best(base_points_);
  if (pass_ == 0) set_box(result);
  if (pass_ == kPassOfIntervals) keep_jacobian(result);
  if (pass_ + 1 < kChanges.size()) {
    steps_ = find_steps(result.jacobian, kChanges[pass_ + 1] * std::sqrt(result.sum));
    return begin_local(best_, pass_ + 1);
  }
  judge_residuals(residuals_of_best());
  if (leaves_noise_) end_polish();
  else if (gains_since(pass_start_)) begin_local(best_, 0);
  else begin_scan();
}

void FitSampler::keep_jacobian(const LeastSquaresResult& result) {
  std::vector<double> inverse_factors;
  for (const double factor : factors_) inverse_factors.push_back(1.0 / factor);
  jacobian_ = result.jacobian;
  for (auto column : jacobian_.colwise()) {
    const std::vector<double> unscaled =
        observer_->scale_signals({column.begin(), column.end()}, inverse_factors);
    column = Eigen::Map<const Eigen::VectorXd>(unscaled.data(), column.size());
  }
}

/// Noise may be left in a dip beside the true values. Searches go on around it until one finds nothing
/// better.
void FitSampler::end_polish() {
  const double loss = loss_of(best_).value();
  const bool gains = !noise_loss_ || *noise_loss_ - loss > kLeastPolishGain;
  noise_loss_ = loss;
  const bool is_within = search_ + 1 < kMostSearches && summary_.points.size() < polish_limit_;
  if (!gains || !is_within) return end_search();
  ++search_;
  begin_global();
}

/// Searches go on while the best features are further from the measured ones than runs scatter.
void FitSampler::end_feature_pass(const LeastSquaresResult& result) {
  base_points_.push_back(result.x);
  choose_best(complete_points());
  const auto features = static_cast<double>(feature_scale_.size());
  leaves_noise_ = loss_of(best_).value() <= kMostFeatureSum * features;
  if (!leaves_noise_ && search_ + 1 < kMostSearches && summary_.points.size() < global_limit_) {
    ++search_;
    return begin_global();
  }
  ends_ = true;
  summary_.local_end = result.message;  // what follows are the derivatives alone
  begin_local(best_, 0);
  steps_ = find_steps(result.jacobian, std::sqrt(features));
}

void FitSampler::end_local(LeastSquaresResult result) {
  const bool is_fit = !result.x.empty() && result.end != FitEnd::kStartFailed;
  if (is_fit && !ends_) return is_point_wise() ? end_pass(result) : end_feature_pass(result);
  if (!ends_ && is_point_wise()) {  // jobs beside the start fail
    leaves_noise_ = false;
    return begin_scan();
  }
  if (is_fit && is_point_wise()) judge_residuals(as_vector(result.residuals));
  summary_.budget_ended_local = result.end == FitEnd::kMostEvaluations;
  if (summary_.budget_ended_local) summary_.local_end = "The budget ended the least squares.";
  else if (is_point_wise() || !summary_.local_end) summary_.local_end = result.message;
  summary_.stage = FitStage::kPrediction;
  if (!is_fit) {
    summary_.remarks.push_back("There are no intervals: " + result.message);
    return;
  }
  best_ = result.x;
  summary_.best = indices_.at(best_);
  local_ = std::move(result);
  IntervalOptions options;
  if (is_point_wise()) {
    for (const FitSignal& signal : problem_.signals)
      if (!signal.compared.t.empty()) options.blocks.push_back(signal.compared.t.size());
    if (!leaves_noise_) options.misfit = observer_->misfit(as_vector(local_->residuals));
  } else {
    options.noise = ResidualNoise::kWhite;
    options.replicates = residuals_of_replicates();
  }
  const std::vector<Span> spans = spans_of(problem_);
  if (local_->jacobian.rows() <= local_->jacobian.cols()) {
    summary_.remarks.emplace_back("There are too few features for intervals of so many parameters.");
    return;
  }
  summary_.intervals = calc_intervals(local_->jacobian, local_->residuals, spans, local_->x, options);
  if (!is_point_wise()) {
    begin_feature_scan();
  } else if (!leaves_noise_) {
    summary_.remarks.emplace_back(
        "The best jobs leave more than noise: the search may have missed better values, or the linkage is "
        "not that of the measurement. No interval can say how sure the values are; the ranges are those of "
        "points about as good as the best.");
    summary_.ranges = find_ranges();
  } else if (problem_.profiles) {
    summary_.stage = FitStage::kProfile;
  }
}

void FitSampler::begin_scan() {
  summary_.stage = FitStage::kScan;
  scan_.clear();
  const std::size_t n = best_.size();
  const std::size_t values = count_scan_values();
  if (values < 2) return end_search();
  for (std::size_t k = 0; k < values; ++k) {
    const UnitPoint parts(n, (static_cast<double>(k) + 0.5) / static_cast<double>(values));
    const FitPoint even = point_at(problem_, parts);
    for (std::size_t i = 0; i < n; ++i) {
      scan_.push_back(best_);
      scan_.back()[i] = even[i];
    }
  }
}

std::size_t FitSampler::count_scan_values() const {
  const std::size_t n = best_.size();
  const std::size_t allowed = (global_limit_ - std::min(global_limit_, summary_.points.size())) / n;
  return std::min(allowed, std::clamp(kScanPoints / n, kFewestScanValues, kMostScanValues));
}

FitSampler::Points FitSampler::run_scan() {
  Points missing = missing_of(scan_);
  if (!missing.empty()) return missing;
  if (!is_point_wise()) {
    end_features();
    summary_.stage = FitStage::kPrediction;
    return {};
  }
  const FitPoint before = best_;
  base_points_.insert(base_points_.end(), scan_.begin(), scan_.end());
  choose_best(base_points_);
  if (gains_since(before)) begin_local(best_, 0);
  else end_search();
  return {};
}

void FitSampler::end_search() {
  if (!leaves_noise_ && search_ + 1 < kMostSearches && summary_.points.size() < global_limit_) {
    ++search_;
    return begin_global();
  }
  ends_ = true;
  // Where more than noise is left, the intervals are of what changes the sum by as much.
  const std::vector<double> residuals = residuals_of_best();
  const double part = kChanges[kPassOfIntervals];
  steps_ = find_steps(jacobian_, std::sqrt(leaves_noise_ ? part * part * sum_of_squares(residuals)
                                                         : observer_->misfit(residuals)));
  begin_local(best_, kPassOfIntervals);
}

FitSampler::Points FitSampler::run_profile() {
  const ProfileProblem profile = profile_problem();
  while (true) {
    ProfileAnswer answer = profile_likelihood(profile, evaluations_);
    if (answer.result) {
      end_profile(std::move(*answer.result));
      return {};
    }
    Points missing = tell_least_squares(answer.points);
    if (missing.empty()) continue;
    if (summary_.points.size() < problem_.budget) return missing;
    give_profile_up();
    return {};
  }
}

ProfileProblem FitSampler::profile_problem() const {
  LeastSquaresOptions refit = local_options();
  refit.max_iterations = kRefitIterations;
  return {.spans = spans_of(problem_),
          .best = *local_,
          .intervals = *summary_.intervals,
          .refit = refit,
          .max_values = kProfileValues};
}

/// Takes the profiles, or begins again from a better point that they have met.
void FitSampler::end_profile(std::vector<ProfileInterval> profiles) {
  const auto better = std::ranges::find_if(profiles, [](const auto& one) { return one.better.has_value(); });
  if (better != profiles.end() && restarts_ < kMostRestarts) {
    ++restarts_;
    return begin_local(*better->better, pass_);
  }
  summary_.profiles = std::move(profiles);
  extend_profiles();
  summary_.stage = FitStage::kPrediction;
}

void FitSampler::give_profile_up() {
  summary_.remarks.emplace_back(
      "The budget ended before the profile likelihood was there: the ranges are those of points that the "
      "signals hardly tell from the best one.");
  summary_.ranges = find_ranges();
  summary_.stage = FitStage::kPrediction;
}

void FitSampler::run_prediction(NextCases& next) {
  const std::size_t best = summary_.best.value();
  const bool asked = std::ranges::none_of(swept_[best], &std::string::empty);
  if (asked) summary_.stage = FitStage::kEnded;
  else add_jobs(best, true, next);
}

FitSampler::Points FitSampler::tell_least_squares(const Points& points) {
  Points missing;
  for (const FitPoint& point : points) {
    const Points more = missing_of(replicates_of(point));
    missing.insert(missing.end(), more.begin(), more.end());
    if (!more.empty()) continue;
    auto residuals = residuals_of(point);
    if (residuals && is_point_wise()) residuals = observer_->scale_signals(std::move(*residuals), factors_);
    if (residuals) evaluations_.tell(point, std::move(*residuals));
    else evaluations_.tell_failed(point);
  }
  return missing;
}

void FitSampler::summarise_signals() {
  summary_.signals.clear();
  if (!summary_.best) return;
  const FitPointSummary& best = summary_.points[*summary_.best];
  for (std::size_t k = 0; k < problem_.signals.size(); ++k) {
    const FitSignal& signal = problem_.signals[k];
    const auto prediction = observer_->predict(signal, best.point, best.job_ids);
    if (!prediction) continue;
    summary_.signals.push_back({.signal = k,
                                .fitted = FitObserver::compare(signal, *prediction, Samples::kFitted),
                                .held_back = FitObserver::compare(signal, *prediction, Samples::kHeldBack)});
  }
}

}  // namespace jobs
