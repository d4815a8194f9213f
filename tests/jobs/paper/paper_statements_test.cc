// SPDX-License-Identifier: Apache-2.0
// The paper's seven statements held against tables whose peaks are known.

#include "jobs/paper/paper_statements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using Case = std::tuple<double, double, std::string>;  // clearance [mm], velocity [rad/s], coupler
using StudyPeaks = std::map<Case, double>;

/// A study in which all seven hold: the growths are 8.5, 4, 3.5 and 1.25.
StudyPeaks holding_peaks() {
  return {{{0, 10, "rigid"}, 40},     {{0, 10, "flexible"}, 40},
          {{0, 15, "rigid"}, 90},     {{0, 15, "flexible"}, 90},
          {{0.25, 10, "rigid"}, 100}, {{0.25, 10, "flexible"}, 80},
          {{0.25, 15, "rigid"}, 850}, {{0.25, 15, "flexible"}, 320},
          {{0.5, 10, "rigid"}, 200},  {{0.5, 10, "flexible"}, 200},
          {{0.5, 15, "rigid"}, 700},  {{0.5, 15, "flexible"}, 250}};
}

/// One value of every parameter of this list, in its order.
using Setting = std::vector<std::pair<std::string, json>>;

void add_rows(const StudyPeaks& peaks, const Setting& setting, jobs::ResultTable& table) {
  for (const auto& [c, peak] : peaks) {
    std::vector<json> row{"job", std::get<0>(c), std::get<1>(c), std::get<2>(c)};
    for (const auto& [parameter, value] : setting) row.push_back(value);
    row.push_back(peak);
    table.rows.push_back(std::move(row));
  }
}

jobs::ResultTable heading_of(const Setting& setting) {
  jobs::ResultTable table;
  table.columns = {"job_id", "clearance_mm", "crank_velocity_rad_s", "coupler"};
  table.ended = true;
  for (const auto& [parameter, value] : setting) table.columns.push_back(parameter);
  table.columns.emplace_back("peak_slider_acceleration_m_s2");
  return table;
}

jobs::ResultTable paper_table_of(const StudyPeaks& peaks) {
  jobs::ResultTable table = heading_of({});
  add_rows(peaks, {}, table);
  return table;
}

json paper_cell(const jobs::ResultTable& table, std::size_t row, const std::string& column) {
  const auto found = std::ranges::find(table.columns, column);
  EXPECT_NE(found, table.columns.end()) << column;
  if (found == table.columns.end()) return nullptr;
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

TEST(PaperStatements, AllHoldWhereThePeaksAreThePapers) {
  const auto table = jobs::hold_against_paper(paper_table_of(holding_peaks()));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"statement", "number", "text", "paper", "found_least",
                                                     "found_largest", "settings", "share", "holds"}));
  EXPECT_TRUE(table.ended);
  ASSERT_EQ(table.rows.size(), 9U) << "seven, and the two orders at 10 rad/s";
  // The ratios by hand from the peaks above.
  const struct {
    const char* statement;
    json paper;
    double least, largest;
  } expected[] = {{"ideal_couplers", 1.0, 1, 1},
                  {"growth_rigid_0.25_mm", 8.5, 8.5, 8.5},
                  {"growth_flexible_0.25_mm", 4.0, 4, 4},
                  {"growth_rigid_0.5_mm", 3.5, 3.5, 3.5},
                  {"growth_flexible_0.5_mm", 1.25, 1.25, 1.25},
                  {"order_of_clearances_15_rad_s", nullptr, 250.0 / 320.0, 700.0 / 850.0},
                  {"order_of_couplers_15_rad_s", nullptr, 250.0 / 700.0, 320.0 / 850.0},
                  {"order_of_clearances_10_rad_s", nullptr, 2, 2.5},
                  {"order_of_couplers_10_rad_s", nullptr, 0.8, 1}};
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    EXPECT_EQ(paper_cell(table, k, "statement"), expected[k].statement);
    EXPECT_EQ(paper_cell(table, k, "number"), k < 7 ? json(k + 1) : json()) << k;
    EXPECT_EQ(paper_cell(table, k, "paper"), expected[k].paper) << k;
    EXPECT_DOUBLE_EQ(paper_cell(table, k, "found_least").get<double>(), expected[k].least) << k;
    EXPECT_DOUBLE_EQ(paper_cell(table, k, "found_largest").get<double>(), expected[k].largest) << k;
    EXPECT_EQ(paper_cell(table, k, "settings"), 1) << k;
    EXPECT_EQ(paper_cell(table, k, "share"), k < 7 ? 1.0 : 0.0) << k;
    EXPECT_EQ(paper_cell(table, k, "holds"), k < 7) << k;
    EXPECT_FALSE(paper_cell(table, k, "text").get<std::string>().empty()) << k;
  }
}

