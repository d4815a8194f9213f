// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/least_squares.h"

#include <algorithm>

#include <ceres/cost_function.h>
#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "jobs/fits/fit_path.h"

namespace jobs {
namespace {

// A rejected step divides the radius by 2, 4, 8, ...: from much larger ones many simulations would be spent
// on almost the same point.
constexpr double kFirstRadius = 100.0;
constexpr double kLargestRadius = 1e6;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Residuals of a fit path for Ceres, which wants the Jacobian at accepted points alone.
class PathCost final : public ceres::CostFunction {
 public:
  PathCost(FitPath& path, std::size_t residuals) : path_(path) {
    set_num_residuals(static_cast<int>(residuals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(path.free().size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const auto n = static_cast<Eigen::Index>(path_.free().size());
    const Eigen::VectorXd parts = Eigen::Map<const Eigen::VectorXd>(parameters[0], n);
    Eigen::Map<Eigen::VectorXd> out(residuals, num_residuals());
    if (jacobians == nullptr || jacobians[0] == nullptr) return evaluate_step(parts, out);
    Eigen::Map<RowMajor> jacobian(jacobians[0], num_residuals(), n);
    // Ceres logs a missing Jacobian, even if it is to be silent. With zeros it ends at once.
    if (path_.accept(parts) != FitPath::Step::kEvaluated) {
      out.setZero();
      jacobian.setZero();
      return true;
    }
    out = path_.result().residuals;
    jacobian = path_.calc_descent_jacobian();
    return true;
  }

 private:
  bool evaluate_step(const Eigen::VectorXd& parts, Eigen::Map<Eigen::VectorXd>& out) const {
    Eigen::VectorXd residuals;
    if (path_.try_step(parts, residuals) != FitPath::Step::kEvaluated) return false;
    out = residuals;
    return true;
  }

  FitPath& path_;
};

/// Ends Ceres' iterations where the path has stopped: a missing point is no failed one.
class StopWithPath final : public ceres::IterationCallback {
 public:
  explicit StopWithPath(const FitPath& path) : path_(path) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return path_.stopped() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const FitPath& path_;
};

ceres::Solver::Options make_solver_options(const LeastSquaresOptions& options) {
  ceres::Solver::Options solver;
  solver.max_num_iterations = static_cast<int>(options.max_iterations);
  solver.function_tolerance = options.function_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.initial_trust_region_radius = kFirstRadius;
  solver.max_trust_region_radius = kLargestRadius;
  solver.max_num_line_search_step_size_iterations = 0;  // shorter steps come from the trust region
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  return solver;
}

void set_bounds(Eigen::VectorXd& parts, ceres::Problem& problem) {
  for (int k = 0; k < static_cast<int>(parts.size()); ++k) {
    problem.SetParameterLowerBound(parts.data(), k, 0.0);
    problem.SetParameterUpperBound(parts.data(), k, 1.0);
  }
}

ceres::Solver::Summary run_ceres(FitPath& path, const LeastSquaresOptions& options, std::size_t residuals) {
  Eigen::VectorXd parts = path.start();
  PathCost cost(path, residuals);
  StopWithPath stop(path);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost, nullptr, parts.data());
  set_bounds(parts, problem);
  ceres::Solver::Options solver = make_solver_options(options);
  solver.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary;
}

void set_end(const ceres::Solver::Summary& summary, const FitPath& path, LeastSquaresResult& result) {
  if (path.failed_steps() > 0 && summary.termination_type != ceres::NO_CONVERGENCE) {
    result.end = FitEnd::kBesideFailures;
    result.message = "The fit ended beside points at which the simulation fails: the last steps led there, " +
                     std::to_string(path.failed_steps()) + " in all.";
  } else if (summary.termination_type == ceres::CONVERGENCE) {
    result.end = FitEnd::kConverged;
    result.message = "The fit converged.";
  } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
    result.end = FitEnd::kMostIterations;
    result.message = "The fit ended at its largest number of iterations.";
  } else {
    result.end = FitEnd::kNoDerivative;
    result.message = "The fit ended without convergence: " + summary.message;
  }
}

/// Answer where Ceres has nothing to do: it asks for the start and its derivatives first.
/// @returns empty once these are there
std::optional<LeastSquaresAnswer> find_answer_at_start(const LeastSquaresProblem& problem,
                                                       const Evaluations& evaluations) {
  FitPath path(problem, evaluations);
  if (path.accept(path.start()) == FitPath::Step::kEvaluated && !path.free().empty()) return std::nullopt;
  const bool has_failed = path.stopped() && path.result().end == FitEnd::kStartFailed;
  if (!path.missing().empty() && !has_failed)
    return LeastSquaresAnswer{.points = path.missing(), .result = std::nullopt};
  LeastSquaresAnswer answer{.points = {}, .result = path.result()};
  answer.result->evaluations = path.count_evaluations();
  if (answer.result->message.empty()) answer.result->message = "There was no parameter to fit.";
  return answer;
}

}  // namespace

LeastSquaresAnswer solve_least_squares(const LeastSquaresProblem& problem, const Evaluations& evaluations) {
  if (auto answer = find_answer_at_start(problem, evaluations)) return *std::move(answer);
  FitPath path(problem, evaluations);
  LeastSquaresAnswer answer;
  const ceres::Solver::Summary summary = run_ceres(path, problem.options, evaluations.residual_count());
  if (!path.missing().empty()) {
    answer.points = path.missing();
    return answer;
  }
  answer.result = path.result();
  if (!path.stopped()) set_end(summary, path, *answer.result);
  answer.result->iterations = static_cast<std::size_t>(std::max(summary.num_successful_steps, 1)) - 1;
  answer.result->evaluations = path.count_evaluations();
  return answer;
}

}  // namespace jobs
