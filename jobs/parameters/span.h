// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"

namespace jobs {

/// Interval of numbers, divided in equal steps or in equal ratios.
struct Span {
  double from = 0.0;
  double to = 0.0;
  bool logarithmic = false;  ///< then both ends are above 0
};

/// Steps of the searches between the ends of a span, as decimal_between() takes them.
inline constexpr double kSearchSteps = 1e6;

/// Number between two others above 0, from (to / from)^part: NaN or beyond the ends if to / from is no normal
/// double.
[[nodiscard]] double geometric_between(double from, double to, double part);

/// Value of a span at a part of it: the nearest decimal of at most 12 significant digits, none of them below
/// the 15th place of the larger end, so that a sixth of 0 to 0.6 is 0.1, and a sum that cancels is 0. Ends
/// are exact. Where decimals of 12 digits are too coarse, further from the value than a thousandth of a step,
/// the value is the nearest double.
/// @param part   in [0, 1]
/// @param steps  number of steps in the span
[[nodiscard]] double decimal_between(const Span& span, long double part, double steps);

/// Reads {"from", "to", "scale"}; "scale" is "linear" (the default) or "log". Adds the faults of its form.
/// @param other_keys  what else may stand there; the caller reads it
[[nodiscard]] std::optional<Span> read_span(const nlohmann::json& span,
                                            std::span<const std::string_view> other_keys,
                                            const std::string& pointer, std::vector<Fault>& faults);

}  // namespace jobs
