// SPDX-License-Identifier: Apache-2.0
#include "jobs/flexibility/flexibility.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

constexpr const char* kPeak = "peak_slider_acceleration_m_s2";

/// A table of a sweep over coupler and crank velocity: peaks and losses as they are given.
struct Row {
  std::string coupler;
  double speed;
  json peak;
  json structural_loss;
};

jobs::ResultTable table_of(const std::vector<Row>& rows) {
  jobs::ResultTable table{.columns = {"job_id", "coupler", "crank_velocity_rad_s", kPeak, "friction_work_j",
                                      "impact_loss_j", "structural_loss_j"},
                          .rows = {}};
  for (const Row& row : rows)
    table.rows.push_back({"job", row.coupler, row.speed, row.peak, 1.0, 2.0, row.structural_loss});
  return table;
}

const json kSweep{{"axes", {"coupler", "crank_velocity_rad_s"}}};

json cell(const jobs::ResultTable& table, std::size_t row, const std::string& column) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), column);
  EXPECT_NE(found, table.columns.end()) << column;
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

TEST(CompareLinks, PairsRigidAndFlexibleJobsWithTheirSpread) {
  const auto table = compare_links(kSweep,
                                      table_of({{"rigid", 5, 100, 0},
                                                {"rigid", 5, 100, 0},
                                                {"flexible", 5, 60, 1},
                                                {"flexible", 5, 80, 3},
                                                {"rigid", 10, 100, 0},
                                                {"rigid", 10, 110, 0},
                                                {"flexible", 10, 90, 1},
                                                {"flexible", 10, 150, 1},
                                                {"rigid", 12, 100, 0},
                                                {"rigid", 12, nullptr, 0},
                                                {"flexible", 12, 130, 1},
                                                {"flexible", 12, 140, 1}}),
                                      kPeak);
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(cell(table, 0, "ratio"), 0.7);
  EXPECT_EQ(cell(table, 0, "ratio_least"), 0.6);
  EXPECT_EQ(cell(table, 0, "ratio_largest"), 0.8);
  EXPECT_EQ(cell(table, 0, "verdict"), "helps");
  EXPECT_EQ(cell(table, 0, "coupler_loss_j"), 2.0);
  EXPECT_EQ(cell(table, 0, "coupler_loss_part"), 0.4) << "2 of 1 + 2 + 2";
  EXPECT_TRUE(cell(table, 0, "reverses_from").is_null());
  EXPECT_EQ(cell(table, 1, "ratio"), 120.0 / 105.0);
  EXPECT_EQ(cell(table, 1, "verdict"), "either");
  EXPECT_TRUE(cell(table, 1, "reverses_from").is_null()) << "within the scatter";
  EXPECT_EQ(cell(table, 2, "verdict"), "one_run_each");
  EXPECT_EQ(cell(table, 2, "rigid_count"), 1);
  EXPECT_EQ(cell(table, 2, "along"), "crank_velocity_rad_s");
  EXPECT_TRUE(cell(table, 2, "reverses_from").is_null());
}

/// The same rows twice: replicates without scatter.
std::vector<Row> twice(std::vector<Row> rows) {
  const std::size_t count = rows.size();
  for (std::size_t i = 0; i < count; ++i) rows.push_back(rows[i]);
  return rows;
}

const std::vector<Row> kTurning{
    {"rigid", 5, 100, 0},  {"flexible", 5, 99.9999, 1}, {"rigid", 10, 100, 0}, {"flexible", 10, 130, 1},
    {"rigid", 11, 100, 0}, {"flexible", 11, 99.95, 1},  {"rigid", 12, 100, 0}, {"flexible", 12, 60, 1}};

// Without clearance the ratio is 1 but for rounding: that is no difference, and none to reverse from.
TEST(CompareLinks, SaysNothingOfDifferencesThatAreSmallerThanErrors) {
  const auto table = compare_links(kSweep, table_of(twice(kTurning)), kPeak);
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(cell(table, 0, "verdict"), "either");
  EXPECT_EQ(cell(table, 1, "verdict"), "harms");
  EXPECT_TRUE(cell(table, 1, "reverses_from").is_null());
  EXPECT_EQ(cell(table, 2, "verdict"), "either");
  EXPECT_TRUE(cell(table, 2, "reverses_from").is_null());
  EXPECT_EQ(cell(table, 3, "verdict"), "helps");
  EXPECT_EQ(cell(table, 3, "reverses_from"), 10.0);
}

TEST(CompareLinks, GivesNoVerdictOnSingleRuns) {
  const auto table = compare_links(kSweep, table_of(kTurning), kPeak);
  ASSERT_EQ(table.rows.size(), 4U);
  for (std::size_t row = 0; row < 4; ++row) {
    EXPECT_EQ(cell(table, row, "verdict"), "one_run_each");
    EXPECT_TRUE(cell(table, row, "reverses_from").is_null());
  }
  EXPECT_EQ(cell(table, 1, "ratio"), 1.3);
}

TEST(CompareLinks, LeavesOutWhatHasNoPartner) {
  const auto table =
      compare_links(kSweep, table_of({{"rigid", 5, 100, 0}, {"flexible", 5, nullptr, nullptr}}), kPeak);
  EXPECT_TRUE(cell(table, 0, "ratio").is_null());
  EXPECT_TRUE(cell(table, 0, "verdict").is_null());
  EXPECT_TRUE(cell(table, 0, "coupler_loss_j").is_null());
  EXPECT_THROW(
      (void)compare_links({{"axes", {"crank_velocity_rad_s"}}}, table_of({{"rigid", 5, 100, 0}}), kPeak),
      jobs::WrongState);
  EXPECT_THROW((void)compare_links(kSweep, table_of({{"rigid", 5, 100, 0}}), "coupler"),
               jobs::InvalidRequest);
}

}  // namespace
}  // namespace jobs_tests
