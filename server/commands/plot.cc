// SPDX-License-Identifier: Apache-2.0
#include "server/commands/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace server::commands {

namespace {

constexpr std::size_t kMargin = 10;          // characters for the numbers at the left
constexpr std::size_t kDotsAcross = 2, kDotsDown = 4;  // of one character

/// Index of the first channel of a wanted name; empty if there is none.
std::optional<std::size_t> find_channel(const engine::Trajectory& trajectory,
                                        const std::function<bool(std::string_view)>& is_wanted) {
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    if (is_wanted(trajectory.channels[c].key)) return c;
  }
  return std::nullopt;
}

/// Drawn band: the two columns between which it lies, and its title.
struct Drawn {
  const std::vector<double>& least;
  const std::vector<double>& most;
  std::string title;
};

/// The first acceleration that a described linkage has.
Drawn find_acceleration(const engine::Trajectory& trajectory) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kUnits{
      {{"_m_s2", "m/s^2"}, {"_rad_s2", "rad/s^2"}}};
  for (const auto& [suffix, unit] : kUnits) {
    const auto found = find_channel(trajectory, [&](std::string_view key) { return key.ends_with(suffix); });
    if (!found) continue;
    const std::string& key = trajectory.channels[*found].key;
    const auto& values = trajectory.columns.at(*found);
    return {values, values,
            "acceleration of " + key.substr(0, key.size() - suffix.size()) + ", " + std::string(unit)};
  }
  throw std::logic_error("the trajectory has no acceleration");
}

Drawn choose_drawn(const engine::Trajectory& trajectory) {
  const auto named = [&](std::string_view name) {
    return find_channel(trajectory, [&](std::string_view key) { return key == name; });
  };
  const auto least = named("slider_acceleration_min_m_s2");
  const auto most = named("slider_acceleration_max_m_s2");
  if (least && most)
    return {trajectory.columns.at(*least), trajectory.columns.at(*most), AccelerationBand{}.title};
  return find_acceleration(trajectory);
}

/// Axis of the values. Its ends are multiples of a round step around the values and zero.
struct Axis {
  double bottom = -1.0, top = 1.0, step = 1.0;
};

/// 1, 2 or 5 times a power of ten, at least a fifth of the span.
double round_step(double span) {
  const double raw = span / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10.0 * power;
}

Axis make_axis(const AccelerationBand& band) {
  if (band.least.empty()) return {};
  const double least = std::min(0.0, std::ranges::min(band.least));
  const double most = std::max(0.0, std::ranges::max(band.most));
  if (!(most > least)) return {};
  const double step = round_step(most - least);
  return {.bottom = step * std::floor(least / step), .top = step * std::ceil(most / step), .step = step};
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value == 0.0 ? 0.0 : value);  // no "-0"
  return text;
}

/// Dots behind a grid of characters.
class Canvas {
 public:
  Canvas(std::size_t columns, std::size_t rows) : columns_(columns), rows_(rows), cells_(columns * rows, 0) {}

  [[nodiscard]] std::size_t dots_across() const { return kDotsAcross * columns_; }
  [[nodiscard]] std::size_t dots_down() const { return kDotsDown * rows_; }

  void set(std::size_t x, std::size_t y) {
    // The order in which Unicode numbers the dots of a Braille character.
    static constexpr std::array<std::array<unsigned, kDotsAcross>, kDotsDown> kBits{
        {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}}};
    cells_.at(y / kDotsDown * columns_ + x / kDotsAcross) |= kBits[y % kDotsDown][x % kDotsAcross];
  }

  [[nodiscard]] std::string row(std::size_t y, Characters characters) const {
    std::string text;
    for (std::size_t x = 0; x < columns_; ++x) {
      const unsigned dots = cells_[y * columns_ + x];
      if (dots == 0) text += ' ';
      else if (characters == Characters::kAscii) text += ascii(dots);
      else
        text += {static_cast<char>(0xE2), static_cast<char>(0xA0 | dots >> 6),
                 static_cast<char>(0x80 | (dots & 0x3F))};
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  }

 private:
  static char ascii(unsigned dots) {
    constexpr unsigned kUpper = 0x1B;
    if ((dots & kUpper) == 0) return '.';
    return (dots & ~kUpper) == 0 ? '\'' : '|';
  }

  std::size_t columns_, rows_;
  std::vector<unsigned> cells_;  ///< the dots of each character
};

void draw(const AccelerationBand& band, const Axis& axis, Canvas& canvas) {
  const auto dot_of = [&](double value) {
    const double down =
        (axis.top - value) / (axis.top - axis.bottom) * static_cast<double>(canvas.dots_down());
    return std::min(static_cast<std::size_t>(std::max(down, 0.0)), canvas.dots_down() - 1);
  };
  for (std::size_t x = 0; x < canvas.dots_across(); ++x) {
    const std::size_t i = x * band.least.size() / canvas.dots_across();
    for (std::size_t y = dot_of(band.most[i]); y <= dot_of(band.least[i]); ++y) canvas.set(x, y);
  }
}

std::size_t plot_rows(const TerminalSize& size) { return std::clamp<std::size_t>(size.rows, 10, 40) - 5; }

