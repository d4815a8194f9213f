// SPDX-License-Identifier: Apache-2.0
// Report and rows: their text, the differences they let pass, and charts.

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "charts/chart.h"
#include "validation/findings.h"
#include "validation/report/report.h"
#include "validation/report/report_line.h"
#include "validation/report/rows.h"

namespace validation {
namespace {

Check some_check(double found) {
  return compare("frequency of |x|, \"slow\"", "closed form", found, 81.4994, 1e-3, "Hz",
                 "four digits were published");
}

std::vector<ComputedChapter> chapters_of(const std::vector<Check>& checks, Place place = Place::kBeside) {
  const Table table{.caption = "A table",
                    .head = {"n", "error [m]"},
                    .rows = {{"4", "0.25"}, {"8", "0.06"}},
                    .place = place};
  const Figure figure{.file = "waves.svg", .caption = "Three waves", .svg = "", .place = place};
  const Part part{.name = "long_waves", .compute = nullptr};
  return {{{.name = "waves", .title = "Waves", .text = "Two lines\nof text", .parts = {part}},
           {{.checks = checks, .tables = {table}, .figures = {figure}}}}};
}

std::vector<std::string> texts_of(const std::vector<ReportLine>& lines) {
  std::vector<std::string> texts;
  for (const ReportLine& line : lines) texts.push_back(line.text);
  return texts;
}

std::string report_of(const std::vector<ComputedChapter>& chapters) {
  return to_text(write_report(chapters, "figures"));
}

/// Differences between the rows of two runs.
std::vector<std::string> differences_of_rows(const Check& fresh, const Check& written) {
  const auto rows = write_rows(chapters_of({written}));
  return find_differences(write_rows(chapters_of({fresh})), texts_of(rows), split_csv);
}

TEST(Check, HoldsUpToItsBoundAndNeverWithoutANumber) {
  EXPECT_TRUE(some_check(81.4998).holds());
  EXPECT_FALSE(some_check(81.5010).holds());
  EXPECT_FALSE(some_check(std::numeric_limits<double>::quiet_NaN()).holds());
  EXPECT_FALSE(limit("drift", "zero", std::numeric_limits<double>::quiet_NaN(), 1.0, "m", "").holds());
  EXPECT_FALSE(limit("drift", "zero", -2.0, 1.0, "m", "").holds());
}

TEST(Report, CountsComparisonsAndNamesThoseThatFail) {
  EXPECT_EQ(count_checks(chapters_of({some_check(81.4994)})).failed, 0u);
  EXPECT_EQ(count_checks(chapters_of({some_check(90.0)})).failed, 1u);
  const std::string good = report_of(chapters_of({some_check(81.4994)}));
  EXPECT_NE(good.find("1 comparisons, all within their bounds."), std::string::npos) << good;
  EXPECT_EQ(good.find("FAILED"), std::string::npos) << good;
  const std::string bad = report_of(chapters_of({some_check(90.0)}));
  EXPECT_NE(bad.find("1 comparisons, 1 **outside their bounds**."), std::string::npos) << bad;
  EXPECT_NE(bad.find("- FAILED  frequency of |x|"), std::string::npos) << bad;
}

TEST(Report, HasARowForEachChapterWithItsWorstComparison) {
  const Check none = limit("a drift", "zero", 0.0, 0.0, "m", "no drift");
  const Check worse = limit("another drift", "zero", 3.0, 4.0, "m", "some drift");
  const std::string report = report_of(chapters_of({none, worse, some_check(81.4995)}));
  const char* row = "| 1 | Waves | `waves` | 3 | 0 | 0.75 | another drift |\n";
  EXPECT_NE(report.find(row), std::string::npos) << report;
  const Check unknown = limit("no number", "zero", std::numeric_limits<double>::quiet_NaN(), 1.0, "m", "");
  const std::string failed = report_of(chapters_of({worse, unknown, some_check(81.4995)}));
  EXPECT_NE(failed.find("| 1 | Waves | `waves` | 3 | 1 | inf | no number |\n"), std::string::npos) << failed;
}

TEST(Report, LetsTheWorstComparisonBeAnotherButNotItsShare) {
  const auto lines_with = [](const char* what, double difference) {
    return write_report(chapters_of({limit(what, "zero", difference, 1.0, "m", "")}), "figures");
  };
  const auto fresh = lines_with("a drift", 0.5);
  EXPECT_TRUE(find_differences(fresh, texts_of(lines_with("another drift", 0.51)), split_markdown).empty());
  EXPECT_EQ(find_differences(fresh, texts_of(lines_with("a drift", 0.01)), split_markdown).size(), 1u);
}

TEST(Report, ShowsOnlyTablesAndFiguresThatBelongThere) {
  const std::string beside = report_of(chapters_of({}));
  EXPECT_EQ(beside.find("A table"), std::string::npos) << beside;
  EXPECT_NE(beside.find("- [Three waves](figures/waves.svg)\n"), std::string::npos) << beside;
  const std::string inside = report_of(chapters_of({}, Place::kInReport));
  const char* table = "A table\n\n| n | error [m] |\n|---|---|\n| 4 | 0.25 |\n";
  EXPECT_NE(inside.find(table), std::string::npos) << inside;
  EXPECT_NE(inside.find("![waves.svg](figures/waves.svg)\n\n*Three waves*\n"), std::string::npos) << inside;
}

TEST(Report, FindsAnotherWordAnotherTableAndAMissingLine) {
  const auto lines = write_report(chapters_of({some_check(81.4998)}, Place::kInReport), "figures");
  EXPECT_TRUE(find_differences(lines, texts_of(lines), split_markdown).empty());
  auto written = texts_of(lines);
  for (std::string& line : written)
    if (line == "of text") line = "of other text";
  EXPECT_EQ(find_differences(lines, written, split_markdown).size(), 1u);
  written = texts_of(lines);
  for (std::string& line : written)
    if (line == "| 4 | 0.25 |") line = "| 4 | 0.26 |";
  EXPECT_EQ(find_differences(lines, written, split_markdown).size(), 1u);
  written = texts_of(lines);
  written.pop_back();
  EXPECT_EQ(find_differences(lines, written, split_markdown).size(), 1u);
}

TEST(Rows, HoldEveryComparisonAndEveryNumberOfATable) {
  EXPECT_EQ(to_text(write_rows(chapters_of({some_check(90.0)}))),
            "chapter,section,case,quantity,unit,ours,reference,source,difference,bound,holds,note\n"
            "waves,long_waves,,\"frequency of |x|, \"\"slow\"\"\",Hz,90,81.4994,closed form,8.5,0.001,no,"
            "four digits were published\n"
            "waves,long_waves,n 4,error,m,0.25,,,,,,A table\n"
            "waves,long_waves,n 8,error,m,0.06,,,,,,\n");
}

TEST(Rows, AreSplitIntoTheirFields) {
  EXPECT_EQ(split_csv("a,,\"b, \"\"c\"\"\",d"), (std::vector<std::string>{"a", "", "b, \"c\"", "d"}));
  EXPECT_EQ(split_csv("\"\"\"\","), (std::vector<std::string>{"\"", ""}));
}

TEST(Rows, AllowANumberToMoveByItsBoundAndNoMore) {
  // Both hold their bound of 1e-3, one on each side.
  EXPECT_TRUE(differences_of_rows(some_check(81.5003), some_check(81.5003)).empty());
  EXPECT_TRUE(differences_of_rows(some_check(81.5003), some_check(81.4995)).empty());
  EXPECT_EQ(differences_of_rows(some_check(81.5003), some_check(81.4985)).size(), 1u);
}

TEST(Rows, ShowALoosenedBoundAndAnotherNumberInTheWords) {
  Check loosened = some_check(81.4998);
  loosened.bound = 1e-2;
  EXPECT_EQ(differences_of_rows(some_check(81.4998), loosened).size(), 1u);
  Check first = some_check(81.4998);
  first.why = "five digits, 1.0001, were published";
  Check second = first;
  second.why = "five digits, 1.0002, were published";
  EXPECT_EQ(differences_of_rows(first, second).size(), 1u);
}

TEST(Rows, ShowAnotherNumberOfATable) {
  const auto rows = write_rows(chapters_of({}));
  auto written = texts_of(rows);
  written.back() = "waves,long_waves,n 8,error,m,0.07,,,,,,";
  EXPECT_EQ(find_differences(rows, written, split_csv).size(), 1u);
}

TEST(Report, ComparesResidualsByAFactorAndNotAtAllBelowRounding) {
  const Tolerance residual{.factor = 10.0, .floor = 1e-6};
  EXPECT_TRUE(residual.allows(3e-4, 2e-3));
  EXPECT_FALSE(residual.allows(3e-4, 4e-3));
  EXPECT_FALSE(residual.allows(3e-4, -3e-4));
  EXPECT_TRUE(residual.allows(0.0, -3e-13));
  EXPECT_FALSE(residual.allows(10.307, 1030.7));
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
