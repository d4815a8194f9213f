// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>

namespace jobs {

/// First-order Sobol' index Var(E[y | x]) / Var(y) of one input, estimated from any random sample: x is
/// divided into classes, each word or, of numbers, each of at most 16 stretches of equally many points, and
///
///     index = (S_between - (classes - 1) S_within / (n - classes)) / S_total,   cut at 0,
///
/// with the sums of squares between the classes' means, within the classes and in all: the second term is
/// what chance alone puts between them. Source: Plischke, Borgonovo & Smith (2013), Global sensitivity
/// measures from given data, section 4 (classes); Kelley (1935), epsilon squared (bias).
/// @param x  numbers or words  @param y  as many
/// @returns empty if y varies by no more than rounding, or if there are fewer than two points a class
[[nodiscard]] std::optional<double> calc_first_order_index(std::span<const nlohmann::json> x,
                                                           std::span<const double> y);

}  // namespace jobs
