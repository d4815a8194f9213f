// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/path_unit.h"

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "jobs/exports/table_column.h"
#include "jobs/parameters/parameter_table.h"

namespace jobs_tests {
namespace {

std::optional<std::string> unit_of(const std::string& path) { return jobs::find_path_unit(path); }

TEST(UnitOfAPath, IsThatOfItsParameterOrField) {
  for (const jobs::ParameterInfo& info : jobs::parameter_table()) EXPECT_EQ(unit_of(std::string(info.key)), info.unit);
  EXPECT_EQ(unit_of("axial_stiffness_n_m"), "N/m");
  EXPECT_EQ(unit_of("links.1,3.mass_kg"), "kg");
  EXPECT_EQ(unit_of("linkage.springs.stay.stiffness_n_m"), "N/m");
  EXPECT_EQ(unit_of("linkage.joints.elbow.damping_n_m_s_rad"), "N m s/rad");
  EXPECT_EQ(unit_of("linkage.joints.elbow.load_n_m"), "N m");
  EXPECT_EQ(unit_of("linkage.joints.elbow.clearance.bristle_damping_s_m"), "s/m");
  EXPECT_EQ(unit_of("linkage.bodies.rod.centre_of_mass_m.0"), "m");
  EXPECT_EQ(unit_of("crank_drive.resistance_ohm"), "ohm");
  EXPECT_EQ(unit_of("crank_drive.proportional"), "") << "the kind of the controller decides it";
  EXPECT_EQ(unit_of("peak_elbow_drive_n_m"), std::nullopt) << "a metric";
}

TEST(UnitOfAColumn, IsGuessedOfResultsAlone) {
  const auto columns = jobs::to_columns({.columns = {"gravity_m_s2", "bristle_stiffness_1_m", "peak_elbow_drive_n_m",
                                                     "peak_slider_acceleration_m_s2"},
                                         .rows = {{1, 1, 1, 1}},
                                         .ended = true});
  ASSERT_EQ(columns.size(), 4U);
  EXPECT_EQ(columns[0].unit, "m/s²");
  EXPECT_EQ(columns[1].unit, "1/m");
  EXPECT_EQ(columns[2].unit, "N m");
  EXPECT_EQ(columns[3].unit, "m/s²");
}

}  // namespace
}  // namespace jobs_tests
