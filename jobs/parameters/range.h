// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace jobs {

enum class Bound { kInclusive, kExclusive };

/// The values that a number may take. NaN and the infinities lie in no range.
struct Range {
  double minimum = -std::numeric_limits<double>::max();
  double maximum = std::numeric_limits<double>::max();
  Bound lower = Bound::kInclusive;
  Bound upper = Bound::kInclusive;

  [[nodiscard]] bool contains(double x) const;
  [[nodiscard]] std::string text() const;  ///< for the user: "in (0, 3600]"
};

/// With both ends.
[[nodiscard]] constexpr Range between(double minimum, double maximum) { return {.minimum = minimum,
                                                                                .maximum = maximum}; }
/// Without its minimum.
[[nodiscard]] constexpr Range above(double minimum, double maximum) {
  return {.minimum = minimum, .maximum = maximum, .lower = Bound::kExclusive};
}
/// Without its maximum.
[[nodiscard]] constexpr Range below(double minimum, double maximum) {
  return {.minimum = minimum, .maximum = maximum, .upper = Bound::kExclusive};
}

/// Seeds: the integers that every reader of JSON keeps.
inline constexpr Range kSeedRange{.minimum = 0, .maximum = 9007199254740991.0};

/// A number in a sentence: without an exponent where that is easy to read. Reads back as the same double,
/// too.
[[nodiscard]] std::string readable_number(double x);

/// The shortest decimal that reads back as the same double; "nan", "inf" and "-inf" for the others.
[[nodiscard]] std::string number_text(double x);

}  // namespace jobs
