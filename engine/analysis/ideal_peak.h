// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "engine/analysis/step_quadratic.h"
#include "engine/model/rpsup_parameters.h"

namespace engine {

/// Largest slider acceleration that the drives ask of the linkage itself: rigid, ideal, driven exactly;
/// located to rounding.
/// @param from, to        window, [s]
/// @param stop_requested  asked now and then with the simulated time, may be empty; true ends the search
/// without a result
/// @returns empty if the window is empty, the ideal linkage locks in it, or an actuator moves it: drives do
/// not determine its motion then
[[nodiscard]] std::optional<Peak> find_ideal_peak(const RpsupParameters& parameters, double from, double to,
                                                  const std::function<bool(double)>& stop_requested);

}  // namespace engine
