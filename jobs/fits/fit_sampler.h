// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "jobs/fits/evaluations.h"
#include "jobs/fits/fit_observer.h"
#include "jobs/fits/fit_summary.h"
#include "jobs/fits/least_squares.h"
#include "jobs/optimisation/population_search.h"
#include "jobs/store/rows.h"
#include "jobs/studies/study_runner.h"

namespace jobs {

/// Sampler of a fit: a design of points, a population search from the best of them, least squares from the
/// best of those, and the intervals. All of it follows from the request and the results of the jobs.
class FitSampler final : public StudySampler {
 public:
  /// @param results  null: no job has been made yet
  FitSampler(std::shared_ptr<const FitObserver> observer, const SweepResults* results);

  void tell(const ResultRow& ended) override;
  [[nodiscard]] NextCases ask() override;
  [[nodiscard]] double progress() const override;

  [[nodiscard]] const FitSummary& summary() const { return summary_; }
  /// Faults of the first point whose parameters do not fit together.
  [[nodiscard]] const std::optional<InvalidRequest>& first_invalid() const { return first_invalid_; }

 private:
  /// Deviation of a signal over that with the best values, up to which a point counts as about as good.
  static constexpr double kAsGood = 1.5;

  struct Job {
    std::string id, state;
    std::optional<std::string> error_reason;
  };
  using Points = std::vector<FitPoint>;

  // Points that a stage needs and that are not there yet. None: summary_.stage is another one.
  Points run_stage();
  Points run_design();
  Points run_divergence();
  Points run_scatter();
  Points run_global();
  Points run_local();
  Points run_scan();
  Points run_profile();
  [[nodiscard]] ProfileProblem profile_problem() const;
  void end_profile(std::vector<ProfileInterval> profiles);
  void give_profile_up();
  void run_prediction(NextCases& next);

  void begin_global();
  /// Point of the population search in its box.
  [[nodiscard]] FitPoint point_in_box(const UnitPoint& parts) const;
  /// Ends of the box as parts of a span.
  [[nodiscard]] std::pair<double, double> box_of(std::size_t i) const;
  [[nodiscard]] UnitPoint box_parts_of(const FitPoint& point) const;
  void set_box(const LeastSquaresResult& result);
  void begin_local(const FitPoint& start, std::size_t pass);
  [[nodiscard]] bool gains_since(const FitPoint& earlier);
  void weigh_signals(const FitPoint& point);
  void begin_scan();
  [[nodiscard]] std::size_t count_scan_values() const;  ///< of each parameter
  /// Another search, or the last least squares.
  void end_search();
  /// After the search that shows of which kind the measured motion is.
  Points end_trial();
  void decide_basis();
  void set_basis(FitBasis basis);
  /// Points and their neighbours that judge_divergence_at() needs.
  [[nodiscard]] Points missing_neighbours_of(const Points& centres) const;
  /// Divergence of jobs beside a point; empty if too few have succeeded.
  [[nodiscard]] std::optional<SignalDivergence> judge_divergence_at(const FitPoint& centre);
  /// Points of the design whose features are nearest to the measured ones; fewer if fewer have succeeded.
  [[nodiscard]] Points nearest_by_features(std::size_t count) const;
  /// Features of those of some points that have succeeded.
  [[nodiscard]] std::vector<std::vector<double>> features_of(const Points& points) const;
  /// Sets the scale of each feature by how much it scatters.
  void set_feature_scale(const std::vector<std::vector<double>>& replicates);
  /// Scales the features that the measured signals have not by their mean over the design.
  void scale_absent_features();
  /// Sums of all points by features and their scale.
  void sum_features();
  void end_pass(const LeastSquaresResult& result);
  void end_feature_pass(const LeastSquaresResult& result);
  /// Residuals of each replicate of the best point, a column each.
  [[nodiscard]] Eigen::MatrixXd residuals_of_replicates() const;
  void begin_feature_scan();
  void end_features();
  void keep_jacobian(const LeastSquaresResult& result);
  void end_polish();
  void judge_residuals(const std::vector<double>& residuals);
  void end_local(LeastSquaresResult result);

  // Points and their jobs.
  void add_point(const FitPoint& point, NextCases& next);
  void add_jobs(std::size_t index, bool held_back, NextCases& next);
  void update_points();
  void update_point(std::size_t index);
  void lose(std::size_t index, std::string reason);
  void take(std::size_t index, Observation observation);
  void keep_residuals(const FitPointSummary& point, std::vector<double> residuals);
  [[nodiscard]] NextCases end_if_nothing_waits(NextCases next);

