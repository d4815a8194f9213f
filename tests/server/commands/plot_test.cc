// SPDX-License-Identifier: Apache-2.0
#include "server/commands/plot.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

using namespace server::commands;

/// n samples a millisecond apart, all 0 but one.
engine::Trajectory spike(std::size_t n, std::size_t at, double height) {
  engine::Trajectory trajectory;
  for (const char* const key : {"t_s", "slider_acceleration_min_m_s2", "slider_acceleration_max_m_s2"}) {
    trajectory.channels.push_back({});
    trajectory.channels.back().key = key;
    trajectory.columns.emplace_back(n, 0.0);
  }
  for (std::size_t i = 0; i < n; ++i) trajectory.columns[0][i] = 1e-3 * static_cast<double>(i);
  if (at < n) (height > 0 ? trajectory.columns[2] : trajectory.columns[1])[at] = height;
  return trajectory;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(AccelerationBand, KeepsASpikeWhereverItIs) {
  for (const std::size_t at : {0U, 1U, 499U, 998U, 999U}) {
    const auto band = calc_acceleration_band(spike(1000, at, 70.0), 37);
    ASSERT_EQ(band.most.size(), 37U);
    EXPECT_EQ(std::ranges::max(band.most), 70.0) << at;
    EXPECT_EQ(std::ranges::count(band.most, 70.0), 1) << at;
    EXPECT_EQ(std::ranges::min(calc_acceleration_band(spike(1000, at, -70.0), 37).least), -70.0) << at;
  }
}

TEST(AccelerationBand, HasNoMoreColumnsThanSamples) {
  EXPECT_EQ(calc_acceleration_band(spike(3, 1, 1.0), 100).most.size(), 3U);
  EXPECT_TRUE(calc_acceleration_band(spike(0, 0, 0.0), 100).most.empty());
}

TEST(TerminalPlot, ShowsTheSpikeInItsPlace) {
  const TerminalSize size{.columns = 60, .rows = 20};
  // The spike of 70 in the middle of an axis that ends at 80 is a column from there down to zero, the lowest
  // line.
  const auto lines = lines_of(draw_for_terminal(
      calc_acceleration_band(spike(1000, 500, 70.0), plot_columns(size)), size, Characters::kAscii));
  ASSERT_EQ(lines.size(), 17U);
  EXPECT_EQ(lines[0], "slider acceleration, m/s^2");
  EXPECT_TRUE(lines[1].starts_with("      80 |")) << lines[1];
  EXPECT_TRUE(lines[15].starts_with("       0 |")) << lines[15];
  EXPECT_EQ(lines[16].substr(lines[16].size() - 7), "0.999 s");
  for (const std::string& line : lines) EXPECT_LE(line.size(), 60U) << line;
  const std::size_t place = lines[8].find('|', 10);
  ASSERT_NE(place, std::string::npos) << lines[8];
  EXPECT_NEAR(static_cast<double>(place - 10), 0.5 * 49, 1.0);
  EXPECT_EQ(lines[8].find_first_not_of(" |"), std::string::npos) << lines[8];
}

TEST(TerminalPlot, DrawsBrailleOfUnicode) {
  const TerminalSize size{.columns = 60, .rows = 20};
  const std::string text = draw_for_terminal(calc_acceleration_band(spike(2000, 0, 0.0), plot_columns(size)),
                                             size, Characters::kBraille);
  // A line that lies at zero, between -1 and 1: two dots of each of 49 characters, all in the same height.
  std::size_t count = 0;
  for (std::size_t at = text.find("\u2809"); at != std::string::npos; at = text.find("\u2809", at + 1))
    ++count;
  for (const char* const two : {"\u2812", "\u2824", "\u28c0"}) {
    for (std::size_t at = text.find(two); at != std::string::npos; at = text.find(two, at + 1)) ++count;
  }
  EXPECT_EQ(count, 49U) << text;
}

TEST(TerminalPlot, SaysThatThereIsNothing) {
  EXPECT_EQ(draw_for_terminal({}, {}, Characters::kAscii), "the run has no samples to draw\n");
}

TEST(SvgPlot, HasAStrokeForEachColumn) {
  const std::string svg = draw_svg(calc_acceleration_band(spike(2000, 1000, 70.0), kSvgColumns));
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_EQ(std::ranges::count(svg, 'V'), static_cast<std::ptrdiff_t>(kSvgColumns));
  // 70 of an axis from 0 to 80: 30 + 320 / 8 = 70, with half a pixel more at its ends.
  EXPECT_NE(svg.find("M470.5 69.5V350.5"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">80</text>"), std::string::npos);
  EXPECT_NE(svg.find("m/s\u00b2"), std::string::npos);
}

}  // namespace
