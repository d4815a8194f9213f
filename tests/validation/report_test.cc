// SPDX-License-Identifier: Apache-2.0
// The report itself: what it writes, what it lets pass as the same, and its charts.

#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "charts/chart.h"
#include "validation/findings.h"
#include "validation/report.h"

namespace validation {
namespace {

Check some_check(double found) {
  return compare("frequency of |x|", "closed form", found, 81.4994, 1e-3, "Hz", "four digits were published");
}

std::vector<ComputedChapter> chapters_of(const Check& check) {
  Table table{.caption = "A table", .head = {"n", "error"}, .rows = {{"4", "0.25"}}};
  return {{{.title = "Waves", .text = "Two lines\nof text", .parts = {}},
           {{.checks = {check}, .tables = {table}, .figures = {}}}}};
}

std::vector<std::string> texts_of(const std::vector<ReportLine>& lines) {
  std::vector<std::string> texts;
  for (const ReportLine& line : lines) texts.push_back(line.text);
  return texts;
}

TEST(Check, HoldsUpToItsBoundAndNeverWithoutANumber) {
  EXPECT_TRUE(some_check(81.4998).holds());
  EXPECT_FALSE(some_check(81.5010).holds());
  EXPECT_FALSE(some_check(std::numeric_limits<double>::quiet_NaN()).holds());
  EXPECT_FALSE(limit("drift", "zero", std::numeric_limits<double>::quiet_NaN(), 1.0, "m", "").holds());
  EXPECT_FALSE(limit("drift", "zero", -2.0, 1.0, "m", "").holds());
}

TEST(Report, SaysHowManyComparisonsFail) {
  EXPECT_EQ(count_checks(chapters_of(some_check(81.4994))).failed, 0u);
  EXPECT_EQ(count_checks(chapters_of(some_check(90.0))).failed, 1u);
  std::string all;
  for (const ReportLine& line : write_report(chapters_of(some_check(90.0)), "figures"))
    all += line.text + "\n";
  EXPECT_NE(all.find("**FAILED**"), std::string::npos);
  EXPECT_NE(all.find("| frequency of \\|x\\| | closed form | 90 | 81.4994 |"), std::string::npos) << all;
}

TEST(Report, OfTheSameRunHasNoDifferences) {
  const auto lines = write_report(chapters_of(some_check(81.4998)), "figures");
  EXPECT_TRUE(find_differences(lines, texts_of(lines)).empty());
}

TEST(Report, AllowsANumberToMoveByItsBoundAndNoMore) {
  // Both hold their bound of 1e-3, one on each side.
  const auto lines = write_report(chapters_of(some_check(81.5003)), "figures");
  EXPECT_TRUE(
      find_differences(lines, texts_of(write_report(chapters_of(some_check(81.4995)), "figures"))).empty());
  EXPECT_EQ(
      find_differences(lines, texts_of(write_report(chapters_of(some_check(81.4985)), "figures"))).size(),
      1u);
}

TEST(Report, FindsALoosenedBoundAndAnotherNumberInTheWords) {
  const auto lines = write_report(chapters_of(some_check(81.4998)), "figures");
  Check loosened = some_check(81.4998);
  loosened.bound = 1e-2;
  EXPECT_FALSE(find_differences(lines, texts_of(write_report(chapters_of(loosened), "figures"))).empty());
  Check reworded = some_check(81.4998);
  reworded.why = "five digits, 1.0001, were published";
  const auto with_number = write_report(chapters_of(reworded), "figures");
  reworded.why = "five digits, 1.0002, were published";
  EXPECT_EQ(find_differences(with_number, texts_of(write_report(chapters_of(reworded), "figures"))).size(),
            1u);
}

TEST(Report, ComparesResidualsByAFactorAndNotAtAllBelowRounding) {
  const Tolerance residual{.factor = 10.0, .floor = 1e-6};
  EXPECT_TRUE(residual.allows(3e-4, 2e-3));
  EXPECT_FALSE(residual.allows(3e-4, 4e-3));
  EXPECT_FALSE(residual.allows(3e-4, -3e-4));
  EXPECT_TRUE(residual.allows(0.0, -3e-13));
  EXPECT_FALSE(residual.allows(10.307, 1030.7));
}

TEST(Report, FindsAnotherWordAnotherTableAndAMissingLine) {
  const auto lines = write_report(chapters_of(some_check(81.4998)), "figures");
  auto written = texts_of(lines);
  for (std::string& line : written)
    if (line == "of text") line = "of other text";
  EXPECT_EQ(find_differences(lines, written).size(), 1u);
  written = texts_of(lines);
  for (std::string& line : written)
    if (line == "| 4 | 0.25 |") line = "| 4 | 0.26 |";
  EXPECT_EQ(find_differences(lines, written).size(), 1u);
  written = texts_of(lines);
  written.pop_back();
  EXPECT_EQ(find_differences(lines, written).size(), 1u);
}

TEST(Report, KeepsWhatIsSaidOfPlantedFaults) {
  const auto lines = write_report(chapters_of(some_check(81.4998)), "figures");
  const std::vector<std::string> faults{"", "90 of 90 planted faults were found."};
  std::vector<std::string> written;
  std::istringstream text(to_text(lines, faults));
  for (std::string line; std::getline(text, line);) written.push_back(line);
  const WrittenReport report = take_faults(written);
  EXPECT_EQ(report.faults, faults);
  EXPECT_EQ(report.lines, texts_of(lines));
}

TEST(Chart, PutsPointsWhereTheAxesSay) {
  // A box from x = 62 to 386 and y = 28 to 260: 1 to 100 on a logarithmic axis, 0 to 10 on a linear one.
  const charts::Chart chart{.title = "a < b",
                            .x_label = "n",
                            .y_label = "error",
                            .x_scale = charts::Scale::kLog,
                            .x_min = 1.0,
                            .x_max = 100.0,
                            .y_min = 0.0,
                            .y_max = 10.0,
                            .series = {{.label = "one", .x = {1.0, 10.0, 100.0}, .y = {0.0, 5.0, 10.0}}}};
  const std::string svg = charts::draw({chart}, 1, 400, 300);
  EXPECT_NE(svg.find("M62.0 260.0L224.0 144.0L386.0 28.0"), std::string::npos) << svg;
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
}

TEST(Chart, BreaksALineWhereThereIsNoNumber) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const charts::Chart chart{.x_min = 0.0,
                            .x_max = 4.0,
                            .y_min = 0.0,
                            .y_max = 1.0,
                            .series = {{.x = {0.0, 1.0, 2.0, 3.0}, .y = {0.5, none, 0.5, 0.5}}}};
  const std::string svg = charts::draw({chart}, 1, 400, 300);
  EXPECT_NE(svg.find("M62.0 144.0M224.0 144.0L305.0 144.0"), std::string::npos) << svg;
}

/// A chart of values from `least` to `most`, and nothing asked of its axes.
std::string draw_between(double least, double most, charts::Scale scale = charts::Scale::kLinear) {
  return charts::draw({{.y_scale = scale, .series = {{.x = {0.0, 1.0, 2.0}, .y = {least, most, least}}}}}, 1,
                      400, 300);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
  return times;
}

TEST(Chart, HasFewTicksHoweverCloseAndHoweverFarItsValuesLie) {
  constexpr double kLeastNumber = std::numeric_limits<double>::denorm_min(),
                   kLargest = std::numeric_limits<double>::max();
  const std::size_t of_x = 5;  // 0, 0.5, 1, 1.5, 2
  for (const double value : {1.0, -3.7, 772.62, 1e5, 1e17, -1e200, 0.1 + 0.2, 1e-30}) {
    for (const double relative : {0.0, 2.3e-16, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0}) {
      const std::string svg = draw_between(value, value * (1.0 + relative));
      const std::size_t ticks = count(svg, "#e4e4e4") - of_x;
      EXPECT_TRUE(ticks >= 2 && ticks <= 11)
          << ticks << " ticks from " << value << " on over " << relative << " of it";
      EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0U) << svg;
    }
  }
  for (const charts::Scale scale : {charts::Scale::kLinear, charts::Scale::kLog}) {
    for (const auto& [least, most] : {std::pair{-kLargest, kLargest},
                                      {0.0, kLeastNumber},
                                      {kLeastNumber, 3.0 * kLeastNumber},
                                      {kLeastNumber, 1e306},
                                      {-9e299, 9e299}}) {
      const std::string svg = draw_between(least, most, scale);
      EXPECT_LE(count(svg, "#e4e4e4"), of_x + 11) << least << " to " << most;
      EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0U) << svg;
    }
  }
}