  [[nodiscard]] Points missing_of(const Points& points) const;
  /// Points that are no replicates, with all of theirs.
  [[nodiscard]] Points complete_points() const;
  /// The points whose mean counts for a point.
  [[nodiscard]] Points replicates_of(const FitPoint& point) const;
  /// Residuals as the basis has them; empty if the jobs have failed.
  [[nodiscard]] std::optional<std::vector<double>> residuals_of(const FitPoint& point);
  [[nodiscard]] std::optional<std::vector<double>> point_wise_residuals_of(const FitPoint& point) const;
  /// Mean features of a point and its replicates; empty if all have failed.
  [[nodiscard]] std::optional<std::vector<double>> mean_features_of(const FitPoint& point) const;
  [[nodiscard]] std::vector<double> feature_residuals(const std::vector<double>& features) const;
  /// @throws std::runtime_error if the trajectories cannot be read again
  [[nodiscard]] std::vector<double> residuals_of_best();
  /// FitPointSummary::loss, a mean for features; empty as residuals_of() is.
  [[nodiscard]] std::optional<double> loss_of(const FitPoint& point);
  void choose_best(const Points& among);
  /// Excess of a point's sum over that of the best one, in variances of the noise.
  [[nodiscard]] double excess_of(const FitPointSummary& point) const;
  [[nodiscard]] bool is_as_good(const FitPointSummary& point) const;
  /// Ranges of the points about as good as the best one, and of the linearised intervals.
  [[nodiscard]] std::vector<ValueRange> find_ranges() const;
  /// Ranges of the points about as good as the best one alone.
  [[nodiscard]] std::vector<ValueRange> find_ranges_of_points() const;
  /// A point below the threshold of a profile lies in its interval, wherever the refits went.
  void extend_profiles();
  /// Tells the least squares points that are there. @returns those that are not
  Points tell_least_squares(const Points& points);
  [[nodiscard]] bool is_point_wise() const {
    return summary_.basis.value_or(FitBasis::kPointWise) == FitBasis::kPointWise;
  }
  [[nodiscard]] LeastSquaresOptions local_options() const;
  void summarise_signals();

  const std::shared_ptr<const FitObserver> observer_;
  const FitProblem& problem_;
  std::map<std::string, Job> jobs_;                    ///< by ResultRow::swept
  std::map<FitPoint, std::size_t> indices_;            ///< in summary_.points
  std::vector<std::vector<std::string>> swept_;        ///< of the jobs of each point, one a run; empty: none
  std::vector<std::size_t> pending_;                   ///< points with jobs that have not ended
  std::size_t made_points_ = 0;                        ///< points up to the last whose jobs were added
  std::map<FitPoint, std::vector<double>> residuals_;  ///< point-wise ones that may be needed again
  double least_loss_ = std::numeric_limits<double>::infinity();  ///< of point-wise ones, of searches
  std::map<FitPoint, std::vector<double>> features_;
  std::vector<double> feature_scale_;
  double most_feature_sum_ = 0.0;  ///< of points as good as the best one
  Points base_points_;  ///< those that are no replicates
  FitPoint best_;       ///< empty: none has succeeded
  std::optional<SignalDivergence> divergence_;  ///< the largest one of the design; empty: none was judged
  FitPoint diverging_;     ///< point of the design beside which runs differ most; empty: none was judged
  bool is_trial_ = false;  ///< whether the search point by point is to show if motions diverge
  std::optional<PopulationSearch> population_;
  std::vector<double> box_sizes_;  ///< of the population search, as parts of the spans
  FitPoint box_centre_;
  Eigen::MatrixXd jacobian_;          ///< for the intervals, of residuals without factors
  std::size_t search_ = 0;            ///< number of the population search
  bool leaves_noise_ = true;          ///< whether the residuals of the least squares are noise
  std::optional<double> noise_loss_;  ///< of the best point when it left noise last
  bool ends_ = false;                 ///< whether the last least squares have begun
  Points scan_;
  std::vector<double> factors_;  ///< of each signal's residuals in least squares
  std::size_t pass_ = 0;         ///< of the least squares, in kChanges
  std::size_t replicates_ = 1;   ///< of a point; the mean of their features counts
  std::vector<double> steps_;    ///< of the differences of the parameters
  std::size_t global_limit_ = 0, polish_limit_ = 0, search_limit_ = 0,
              local_limit_ = 0;  ///< numbers of points
  Evaluations evaluations_;      ///< of the least squares
  FitPoint local_start_;
  FitPoint pass_start_;     ///< start of the first of the least squares
  std::optional<LeastSquaresResult> local_;
  std::size_t restarts_ = 0;  ///< of the least squares, from better points that profiles met
  bool cancelled_ = false;    ///< whether a job was
  std::optional<InvalidRequest> first_invalid_;
  FitSummary summary_;
};

}  // namespace jobs
