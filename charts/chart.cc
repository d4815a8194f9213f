// SPDX-License-Identifier: Apache-2.0
#include "charts/chart.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <utility>

#include "charts/svg_text.h"

namespace charts {

namespace {

std::string format(const char* pattern, double value) {
  char text[48];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string format_digits(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// One axis: from values to pixels.
class PlotAxis {
 public:
  PlotAxis(Scale scale, double least, double most, double first_pixel, double last_pixel)
      : scale_(scale), least_(least), most_(most), first_(first_pixel), last_(last_pixel) {}

  [[nodiscard]] double pixel_of(double value) const {
    return first_ + (last_ - first_) * (transform(value) - transform(least_)) / (transform(most_) - transform(least_));
  }

  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> values;
    if (scale_ == Scale::kLog) {
      const int from = static_cast<int>(std::ceil(std::log10(least_) - 1e-9));
      const int to = static_cast<int>(std::floor(std::log10(most_) + 1e-9));
      const int stride = std::max(1, (to - from + 7) / 8);
      for (int e = from; e <= to; e += stride) values.push_back(std::pow(10.0, e));
      return values;
    }
    const double interval = find_interval((most_ - least_) / kIntervals);
    const double first = std::ceil(least_ / interval - 1e-9), last = std::floor(most_ / interval + 1e-9);
    const bool told_apart = std::max(std::abs(first), std::abs(last)) < 1.0 / std::numeric_limits<double>::epsilon();
    for (double k = first; told_apart && k <= last; k += 1.0) values.push_back(k == 0.0 ? 0.0 : k * interval);  // no minus zero
    return values;
  }

  /// With as many digits as tell it from its neighbours.
  [[nodiscard]] std::string label(double tick) const {
    const double size = std::max(std::abs(least_), std::abs(most_));
    const double digits = scale_ == Scale::kLog ? 4.0 : 1.0 + std::ceil(std::log10(kIntervals * size / (most_ - least_)));
    return format_digits(tick, static_cast<int>(std::min(std::max(4.0, digits), 17.0)));
  }

  [[nodiscard]] std::size_t longest_label() const {
    std::size_t longest = 0;
    for (const double tick : ticks()) longest = std::max(longest, label(tick).size());
    return longest;
  }

 private:
  static constexpr double kIntervals = 5.0;  // between ticks, about

  [[nodiscard]] double transform(double value) const { return scale_ == Scale::kLog ? std::log10(value) : value; }

  /// 1, 2 or 5 times a power of ten.
  static double find_interval(double wanted) {
    const double power = std::pow(10.0, std::floor(std::log10(wanted)));
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor * power >= wanted) return factor * power;
    return 10.0 * power;
  }

  Scale scale_;
  double least_, most_, first_, last_;
};

constexpr double kLargestDrawn = 1e300;  // with larger ones the arithmetic here would overflow
constexpr double kLeastSpan = 1e-9;      // of the values' size; what lies closer differs by rounding, and is drawn as one

bool can_be_drawn(double value, Scale scale) { return std::abs(value) < kLargestDrawn && (scale == Scale::kLinear || value > 0.0); }

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void take(const std::vector<double>& values, Scale scale) {
    for (const double value : values) {
      if (!can_be_drawn(value, scale)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
};

/// The limits asked for, where an axis can have them, or those of the data with room around them.
Range limits(double least, double most, Scale scale, const std::vector<const std::vector<double>*>& data) {
  if (least < most && can_be_drawn(least, scale) && can_be_drawn(most, scale)) return {least, most};
  Range range;
  for (const auto* values : data) range.take(*values, scale);
  if (!(range.least <= range.most)) return {1.0, 2.0};
  if (scale == Scale::kLog) return {range.least / 1.6, range.most * 1.6};
  const double size = std::max(std::abs(range.least), std::abs(range.most));
  const double span = range.most - range.least;
  const double room = span > kLeastSpan * size ? 0.04 * span : std::max(1.0, 0.01 * size);
  return {range.least - room, range.most + room};
}

Range find_y_range(const Chart& chart) {
  std::vector<const std::vector<double>*> data;
  for (const Series& s : chart.series) data.push_back(&s.y);
  return limits(chart.y_min, chart.y_max, chart.y_scale, data);
}

/// Room for the ticks' labels at the left, and for the axis' own, which stands upright.
double calc_left_margin(const Chart& chart) {
  constexpr double kCharacter = 7.0, kLeast = 62.0;
  const Range range = find_y_range(chart);
  const auto longest = static_cast<double>(PlotAxis(chart.y_scale, range.least, range.most, 0.0, 1.0).longest_label());
  return std::max(kLeast, kCharacter * longest + (chart.y_label.empty() ? 8.0 : 22.0));
}

std::size_t longest_series_label(const Chart& chart) {
  std::size_t longest = 0;
  for (const Series& series : chart.series) longest = std::max(longest, series.label.size());
  return longest;
}

/// Room for a legend beside the axes.
double calc_legend_width(const Chart& chart) {
  if (!chart.legend_outside || longest_series_label(chart) == 0) return 0.0;
  return 6.6 * static_cast<double>(longest_series_label(chart)) + 30.0;
}

class ChartDrawing {
 public:
  ChartDrawing(const Chart& chart, double left, double top, double width, double height)
      : chart_(chart),
        left_(left),
        box_{left + calc_left_margin(chart), top + 28.0, left + width - 14.0 - calc_legend_width(chart), top + height - 40.0},
        x_(make_x()),
        y_(make_y()) {}

  [[nodiscard]] std::string draw() const {
    std::string svg = draw_frame();
    for (const Series& series : chart_.series) svg += draw_series(series);
    return svg + draw_legend();
  }

 private:
  struct Box {
    double left, top, right, bottom;
  };

  [[nodiscard]] PlotAxis make_x() const {
    std::vector<const std::vector<double>*> data;
    for (const Series& s : chart_.series) data.push_back(&s.x);
    const Range range = limits(chart_.x_min, chart_.x_max, chart_.x_scale, data);
    const double width = chart_.equal_axes ? std::min(box_.right - box_.left, box_.bottom - box_.top) : box_.right - box_.left;
    return {chart_.x_scale, range.least, range.most, box_.left, box_.left + width};
  }

  [[nodiscard]] PlotAxis make_y() const {
    const Range range = find_y_range(chart_);
    const double height = chart_.equal_axes ? std::min(box_.right - box_.left, box_.bottom - box_.top) : box_.bottom - box_.top;
    return {chart_.y_scale, range.least, range.most, box_.top + height, box_.top};
  }

  [[nodiscard]] std::string draw_x_ticks() const {
    std::string svg;
    for (const double tick : x_.ticks()) {
      const double x = x_.pixel_of(tick);
      svg += "<path d=\"M" + pixel(x) + " " + pixel(box_.top) + "V" + pixel(box_.bottom) + "\" stroke=\"#e4e4e4\"/>\n";
      svg += draw_text({x, box_.bottom + 15.0}, "middle", x_.label(tick));
    }
    return svg;
  }

  /// @param right  end of the lines at the ticks
  [[nodiscard]] std::string draw_y_ticks(double right) const {
    std::string svg;
    for (const double tick : y_.ticks()) {
      const double y = y_.pixel_of(tick);
      svg += "<path d=\"M" + pixel(box_.left) + " " + pixel(y) + "H" + pixel(right) + "\" stroke=\"#e4e4e4\"/>\n";
      svg += draw_text({box_.left - 5.0, y + 4.0}, "end", y_.label(tick));
    }
    return svg;
  }

  [[nodiscard]] std::string draw_frame() const {
    const double right = chart_.equal_axes ? box_.left + std::min(box_.right - box_.left, box_.bottom - box_.top) : box_.right;
    const double middle_y = 0.5 * (box_.top + box_.bottom);
    std::string svg = draw_text({box_.left, box_.top - 10.0}, "start", chart_.title, " font-weight=\"bold\"");
    svg += draw_x_ticks() + draw_y_ticks(right);
    svg += "<path d=\"M" + pixel(box_.left) + " " + pixel(box_.top) + "V" + pixel(box_.bottom) + "H" + pixel(right) + "\" stroke=\"#888\" fill=\"none\"/>\n";
    svg += draw_text({0.5 * (box_.left + right), box_.bottom + 32.0}, "middle", chart_.x_label);
    const double label_x = left_ + 12.0;
    svg += draw_text({label_x, middle_y}, "middle", chart_.y_label, " transform=\"rotate(-90 " + pixel(label_x) + " " + pixel(middle_y) + ")\"");
    return svg;
  }

  [[nodiscard]] static std::string dashes_of(const Series& series) {
    return series.dashes.empty() ? "" : " stroke-dasharray=\"" + series.dashes + "\"";
  }

  [[nodiscard]] bool is_inside(Point at) const {
    return at.x >= box_.left - 1.0 && at.x <= box_.right + 1.0 && at.y >= box_.top - 1.0 &&
           at.y <= box_.bottom + 1.0;
  }

  [[nodiscard]] static std::string draw_dot(Point at, const std::string& colour) {
    return "<circle cx=\"" + pixel(at.x) + "\" cy=\"" + pixel(at.y) + "\" r=\"3\" fill=\"" + colour +
           "\"/>\n";
  }

  [[nodiscard]] static std::string draw_path(const std::string& path, const Series& series) {
    if (path.empty() || series.width <= 0.0) return "";
    return "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + series.colour + "\" stroke-width=\"" +
           format("%g", series.width) + "\"" + dashes_of(series) + "/>\n";
  }

  /// Points outside the axes are left out, and break the line.
  [[nodiscard]] std::string draw_series(const Series& series) const {
    std::string path, dots, last;  // last: the point before, empty where the line begins
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const Point at{x_.pixel_of(series.x[i]), y_.pixel_of(series.y[i])};
      if (!is_inside(at)) {
        last.clear();
        continue;
      }
      const std::string here = pixel(at.x) + " " + pixel(at.y);
      if (here == last) continue;
      path += (last.empty() ? "M" : "L") + here;
      if (series.markers) dots += draw_dot(at, series.colour);
      last = here;
    }
    return draw_path(path, series) + dots;
  }

  [[nodiscard]] std::string draw_entry_outside(const Series& series, double y) const {
    return "<path d=\"M" + pixel(box_.right + 8.0) + " " + pixel(y - 4.0) + "h14\" stroke=\"" +
           series.colour + "\" stroke-width=\"3\"" + dashes_of(series) + "/>\n" +
           draw_text({box_.right + 27.0, y}, "start", series.label);
  }

  [[nodiscard]] std::string draw_entry_inside(const Series& series, double y) const {
    // Width of the ground that keeps the label legible over lines.
    const double width = 7.0 * static_cast<double>(series.label.size()) + 22.0;
    const std::string ground = "<rect x=\"" + pixel(box_.right - width) + "\" y=\"" + pixel(y - 12.0) +
                               "\" width=\"" + pixel(width) +
                               "\" height=\"15\" fill=\"#fff\" fill-opacity=\"0.8\"/>\n";
    const std::string line = "<path d=\"M" + pixel(box_.right - 12.0) + " " + pixel(y - 4.0) +
                             "h12\" stroke=\"" + series.colour + "\" stroke-width=\"3\"/>\n";
    return ground + line + draw_text({box_.right - 17.0, y}, "end", series.label);
  }

  [[nodiscard]] std::string draw_legend() const {
    std::string svg;
    double y = box_.top + 12.0;
    for (const Series& series : chart_.series) {
      if (series.label.empty()) continue;
      svg += chart_.legend_outside ? draw_entry_outside(series, y) : draw_entry_inside(series, y);
      y += 15.0;
    }
    return svg;
  }

  const Chart& chart_;
  double left_;
  Box box_;
  PlotAxis x_, y_;
};

}  // namespace

std::string draw(const std::vector<Chart>& charts, int columns, int width, int height) {
  const int rows = (static_cast<int>(charts.size()) + columns - 1) / columns;
  std::string body;
  for (std::size_t k = 0; k < charts.size(); ++k) {
    const int row = static_cast<int>(k) / columns;
    const int column = static_cast<int>(k) % columns;
    body += ChartDrawing(charts[k], column * width, row * height, width, height).draw();
  }
  return wrap_svg(body, columns * width, rows * height);
}

}  // namespace charts
