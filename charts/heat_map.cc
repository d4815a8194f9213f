// SPDX-License-Identifier: Apache-2.0
#include "charts/heat_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "charts/colour_scale.h"
#include "charts/svg_text.h"

namespace charts {
namespace {

constexpr double kRow = 20.0, kTitle = 24.0, kBelow = 44.0, kCharacter = 6.6;
constexpr double kLeastCellWithText = 34.0;
constexpr double kScaleHeight = 46.0;

struct ValueRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_empty() const { return !(least <= most); }
  [[nodiscard]] double part_of(double value) const {
    return most > least ? (value - least) / (most - least) : 0.5;
  }
};

ValueRange range_of(const std::vector<HeatMap>& maps) {
  ValueRange range;
  for (const HeatMap& map : maps)
    for (const auto& row : map.values)
      for (const double value : row) {
        if (!std::isfinite(value)) continue;
        range.least = std::min(range.least, value);
        range.most = std::max(range.most, value);
      }
  return range;
}

/// In three digits, or all before the point.
std::string short_number(double value) {
  const double size = std::abs(value);
  char text[32];
  std::snprintf(text, sizeof text,
                size >= 1e5 || (size > 0.0 && size < 1e-3) ? "%.1e"
                : size >= 100.0                            ? "%.0f"
                                                           : "%.3g",
                value);
  return text;
}

std::string draw_rect(double x, double y, double width, double height, const std::string& look) {
  return "<rect x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" width=\"" + pixel(width) + "\" height=\"" +
         pixel(height) + "\" " + look + "/>\n";
}

/// Every how many names there is room for one.
std::size_t stride_for(const std::vector<std::string>& names, double room) {
  std::size_t longest = 1;
  for (const std::string& name : names) longest = std::max(longest, name.size());
  return static_cast<std::size_t>(std::ceil((kCharacter * static_cast<double>(longest) + 8.0) / room));
}

class HeatMapDrawing {
 public:
  HeatMapDrawing(const HeatMap& map, const ValueRange& range, double left, double top, double width)
      : map_(map),
        range_(range),
        left_(left),
        top_(top + kTitle),
        cell_(std::min((width - left) / static_cast<double>(map.columns.size()), 90.0)) {}

  [[nodiscard]] std::string draw(const std::string& x_label) const {
    std::string svg = draw_text({left_, top_ - 8.0}, "start", map_.title, " font-weight=\"bold\"");
    for (std::size_t r = 0; r < map_.rows.size(); ++r) {
      svg += draw_text({left_ - 6.0, y_of(r) + 14.0}, "end", map_.rows[r]);
      for (std::size_t c = 0; c < map_.columns.size(); ++c) svg += draw_cell(r, c);
    }
    const double bottom = top_ + kRow * static_cast<double>(map_.rows.size());
    const std::size_t stride = stride_for(map_.columns, cell_);
    for (std::size_t c = 0; c < map_.columns.size(); c += stride)
      svg += draw_text({x_of(c) + 0.5 * cell_, bottom + 15.0}, "middle", map_.columns[c]);
    return svg + draw_text({left_ + 0.5 * cell_ * static_cast<double>(map_.columns.size()), bottom + 32.0},
                           "middle", x_label);
  }

 private:
  [[nodiscard]] double x_of(std::size_t column) const { return left_ + cell_ * static_cast<double>(column); }
  [[nodiscard]] double y_of(std::size_t row) const {
    return top_ + kRow * static_cast<double>(map_.rows.size() - 1 - row);
  }

  [[nodiscard]] std::string draw_cell(std::size_t row, std::size_t column) const {
    const double value = map_.values[row][column];
    const double x = x_of(column), y = y_of(row);
    const Point middle{x + 0.5 * cell_, y + 14.0};
    if (!std::isfinite(value))
      return draw_rect(x, y, cell_, kRow, "fill=\"#fff\" stroke=\"#ddd\"") + draw_text(middle, "middle", "–");
    const double part = range_.part_of(value);
    std::string svg = draw_rect(x, y, cell_, kRow, "fill=\"" + colour_at(part) + "\"");
    if (cell_ >= kLeastCellWithText)
      svg += draw_text(middle, "middle", short_number(value),
                       std::string(" font-size=\"10\" fill=\"") + text_colour_on(part) + "\"");
    if (value == range_.most)
      svg += draw_rect(x + 1.0, y + 1.0, cell_ - 2.0, kRow - 2.0,
                       "fill=\"none\" stroke=\"#d00\" stroke-width=\"2\"");
    return svg;
  }

  const HeatMap& map_;
  const ValueRange& range_;
  double left_, top_, cell_;
};

std::string draw_scale(const ValueRange& range, double left, double top, const std::string& label) {
  constexpr int kSteps = 64;
  constexpr double kWidth = 320.0;
  std::string svg;
  for (int k = 0; k < kSteps; ++k)
    svg += draw_rect(left + kWidth * k / kSteps, top, kWidth / kSteps + 0.5, 12.0,
                     "fill=\"" + colour_at((k + 0.5) / kSteps) + "\"");
  return svg + draw_text({left, top + 26.0}, "start", short_number(range.least)) +
         draw_text({left + kWidth, top + 26.0}, "end", short_number(range.most)) +
         draw_text({left + kWidth + 12.0, top + 10.0}, "start", label + ", the largest framed");
}

/// Label that stands upright at the left of a map's rows.
std::string draw_y_label(const std::string& label, double top, double height) {
  const double middle = top + 0.5 * height;
  return draw_text({12.0, middle}, "middle", label, " transform=\"rotate(-90 12.0 " + pixel(middle) + ")\"");
}

double left_margin_of(const std::vector<HeatMap>& maps) {
  std::size_t longest = 1;
  for (const HeatMap& map : maps)
    for (const std::string& row : map.rows) longest = std::max(longest, row.size());
  return 34.0 + kCharacter * static_cast<double>(longest);
}

}  // namespace

std::string draw_heat_maps(const std::vector<HeatMap>& maps, const std::string& x_label,
                           const std::string& y_label, const std::string& value_label, int width) {
  const ValueRange range = range_of(maps);
  if (range.is_empty()) return "";
  const double left = left_margin_of(maps);
  std::string body;
  double y = 0.0;
  for (const HeatMap& map : maps) {
    body += HeatMapDrawing(map, range, left, y, width - 14.0).draw(x_label);
    const double height = kRow * static_cast<double>(map.rows.size());
    body += draw_y_label(y_label, y + kTitle, height);
    y += kTitle + height + kBelow;
  }
  body += draw_scale(range, left, y, value_label);
  return wrap_svg(body, width, static_cast<int>(std::ceil(y + kScaleHeight)));
}

}  // namespace charts
