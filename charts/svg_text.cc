// SPDX-License-Identifier: Apache-2.0
#include "charts/svg_text.h"

#include <cstdio>

namespace charts {
namespace {

std::string escape(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

}  // namespace

std::string pixel(double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%.1f", value);
  return std::string(text) == "-0.0" ? "0.0" : text;
}

std::string draw_text(Point at, const char* anchor, const std::string& text, const std::string& more) {
  return "<text x=\"" + pixel(at.x) + "\" y=\"" + pixel(at.y) + "\" text-anchor=\"" + anchor + "\"" + more +
         ">" + escape(text) + "</text>\n";
}

std::string wrap_svg(const std::string& body, int width, int height) {
  const std::string size =
      "width=\"" + std::to_string(width) + "\" height=\"" + std::to_string(height) + "\"";
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size + " viewBox=\"0 0 " + std::to_string(width) +
         " " + std::to_string(height) +
         "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect " + size +
         " fill=\"#fff\"/>\n" + body + "</svg>\n";
}

}  // namespace charts
