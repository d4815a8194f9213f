// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/table_groups.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace {

using jobs::choose_free_metric;
using jobs::choose_metrics;
using jobs::ResultTable;

const nlohmann::json kCrankDriven = nlohmann::json::parse(
    R"({"request": {"parameters": {"linkage": {"joints": {"crank": {"drive": {"law": "harmonic"}}}}}}})");

TEST(ChooseFreeMetric, LeavesOutWhatADrivePrescribes) {
  const ResultTable table{.columns = {"job_id", "state", "linkage.bodies.rod.mass_kg",
                                      "peak_crank_acceleration_rad_s2", "peak_rod_reaction_n"},
                          .rows = {{"a", "succeeded", 1.0, 110.0, 3.0},
                                   {"b", "failed", 2.0, nullptr, nullptr},
                                   {"c", "succeeded", 3.0, 120.0, 4.0}}};
  EXPECT_EQ(choose_free_metric(kCrankDriven, table, ""), "peak_rod_reaction_n");
  EXPECT_EQ(choose_free_metric({}, table, ""), "peak_crank_acceleration_rad_s2");
  EXPECT_EQ(choose_free_metric(kCrankDriven, table, "peak_crank_acceleration_rad_s2"),
            "peak_crank_acceleration_rad_s2");
}

TEST(ChooseFreeMetric, LeavesOutWhatADriveOfACasePrescribes) {
  const auto sweep = nlohmann::json::parse(
      R"({"request": {"cases": [{"linkage": {"joints": {"crank": {"drive": {"law": "harmonic"}}}}}]}})");
  const ResultTable table{
      .columns = {"job_id", "state", "peak_crank_acceleration_rad_s2", "peak_rod_reaction_n"},
      .rows = {{"a", "succeeded", 110.0, 3.0}, {"b", "succeeded", 120.0, 4.0}}};
  EXPECT_EQ(choose_free_metric(sweep, table, ""), "peak_rod_reaction_n");
}

TEST(ChooseFreeMetric, IsOfAFreeCoordinateWhoseNameEndsInADrivenOne) {
  const ResultTable table{.columns = {"job_id", "state", "peak_crank_acceleration_rad_s2", "rms_crank_acceleration_rad_s2",
                                      "peak_big_crank_acceleration_rad_s2"},
                          .rows = {{"a", "succeeded", 1.0, 1.0, 110.0}, {"b", "succeeded", 2.0, 2.0, 120.0}}};
  EXPECT_EQ(choose_free_metric(kCrankDriven, table, ""), "peak_big_crank_acceleration_rad_s2");
}

TEST(ChooseFreeMetric, PrefersAnAcceleration) {
  const ResultTable table{
      .columns = {"job_id", "state", "peak_crank_drive_n_m", "peak_rod_acceleration_m_s2"},
      .rows = {{"a", "succeeded", 1.0, 110.0}, {"b", "succeeded", 2.0, 120.0}}};
  EXPECT_EQ(choose_free_metric(kCrankDriven, table, ""), "peak_rod_acceleration_m_s2");
}

TEST(ChooseFreeMetric, IsNoTime) {
  const ResultTable table{
      .columns = {"job_id", "state", "peak_rod_acceleration_m_s2", "peak_rod_acceleration_time_s",
                  "peak_rod_reaction_n"},
      .rows = {{"a", "succeeded", 1.0, 0.5, 3.0}, {"b", "succeeded", 1.0, 0.6, 4.0}}};
  EXPECT_EQ(choose_free_metric({}, table, ""), "peak_rod_reaction_n");
  const std::vector<std::string> own{"peak_rod_acceleration_m_s2", "peak_rod_reaction_n"};
  const std::vector<std::string_view> wanted{"peak_slider_acceleration_m_s2", "impact_count", "steps"};
  EXPECT_EQ(choose_metrics(table, wanted), own);
}

TEST(ChooseFreeMetric, IsTheFirstOneIfNoneVaries) {
  const ResultTable table{.columns = {"job_id", "state", "one_m", "other_m"},
                          .rows = {{"a", "succeeded", 1.0, 1.0}, {"b", "succeeded", 1.0, 1.0 + 1e-12}}};
  EXPECT_EQ(choose_free_metric({}, table, ""), "one_m");
}

TEST(ChooseFreeMetric, IsThePeakOfTheSliderWhereThereIsOne) {
  const ResultTable table{.columns = {"job_id", "state", "impact_count", "peak_slider_acceleration_m_s2"},
                          .rows = {{"a", "succeeded", 1, 5.0}, {"b", "succeeded", 2, 5.0}}};
  EXPECT_EQ(choose_free_metric({}, table, ""), "peak_slider_acceleration_m_s2");
}

}  // namespace
