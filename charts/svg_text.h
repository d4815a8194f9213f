// SPDX-License-Identifier: Apache-2.0
// Parts of SVG documents that all drawings use.
#pragma once

#include <string>

namespace charts {

struct Point {
  double x, y;
};

/// A pixel coordinate: a tenth is finer than the eye.
[[nodiscard]] std::string pixel(double value);

/// @param anchor  start, middle or end  @param more  other attributes, with a blank before each
[[nodiscard]] std::string draw_text(Point at, const char* anchor, const std::string& text,
                                    const std::string& more = "");

/// A document with a white ground, of that size in pixels.
[[nodiscard]] std::string wrap_svg(const std::string& body, int width, int height);

}  // namespace charts