/// A chart of a line from 1e5 to 2e5, with limits asked for.
std::string draw_within(double y_min, double y_max, charts::Scale scale = charts::Scale::kLinear) {
  return charts::draw({{.y_scale = scale,
                        .y_min = y_min,
                        .y_max = y_max,
                        .series = {{.x = {0.0, 1.0, 2.0}, .y = {1e5, 2e5, 1e5}}}}},
                      1, 400, 300);
}

TEST(Chart, HasNoTicksBetweenLimitsThatNumbersCannotDivide) {
  EXPECT_EQ(count(draw_within(1e5, std::nextafter(1e5, 2e5)), "#e4e4e4"), 5U);  // those of x
}

TEST(Chart, TakesLimitsThatAnAxisCannotHaveFromTheData) {
  EXPECT_EQ(draw_within(0.0, 1e6, charts::Scale::kLog), draw_within(0.0, 0.0, charts::Scale::kLog));
  EXPECT_EQ(draw_within(-1.0, 1e6, charts::Scale::kLog), draw_within(0.0, 0.0, charts::Scale::kLog));
  EXPECT_EQ(draw_within(-1e308, 1e308), draw_within(0.0, 0.0));
  EXPECT_NE(draw_within(0.0, 1e6), draw_within(0.0, 0.0));
}

TEST(Chart, DrawsWhatDiffersByRoundingAsOne) {
  EXPECT_EQ(count(draw_between(772.62, 772.62 * (1.0 + 1e-10)), ">772.62<"), 0U);  // ticks are further apart
  EXPECT_EQ(count(draw_between(772.62, 772.62 * (1.0 + 1e-8)), ">772.62<"), 1U);
}

TEST(Chart, TellsTicksFromTheirNeighbours) {
  const std::string svg = draw_between(772.620, 772.621);
  EXPECT_NE(svg.find(">772.62<"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">772.6205<"), std::string::npos) << svg;
  const std::string finer = draw_between(1000.0, 1000.005);
  for (const char* label : {">1000<", ">1000.002<", ">1000.004<"})
    EXPECT_NE(finer.find(label), std::string::npos) << label << '\n' << finer;
}

TEST(Chart, HasRoomForLongLabels) {
  const std::string svg = draw_between(1000.0, 1000.005);
  EXPECT_NE(svg.find("<text x=\"59.0\" y=\"255.4\" text-anchor=\"end\">1000<"), std::string::npos)
      << svg;  // eight characters of 7 pixels, and 3
}

}  // namespace
}  // namespace validation