struct EdgeCase {
  const char* name;
  std::size_t number;
  Case changed;
  double peak;
  bool holds;
};
void PrintTo(const EdgeCase& edge, std::ostream* out) { *out << edge.name; }

class PaperStatementEdge : public testing::TestWithParam<EdgeCase> {};

TEST_P(PaperStatementEdge, IsWhereItCeasesToHold) {
  const EdgeCase& edge = GetParam();
  StudyPeaks peaks = holding_peaks();
  peaks.at(edge.changed) = edge.peak;
  const auto table = jobs::hold_against_paper(paper_table_of(peaks));
  EXPECT_EQ(paper_cell(table, edge.number - 1, "number"), edge.number);
  EXPECT_EQ(paper_cell(table, edge.number - 1, "holds"), edge.holds);
  EXPECT_EQ(paper_cell(table, edge.number - 1, "share"), edge.holds ? 1.0 : 0.0);
}

// Statement 1 holds within 5 %, a growth within 20 % of the paper's, an order below 0.999. Ratios are a
// thousandth or less inside and outside of these bounds.
const EdgeCase kEdges[] = {
    {"couplers_slightly_below", 1, {0, 10, "flexible"}, 40 * 0.951, true},
    {"couplers_too_far_below", 1, {0, 10, "flexible"}, 40 * 0.949, false},
    {"couplers_slightly_above", 1, {0, 15, "flexible"}, 90 * 1.049, true},
    {"couplers_too_far_above", 1, {0, 15, "flexible"}, 90 * 1.051, false},
    {"rigid_narrow_grows_little_less", 2, {0.25, 10, "rigid"}, 850 / (8.5 * 0.801), true},
    {"rigid_narrow_grows_too_little", 2, {0.25, 10, "rigid"}, 850 / (8.5 * 0.799), false},
    {"rigid_narrow_grows_little_more", 2, {0.25, 10, "rigid"}, 850 / (8.5 * 1.199), true},
    {"rigid_narrow_grows_too_much", 2, {0.25, 10, "rigid"}, 850 / (8.5 * 1.201), false},
    {"flexible_narrow_grows_little_less", 3, {0.25, 10, "flexible"}, 320 / (4 * 0.801), true},
    {"flexible_narrow_grows_too_little", 3, {0.25, 10, "flexible"}, 320 / (4 * 0.799), false},
    {"flexible_narrow_grows_little_more", 3, {0.25, 10, "flexible"}, 320 / (4 * 1.199), true},
    {"flexible_narrow_grows_too_much", 3, {0.25, 10, "flexible"}, 320 / (4 * 1.201), false},
    {"rigid_wide_grows_little_less", 4, {0.5, 10, "rigid"}, 700 / (3.5 * 0.801), true},
    {"rigid_wide_grows_too_little", 4, {0.5, 10, "rigid"}, 700 / (3.5 * 0.799), false},
    {"rigid_wide_grows_little_more", 4, {0.5, 10, "rigid"}, 700 / (3.5 * 1.199), true},
    {"rigid_wide_grows_too_much", 4, {0.5, 10, "rigid"}, 700 / (3.5 * 1.201), false},
    {"flexible_wide_grows_little_less", 5, {0.5, 10, "flexible"}, 250 / (1.25 * 0.801), true},
    {"flexible_wide_grows_too_little", 5, {0.5, 10, "flexible"}, 250 / (1.25 * 0.799), false},
    {"flexible_wide_grows_little_more", 5, {0.5, 10, "flexible"}, 250 / (1.25 * 1.199), true},
    {"flexible_wide_grows_too_much", 5, {0.5, 10, "flexible"}, 250 / (1.25 * 1.201), false},
    {"wide_a_little_smaller_rigid", 6, {0.5, 15, "rigid"}, 850 * 0.998, true},
    {"wide_nearly_as_large_rigid", 6, {0.5, 15, "rigid"}, 850 * 0.9995, false},
    {"wide_a_little_smaller_flexible", 6, {0.5, 15, "flexible"}, 320 * 0.998, true},
    {"wide_nearly_as_large_flexible", 6, {0.5, 15, "flexible"}, 320 * 0.9995, false},
    {"flexible_a_little_smaller_narrow", 7, {0.25, 15, "flexible"}, 850 * 0.998, true},
    {"flexible_nearly_as_large_narrow", 7, {0.25, 15, "flexible"}, 850 * 0.9995, false},
    {"flexible_a_little_smaller_wide", 7, {0.5, 15, "flexible"}, 700 * 0.998, true},
    {"flexible_nearly_as_large_wide", 7, {0.5, 15, "flexible"}, 700 * 0.9995, false},
};

