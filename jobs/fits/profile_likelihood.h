// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "jobs/fits/intervals.h"
#include "jobs/fits/least_squares.h"

namespace jobs {

struct ProfileProblem {
  std::vector<Span> spans;
  LeastSquaresResult best;
  FitIntervals intervals;       ///< of best, by calc_intervals()
  LeastSquaresOptions refit;    ///< of the other parameters at each value; few iterations suffice
  std::size_t max_values = 10;  ///< of a parameter on each side
};

enum class ProfileVerdict {
  kFound,
  kOpen,  ///< the sum stays below the threshold up to the bound
  kLost,  ///< not found, since simulations fail or values do not suffice
};

struct ProfileEnd {
  double value = 0.0;  ///< of the parameter; the bound if open
  ProfileVerdict verdict = ProfileVerdict::kLost;
  std::string message;  ///< empty if found
};

/// Interval of one parameter. `better` is a point with a smaller sum than the best one had, if one was
/// met.
struct ProfileInterval {
  ProfileEnd low, high;
  std::optional<FitPoint> better;
};

/// Either points to be simulated or an interval a parameter.
struct ProfileAnswer {
  std::vector<FitPoint> points;
  std::optional<std::vector<ProfileInterval>> result;
};

/// Ends of the intervals within which the least sum over the other parameters stays below
///
///     S(x_i) = S_best + s^2 c_i q^2,   q: FitIntervals::quantile, c_i: inflation by autocorrelation.
///
/// For white residuals s^2 q^2 is the threshold of the F test of all n parameters together. Secants run on
/// the root of S
/// - S_best, which is linear in x_i for a linear model. Source: Bates & Watts (1988), Nonlinear Regression
/// Analysis and Its Applications, section 6.1 (profile t).
[[nodiscard]] ProfileAnswer profile_likelihood(const ProfileProblem& problem, const Evaluations& evaluations);

}  // namespace jobs
