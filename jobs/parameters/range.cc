// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/range.h"

#include <array>
#include <charconv>
#include <cmath>

namespace jobs {

bool Range::contains(double x) const {
  const bool above = lower == Bound::kInclusive ? x >= minimum : x > minimum;
  const bool below = upper == Bound::kInclusive ? x <= maximum : x < maximum;
  return above && below;
}

std::string Range::text() const {
  return std::string("in ") + (lower == Bound::kInclusive ? "[" : "(") + readable_number(minimum) + ", " +
         readable_number(maximum) + (upper == Bound::kInclusive ? "]" : ")");
}

std::string readable_number(double x) {
  const double size = std::abs(x);
  const bool plain = x == 0.0 || (size >= 1e-4 && size < 1e10);
  std::array<char, 40> buffer;  // 10 digits, a point, and 4 zeros and 17 digits after it
  return {buffer.data(),
          plain ? std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::fixed).ptr
                : std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr};
}

std::string number_text(double x) {
  std::array<char, 32> buffer;  // the longest double takes 24 characters
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr;
  return {buffer.data(), end};
}

}  // namespace jobs
