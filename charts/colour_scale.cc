// SPDX-License-Identifier: Apache-2.0
#include "charts/colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>

namespace charts {

namespace {

/// Viridis of matplotlib (CC0) at eighths of its length; linear in between.
constexpr std::array<std::array<int, 3>, 9> kStops{{{68, 1, 84},
                                                    {71, 44, 122},
                                                    {59, 81, 139},
                                                    {44, 113, 142},
                                                    {33, 144, 141},
                                                    {39, 173, 129},
                                                    {92, 200, 99},
                                                    {170, 220, 50},
                                                    {253, 231, 37}}};

}  // namespace

std::string colour_at(double part) {
  const double place = std::clamp(std::isfinite(part) ? part : 0.0, 0.0, 1.0) * (kStops.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double rest = place - static_cast<double>(first);
  std::array<int, 3> rgb{};
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = static_cast<int>(std::lround((1.0 - rest) * kStops[first][i] + rest * kStops[first + 1][i]));
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(rgb[0]) & 0xffU,
                static_cast<unsigned>(rgb[1]) & 0xffU, static_cast<unsigned>(rgb[2]) & 0xffU);
  return text;
}

const char* text_colour_on(double part) { return part < 0.6 ? "#fff" : "#000"; }

}  // namespace charts
