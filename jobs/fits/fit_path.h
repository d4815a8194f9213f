// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "jobs/fits/evaluations.h"
#include "jobs/fits/least_squares.h"

namespace jobs {

/// Path of a fit through the evaluations told so far: the points on it, their derivatives, and where the
/// evaluations end.
class FitPath {
 public:
  FitPath(const LeastSquaresProblem& problem, const Evaluations& evaluations);

  /// Indices of the parameters that are fitted.
  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }
  /// Parts of the spans at the start, one a free parameter.
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }

  enum class Step { kEvaluated, kFailed, kStopped };
  /// Residuals at the point of a step. @param parts  one a free parameter
  Step try_step(const Eigen::VectorXd& parts, Eigen::VectorXd& residuals);
  /// Residuals and Jacobian at a point that the fit goes on from; the result is there from now on.
  Step accept(const Eigen::VectorXd& parts);

  [[nodiscard]] bool stopped() const { return stopped_; }
  /// Points that have not been told; empty unless the path has stopped for want of them.
  [[nodiscard]] const std::vector<FitPoint>& missing() const { return missing_; }
  /// Failed steps since the last accepted point.
  [[nodiscard]] std::size_t failed_steps() const { return failed_steps_; }
  [[nodiscard]] const LeastSquaresResult& result() const { return result_; }
  /// Jacobian at the accepted point by the free parameters, without those that descent holds at their bounds.
  [[nodiscard]] Eigen::MatrixXd calc_descent_jacobian() const;
  [[nodiscard]] std::size_t count_evaluations() const { return visited_.size(); }

 private:
  struct Neighbour {
    FitPoint point;
    double distance = 0.0;  ///< as part of the span, with its sign
  };

  [[nodiscard]] FitPoint point_at(const Eigen::VectorXd& parts) const;
  [[nodiscard]] Neighbour neighbour(const Eigen::VectorXd& parts, Eigen::Index column, double distance) const;
  [[nodiscard]] double step_of(Eigen::Index column) const;
  [[nodiscard]] std::string name_of(std::size_t parameter) const;
  [[nodiscard]] std::vector<double> first_distances(double part, Eigen::Index column) const;
  [[nodiscard]] std::vector<double> fallback_distances(double part, Eigen::Index column) const;
  const std::optional<std::vector<double>>* visit(const FitPoint& point);
  void speculate(const Eigen::VectorXd& parts);
  bool add_column(const Eigen::VectorXd& parts, Eigen::Index column);
  void set_column(Eigen::Index column, const std::vector<Neighbour>& used);
  Step stop(FitEnd end, std::string message);

  const LeastSquaresProblem& problem_;
  const Evaluations& evaluations_;
  std::vector<std::size_t> free_;
  Eigen::VectorXd start_, accepted_;
  std::set<FitPoint> visited_;
  std::vector<FitPoint> missing_;
  bool stopped_ = false;
  std::size_t failed_steps_ = 0;
  LeastSquaresResult result_;
};

}  // namespace jobs
