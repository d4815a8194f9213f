// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/analysis/quantities.h"
#include "jobs/base/errors.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using std::numbers::pi;

constexpr double kWearPower = 40.0;  // 100 N at 0.4 m/s
constexpr double kWearCoefficient = 2e-14;

const json kParameters{
    {"clearance_mm", 0.25}, {"bearing_radius_mm", 5.0}, {"bearing_length_mm", 20.0}, {"radial_levels", 2}};

/// 10 s of a journal whose first ring slides steadily; its contact goes round the bore so often, from an
/// angle of 1 rad on.
engine::Trajectory sliding(double turns) {
  engine::Trajectory run;
  for (const std::string key :
       {"t_s", "ring_1_sliding_work_j", "ring_1_sliding_work_x_j", "ring_1_sliding_work_y_j",
        "ring_2_sliding_work_j", "ring_2_sliding_work_x_j", "ring_2_sliding_work_y_j"}) {
    run.channels.push_back({.key = key, .help = ""});
  }
  run.columns.resize(7);
  const double rate = 2.0 * pi * turns / 10.0;
  for (int k = 0; k <= 10000; ++k) {
    const double t = k / 1000.0;
    const double angle = 1.0 + rate * t;
    const bool still = rate == 0.0;
    const double x = kWearPower * (still ? t * std::cos(1.0) : (std::sin(angle) - std::sin(1.0)) / rate);
    const double y = kWearPower * (still ? t * std::sin(1.0) : (std::cos(1.0) - std::cos(angle)) / rate);
    const std::vector<double> row{t, kWearPower * t, x, y, 0.0, 0.0, 0.0};
    for (std::size_t c = 0; c < row.size(); ++c) run.columns[c].push_back(row[c]);
  }
  return run;
}

double wear_cell(const jobs::ResultTable& table, std::size_t row, std::size_t column) {
  return table.rows.at(row).at(column);
}

// Archard: depth = k F v t / A, with the area of the whole strip of a ring, 2 pi r_b L / 2, where the contact
// goes round evenly.
TEST(WearMap, HasTheDepthOfASteadilySlidingJournal) {
  const auto table =
      jobs::make_wear_map({"", kParameters}, sliding(25.0),
                          {.wear_coefficient = kWearCoefficient, .sectors = 20, .worn_clearance = {}});
  ASSERT_EQ(table.rows.size(), 40U);
  const double depth_um = 1e6 * kWearCoefficient * kWearPower * 10.0 / (2.0 * pi * 5e-3 * 10e-3);
  // 400 samples a turn, 20 a sector: those at a sector's edges go to one side or the other, by the same
  // number each turn.
  for (std::size_t s = 0; s < 20; ++s) EXPECT_NEAR(wear_cell(table, s, 4), depth_um, 0.06 * depth_um) << s;
  double sum = 0.0;
  for (std::size_t s = 0; s < 20; ++s) sum += wear_cell(table, s, 4) / 20.0;
  EXPECT_NEAR(sum, depth_um, 1e-9 * depth_um);
  for (std::size_t s = 20; s < 40; ++s)
    EXPECT_EQ(wear_cell(table, s, 4), 0.0) << "the second ring does not touch";
  EXPECT_EQ(wear_cell(table, 0, 1), -10.0);
  EXPECT_EQ(wear_cell(table, 20, 1), 10.0);
}

// The same where it stays: all of it in the sector that holds 1 rad, number 3 of 20.
TEST(WearMap, GathersWhatStaysInItsSectorAndTellsItsLife) {
  const auto table =
      jobs::make_wear_map({"", kParameters}, sliding(0.0),
                          {.wear_coefficient = kWearCoefficient, .sectors = 20, .worn_clearance = 0.35});
  const double depth_um = 1e6 * kWearCoefficient * kWearPower * 10.0 / (2.0 * pi / 20.0 * 5e-3 * 10e-3);
  EXPECT_NEAR(wear_cell(table, 3, 4), depth_um, 1e-9 * depth_um);
  EXPECT_NEAR(wear_cell(table, 3, 2), 3.5 * 2.0 * pi / 20.0, 1e-12);
  EXPECT_NEAR(wear_cell(table, 3, 5), depth_um * 360.0, 1e-6 * depth_um);
  EXPECT_NEAR(wear_cell(table, 3, 6), 100.0 / (depth_um * 360.0), 1e-9) << "a tenth of a millimetre";
  EXPECT_TRUE(table.rows.at(4).at(6).is_null());
  EXPECT_EQ(wear_cell(table, 4, 4), 0.0);
}

// In a worn bore the wear is spread over the arc that is pressed, and what is worn already counts for the
// life.
TEST(WearMap, OfAWornBoreIsSpreadOverTheArcThatIsPressed) {
  json parameters = kParameters;
  parameters["wear_depth_um"] = json(std::vector<std::vector<double>>(2, std::vector<double>(20, 30.0)));
  engine::Trajectory run = sliding(0.0);
  for (const std::string ring : {"1", "2"}) {
    run.channels.push_back({.key = "ring_" + ring + "_sliding_work_penetration_j_m", .help = ""});
    run.columns.push_back(run.columns[ring == "1" ? 1 : 4]);
    for (double& work : run.columns.back()) work *= 2e-6;
  }
  EXPECT_EQ(jobs::wear_channels({"", parameters}).size(), 8U);
  const auto table = jobs::make_wear_map(
      {"", parameters}, run, {.wear_coefficient = kWearCoefficient, .sectors = 120, .worn_clearance = 0.35});
  const double half = std::acos(0.28 / 0.282);  // in rad; sectors of 3 degrees
  double sum = 0.0;
  int worn = 0;
  for (std::size_t s = 0; s < 120; ++s) {
    sum += wear_cell(table, s, 3);
    worn += wear_cell(table, s, 3) > 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum, kWearPower * 10.0, 1e-9 * sum);
  EXPECT_NEAR(worn, 2.0 * half / (2.0 * pi / 120.0), 1.6);
  EXPECT_NEAR(wear_cell(table, 19, 6) * wear_cell(table, 19, 5), 70.0, 1e-6)
      << "0.1 mm less what is worn already";
  run.channels.pop_back();
  EXPECT_THROW((void)jobs::make_wear_map({"", parameters}, run, {}), jobs::WrongState);
}

TEST(WearMap, IsOfAJointThatSlides) {
  json ideal = kParameters;
  ideal["clearance_mm"] = 0.0;
  EXPECT_THROW((void)jobs::make_wear_map({"", ideal}, sliding(1.0), {}), jobs::WrongState);
  jobs::WearQuery query;
  query.worn_clearance = 0.25;
  EXPECT_THROW((void)jobs::make_wear_map({"", kParameters}, sliding(1.0), query), jobs::InvalidRequest);
  engine::Trajectory old = sliding(1.0);
  old.channels[1].key = "else";
  EXPECT_THROW((void)jobs::make_wear_map({"", kParameters}, old, {}), jobs::WrongState);
}

}  // namespace
}  // namespace jobs_tests
