// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/fits/evaluations.h"
#include "jobs/fits/fit_problem.h"
#include "jobs/parameters/span.h"

namespace jobs {

/// Spans of the parameters.
[[nodiscard]] std::vector<Span> spans_of(const FitProblem& problem);

/// Paths of the parameters.
[[nodiscard]] std::vector<std::string> names_of(const FitProblem& problem);

/// Point at the given parts of the spans: the nearest decimals of 12 digits.
/// @param parts  in [0, 1], one a parameter
[[nodiscard]] FitPoint point_at(const FitProblem& problem, const std::vector<double>& parts);

/// Start of the search: the starts of the parameters, the middle of the span of those without one.
[[nodiscard]] FitPoint start_of(const FitProblem& problem);

/// Point beside another one, for a motion from a slightly different start: each parameter is shifted by a
/// random part, at most kReplicateShift, of its span. @param k  1, 2, ...
[[nodiscard]] FitPoint replicate_of(const FitProblem& problem, const FitPoint& point, std::size_t k);
inline constexpr double kReplicateShift = 1e-5;

/// @returns whether a run has samples that are fitted. Others are predicted with the best values.
[[nodiscard]] bool is_fitted(const FitProblem& problem, std::size_t run);

/// Case of the sweep with the job of one run at a point.
[[nodiscard]] nlohmann::ordered_json case_of(const FitProblem& problem, std::size_t run,
                                             const FitPoint& point);

/// Sensor of a signal at a point.
[[nodiscard]] SensorModel sensor_of(const FitProblem& problem, const FitSignal& signal,
                                    const FitPoint& point);

}  // namespace jobs