std::string right_aligned(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

/// Number at the left of a row of characters: both ends of the axis and zero have one.
std::string make_row_label(const Axis& axis, std::size_t row, std::size_t rows) {
  const double per_row = (axis.top - axis.bottom) / static_cast<double>(rows);
  const auto zero_row = std::min(static_cast<std::size_t>(axis.top / per_row), rows - 1);
  if (row == 0) return number(axis.top);
  if (row == rows - 1) return number(axis.bottom);
  return row == zero_row ? "0" : "";
}

/// Begin and end of the run, below both ends of the rows.
/// @param width  of a row without its label, in characters
std::string make_time_line(const AccelerationBand& band, std::size_t width) {
  const std::string begin = number(band.t_begin);
  const std::string end = number(band.t_end) + " s";
  return std::string(kMargin, ' ') + begin + right_aligned(end, width - begin.size()) + "\n";
}

// The field of the curve in an SVG, in pixels.
constexpr double kSvgLeft = 70, kSvgTop = 30, kSvgHeight = 320, kSvgWidth = kSvgColumns;

double svg_y(const Axis& axis, double value) {
  return kSvgTop + kSvgHeight * (axis.top - value) / (axis.top - axis.bottom);
}

std::string svg_label(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" + text +
         "</text>\n";
}

std::string draw_value_axis(const Axis& axis) {
  std::string svg;
  for (int i = 0; axis.bottom + i * axis.step <= axis.top + 0.5 * axis.step; ++i) {
    const double y = svg_y(axis, axis.bottom + i * axis.step);
    svg += "<path d=\"M70 " + number(y) + "H870\" stroke=\"#ddd\"/>\n" +
           svg_label(62, y + 4, "end", number(axis.bottom + i * axis.step));
  }
  return svg;
}

std::string draw_curve(const AccelerationBand& band, const Axis& axis) {
  std::string path;
  for (std::size_t i = 0; i < band.least.size(); ++i) {
    const double x =
        kSvgLeft + kSvgWidth * (static_cast<double>(i) + 0.5) / static_cast<double>(band.least.size());
    // Half a pixel more at both ends: a line that lies still would else be none.
    path += "M" + number(x) + " " + number(svg_y(axis, band.most[i]) - 0.5) + "V" +
            number(svg_y(axis, band.least[i]) + 0.5);
  }
  const double stroke = band.least.empty() ? 1.0 : kSvgWidth / static_cast<double>(band.least.size());
  return "<path d=\"" + path + "\" stroke=\"#d95f02\" stroke-width=\"" + number(stroke) +
         "\" fill=\"none\"/>\n";
}

std::string draw_time_axis(const AccelerationBand& band) {
  std::string svg;
  for (int i = 0; i <= 4; ++i) {
    const double part = 0.25 * i;
    svg += svg_label(kSvgLeft + part * kSvgWidth, 368, "middle",
                     number(band.t_begin + part * (band.t_end - band.t_begin)));
  }
  return svg + svg_label(kSvgLeft + 0.5 * kSvgWidth, 390, "middle", "time, s");
}

}  // namespace

AccelerationBand calc_acceleration_band(const engine::Trajectory& trajectory, std::size_t columns) {
  const auto& t = trajectory.columns.at(0);
  if (t.empty()) return {};
  const auto& [least, most, title] = choose_drawn(trajectory);
  const std::size_t n = std::min(columns, t.size());
  AccelerationBand band{.title = title, .t_begin = t.front(), .t_end = t.back(), .least = {}, .most = {}};
  for (std::size_t i = 0; i < n; ++i) {
    const auto from = static_cast<std::ptrdiff_t>(i * t.size() / n);
    const auto to = static_cast<std::ptrdiff_t>((i + 1) * t.size() / n);
    band.least.push_back(*std::min_element(least.begin() + from, least.begin() + to));
    band.most.push_back(*std::max_element(most.begin() + from, most.begin() + to));
  }
  return band;
}

std::size_t plot_columns(const TerminalSize& size) {
  return kDotsAcross * (std::clamp<std::size_t>(size.columns, 40, 200) - kMargin - 1);
}

std::string draw_for_terminal(const AccelerationBand& band, const TerminalSize& size, Characters characters) {
  if (band.least.empty()) return "the run has no samples to draw\n";
  const Axis axis = make_axis(band);
  Canvas canvas(plot_columns(size) / kDotsAcross, plot_rows(size));
  draw(band, axis, canvas);
  const std::size_t rows = plot_rows(size);
  std::string text = band.title + "\n";
  for (std::size_t y = 0; y < rows; ++y) {
    const std::string label = right_aligned(make_row_label(axis, y, rows), kMargin - 2);
    text += label + " |" + canvas.row(y, characters) + "\n";
  }
  return text + make_time_line(band, plot_columns(size) / kDotsAcross);
}

std::string draw_svg(const AccelerationBand& band) {
  const Axis axis = make_axis(band);
  std::string title = band.title;
  if (title.ends_with("^2")) title.replace(title.size() - 2, 2, "\u00b2");
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 400\" font-family=\"sans-serif\" "
         "font-size=\"13\" fill=\"#222\">\n"
         "<rect width=\"900\" height=\"400\" fill=\"#fff\"/>\n" +
         draw_value_axis(axis) + draw_curve(band, axis) + draw_time_axis(band) +
         svg_label(kSvgLeft, 18, "start", title) + "</svg>\n";
}

}  // namespace server::commands
