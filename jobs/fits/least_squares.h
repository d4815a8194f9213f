// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "jobs/fits/evaluations.h"
#include "jobs/parameters/span.h"

namespace jobs {

enum class Differences { kForward, kCentral };

struct LeastSquaresOptions {
  std::size_t max_evaluations = 500;  ///< no step begins beyond it; the derivatives of a step still do
  std::size_t max_iterations = 50;    ///< steps that are tried
  double step = 1e-4;                 ///< of the differences, as part of a parameter's range
  std::vector<double> steps{};        ///< of each parameter; empty: step of all
  Differences differences = Differences::kForward;
  double function_tolerance = 1e-7;   ///< relative decrease of the sum of squares
  double parameter_tolerance = 1e-7;  ///< length of a step, relative to the ranges
  double gradient_tolerance = 1e-10;  ///< of half the sum of squares by the part of a range
  std::size_t processors = 2;         ///< simulations that run side by side
};

struct LeastSquaresProblem {
  std::vector<Span> spans;         ///< range and scale of each parameter, from < to
  FitPoint start;                  ///< within the spans
  std::vector<std::size_t> fixed;  ///< indices of parameters that stay at the start
  LeastSquaresOptions options;
  std::vector<std::string> names{};  ///< of the parameters, for messages
};

enum class FitEnd {
  kConverged,
  kMostEvaluations,
  kMostIterations,
  kStartFailed,     ///< no result but the message
  kNoDerivative,    ///< the simulations beside a point fail on both sides
  kBesideFailures,  ///< the last steps led to points at which the simulation fails
};

struct LeastSquaresResult {
  FitEnd end = FitEnd::kConverged;
  FitPoint x;                   ///< best point, one whose derivatives are known
  double sum = 0.0;             ///< of the squares of the residuals
  Eigen::VectorXd residuals;    ///< at x
  Eigen::MatrixXd jacobian;     ///< of the residuals by the parts of the spans; 0 by a fixed parameter
  std::size_t iterations = 0;   ///< accepted steps
  std::size_t evaluations = 0;  ///< points that have been asked for
  std::string message;          ///< end of the fit, a sentence
};

/// Either points to be simulated or the result.
struct LeastSquaresAnswer {
  std::vector<FitPoint> points;
  std::optional<LeastSquaresResult> result;
};

/// Local minimum of the sum of squares within the spans, by Ceres' Levenberg-Marquardt method in the
/// parts of the spans.
///
/// The fit runs from its start through the evaluations as far as they reach: the answer is a function of the
/// problem and of the evaluations, in whichever order they were told. Derivatives are differences of
/// simulations. The derivative by a parameter at its bound counts as 0 where descent leads outwards, so that
/// the others take the whole Gauss-Newton step. Source: Bertsekas (1982), Projected Newton methods for
/// optimization problems with simple constraints, SIAM J. Control Optim. 20. A step to a point whose
/// simulation fails is repeated shorter. Points are decimals of at most 12 digits where the range allows.
///
/// With a step's point the first of its neighbours are asked for, as many as there are further processors: as
/// early as with all neighbours, and no processor is idle.
/// @throws engine::InvalidInput if the start is not within the spans
[[nodiscard]] LeastSquaresAnswer solve_least_squares(const LeastSquaresProblem& problem,
                                                     const Evaluations& evaluations);

}  // namespace jobs
