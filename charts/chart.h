// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace charts {

/// Points joined by a line, or markers.
struct Series {
  std::string label{};           ///< in the legend; empty: not listed
  std::vector<double> x{}, y{};     ///< of one length; a point that is not finite breaks the line
  std::string colour = "#1f78b4";
  bool markers = false;          ///< a dot at each point as well
  double width = 1.2;            ///< of the line, [px]; 0: none
  std::string dashes{};          ///< lengths of dashes and gaps, "6 3"; empty: an unbroken line
};

enum class Scale { kLinear, kLog };

/// One pair of axes. Limits that are equal are taken from the data.
struct Chart {
  std::string title{}, x_label{}, y_label{};
  Scale x_scale = Scale::kLinear, y_scale = Scale::kLinear;
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0;
  std::vector<Series> series{};
  bool legend_outside = false;   ///< beside the axes, not over them
  bool equal_axes = false;       ///< a unit of x is as long as one of y: for orbits
};

/// Colours that are told apart by most eyes, in print too.
inline constexpr const char* kBlue = "#1f78b4";
inline constexpr const char* kOrange = "#d95f02";
inline constexpr const char* kGreen = "#33a02c";
inline constexpr const char* kRed = "#e31a1c";
inline constexpr const char* kPurple = "#6a3d9a";
inline constexpr const char* kGrey = "#999999";

/// Draws charts of one size in rows of `columns` as one SVG document. Coordinates are rounded to a tenth of a pixel.
[[nodiscard]] std::string draw(const std::vector<Chart>& charts, int columns, int width = 520, int height = 320);

}  // namespace charts