INSTANTIATE_TEST_SUITE_P(All, PaperStatementEdge, testing::ValuesIn(kEdges),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(PaperStatements, AreHeldAgainstTheMediansOverReplicates) {
  jobs::ResultTable table = paper_table_of(holding_peaks());
  const auto add = [&](double velocity, const json& peak) {
    table.rows.push_back({"job", 0.25, velocity, "rigid", peak});
  };
  for (const double peak : {1.0, 1e6}) add(15, peak);  // 850 is the median of three
  add(10, 300);                                        // the mean of the middle two, 200
  add(10, nullptr);                                    // a job without a peak
  const auto found = jobs::hold_against_paper(table);
  EXPECT_EQ(paper_cell(found, 1, "found_least"), 850.0 / 200.0);
  EXPECT_EQ(paper_cell(found, 1, "settings"), 1);
  EXPECT_EQ(paper_cell(found, 5, "holds"), true);
}

TEST(PaperStatements, SpeakOfSpeedWhicheverWayTheCrankTurns) {
  jobs::ResultTable table = paper_table_of(holding_peaks());
  for (auto& row : table.rows) row[2] = -row[2].get<double>();
  const auto found = jobs::hold_against_paper(table);
  ASSERT_EQ(found.rows.size(), 9U);
  EXPECT_EQ(paper_cell(found, 1, "found_least"), 8.5);
}

TEST(PaperStatements, AreOpenWhereACaseIsMissing) {
  const auto open_without = [](const Case& missing) {
    StudyPeaks peaks = holding_peaks();
    peaks.erase(missing);
    const auto table = jobs::hold_against_paper(paper_table_of(peaks));
    std::vector<int> open;
    for (std::size_t k = 0; k < 7; ++k) {
      const bool is_open = paper_cell(table, k, "settings") == 0;
      for (const char* column : {"found_least", "found_largest", "share", "holds"})
        EXPECT_EQ(paper_cell(table, k, column).is_null(), is_open) << k << column;
      if (is_open) open.push_back(static_cast<int>(k) + 1);
    }
    return open;
  };
  EXPECT_EQ(open_without({0.25, 15, "flexible"}), (std::vector<int>{3, 6, 7}));
  EXPECT_EQ(open_without({0.25, 10, "rigid"}), std::vector<int>{2});
  EXPECT_EQ(open_without({0.5, 15, "rigid"}), (std::vector<int>{4, 6, 7}));
  EXPECT_EQ(open_without({0, 15, "flexible"}), std::vector<int>{1}) << "of one velocity alone";
  EXPECT_TRUE(open_without({0.5, 20, "rigid"}).empty()) << "was never there";
}

TEST(PaperStatements, AreOpenWithoutAnyPeak) {
  jobs::ResultTable table = paper_table_of(holding_peaks());
  for (auto& row : table.rows) row.back() = nullptr;
  const auto found = jobs::hold_against_paper(table);
  ASSERT_EQ(found.rows.size(), 7U);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_TRUE(paper_cell(found, k, "holds").is_null()) << k;
}

// Peaks at 10 rad/s divided by 1, 1.1, 1.5 and 2: the growths of the rigid coupler with 0.25 mm are 8.5,
// 9.35, 12.75 and 17.
TEST(PaperStatements, HoldInAShareOfTheSettings) {
  jobs::ResultTable table = heading_of({{"restitution", 0}});
  double restitution = 0.6;
  for (const double factor : {1.0, 1.1, 1.5, 2.0}) {
    StudyPeaks peaks = holding_peaks();
    peaks.at({0.25, 10, "rigid"}) /= factor;
    if (factor == 2.0) peaks.erase({0.5, 10, "rigid"});  // statement 4 is open there
    add_rows(peaks, {{"restitution", restitution += 0.05}}, table);
  }
  const auto found = jobs::hold_against_paper(table);
  EXPECT_EQ(paper_cell(found, 1, "settings"), 4);
  EXPECT_EQ(paper_cell(found, 1, "share"), 0.5);
  EXPECT_EQ(paper_cell(found, 1, "holds"), false);
  const double median = 0.5 * (9.35 + 12.75);
  for (const char* column : {"found_least", "found_largest"})
    EXPECT_NEAR(paper_cell(found, 1, column).get<double>(), median, 1e-12);
  EXPECT_EQ(paper_cell(found, 2, "share"), 1.0);
  EXPECT_EQ(paper_cell(found, 2, "holds"), true);
  EXPECT_EQ(paper_cell(found, 3, "settings"), 3);
  EXPECT_EQ(paper_cell(found, 3, "share"), 1.0);
  for (const std::string& column : found.columns) EXPECT_FALSE(column.starts_with("index.")) << column;
}

/// Settings over two parameters of 8 levels each. The logarithm of statement 2's growth is log(8.5) - 0.3 i +
/// 0.1 j with their levels i and j.
jobs::ResultTable table_of_settings(std::size_t count) {
  jobs::ResultTable table = heading_of({{"restitution", 0}, {"friction", 0}});
  for (std::size_t s = 0; s < count; ++s) {
    const auto i = static_cast<double>(s / 8), j = static_cast<double>(s % 8);
    StudyPeaks peaks = holding_peaks();
    peaks.at({0.25, 10, "rigid"}) *= std::exp(0.3 * i - 0.1 * j);
    if (s == 0) peaks.erase({0.5, 10, "rigid"});
    add_rows(peaks, {{"restitution", 0.1 * (i + 1.0)}, {"friction", "law " + std::to_string(s % 8)}}, table);
  }
  return table;
}

// All combinations: the variances of both parts add up, 9 to 1. Of 64 points in 8 classes, chance puts 7/56
// of the sum of squares within the classes between them.
TEST(PaperStatements, HaveIndicesFromFiftySettingsOn) {
  const auto found = jobs::hold_against_paper(table_of_settings(64));
  EXPECT_NEAR(paper_cell(found, 1, "index.restitution").get<double>(), 0.9 - 0.1 * 7.0 / 56.0, 1e-12);
  EXPECT_EQ(paper_cell(found, 1, "index.friction"), 0.0) << "0.1 is less than 0.9 7/56";
  EXPECT_TRUE(paper_cell(found, 2, "index.restitution").is_null()) << "a ratio that is always the same";
  for (std::size_t k = 7; k < 9; ++k)
    EXPECT_TRUE(paper_cell(found, k, "index.restitution").is_null()) << "no number";
  for (const std::string& column : found.columns)
    EXPECT_EQ(column.find("index.clearance_mm"), std::string::npos);

  const auto fifty = jobs::hold_against_paper(table_of_settings(50));
  EXPECT_TRUE(paper_cell(fifty, 1, "index.restitution").is_number());
  EXPECT_TRUE(paper_cell(fifty, 3, "index.restitution").is_null()) << "only 49 settings have its peaks";
  const auto fewer = jobs::hold_against_paper(table_of_settings(49));
  for (const std::string& column : fewer.columns) EXPECT_FALSE(column.starts_with("index.")) << column;
}

TEST(PaperStatements, NeedTheirThreeAxes) {
  for (std::size_t axis = 1; axis <= 3; ++axis) {
    jobs::ResultTable table = paper_table_of(holding_peaks());
    const std::string name = table.columns[axis];
    table.columns[axis] = "restitution";
    try {
      (void)jobs::hold_against_paper(table);
      ADD_FAILURE() << "without " << name;
    } catch (const jobs::WrongState& unfit) {
      EXPECT_NE(std::string(unfit.what()).find("does not vary " + name), std::string::npos) << unfit.what();
    }
  }
}

}  // namespace
}  // namespace jobs_tests
