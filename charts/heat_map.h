// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace charts {

/// Values over two lists.
struct HeatMap {
  std::string title{};
  std::vector<std::string> columns{}, rows{};  ///< names; the first row stands at the bottom
  std::vector<std::vector<double>> values{};   ///< by row, then column; not finite: none, drawn as a dash
};

/// Draws heat maps of one colour scale below each other, with the scale at the end, as one SVG document. The
/// largest of all values has a frame; values are written into cells that have room.
[[nodiscard]] std::string draw_heat_maps(const std::vector<HeatMap>& maps, const std::string& x_label,
                                         const std::string& y_label, const std::string& value_label,
                                         int width = 1040);

}  // namespace charts
