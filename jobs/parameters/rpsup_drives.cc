// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/rpsup_drives.h"

#include <algorithm>

namespace jobs {

const std::array<RpsupDrive, 2>& rpsup_drives() {
  static const std::array<RpsupDrive, 2> drives{
      RpsupDrive{.key = kCrankDriveKey,
                 .motion = engine::Motion::kRotation,
                 .replaced_by_law = {"crank_velocity_rad_s", "crank_start_rad"},
                 .replaced_by_actuator = {"crank_velocity_rad_s"},
                 .help = "Law of the crank's angle from x, in the place of crank_velocity_rad_s and "
                         "crank_start_rad; or an actuator, which moves the crank from rest at "
                         "crank_start_rad. Peaks still count from run_up_s on",
                 .law = &engine::RpsupParameters::crank_drive,
                 .actuator = &engine::RpsupParameters::crank_actuator},
      RpsupDrive{.key = kRodDriveKey,
                 .motion = engine::Motion::kTranslation,
                 .replaced_by_law = {"rod_start_m", "rod_stroke_mm", "rod_stroke_time_s", "rod_pause_s",
                                     "rod_law"},
                 .replaced_by_actuator = {"rod_stroke_mm", "rod_stroke_time_s", "rod_pause_s", "rod_law"},
                 .help = "Law of the rod's displacement along the crank, 0 with the S joint at rod_length_m "
                         "from the crank's axis, in the place of rod_start_m and of the stroke; or an "
                         "actuator, which moves the rod from rest at rod_start_m",
                 .law = &engine::RpsupParameters::rod_drive,
                 .actuator = &engine::RpsupParameters::rod_actuator}};
  return drives;
}

const RpsupDrive* find_rpsup_drive(std::string_view key) {
  const auto found = std::ranges::find(rpsup_drives(), key, &RpsupDrive::key);
  return found == rpsup_drives().end() ? nullptr : &*found;
}

const RpsupDrive* find_replacing_drive(const nlohmann::json& given, std::string_view parameter) {
  for (const RpsupDrive& drive : rpsup_drives())
    if (given.contains(drive.key)) {
      const std::vector<std::string_view>& replaced = drive.replaced_by(given.at(drive.key));
      if (std::ranges::find(replaced, parameter) != replaced.end()) return &drive;
    }
  return nullptr;
}

bool is_actuator(const nlohmann::json& drive) { return drive.is_object() && drive.contains("actuator"); }

const std::vector<std::string_view>& RpsupDrive::replaced_by(const nlohmann::json& given) const {
  return is_actuator(given) ? replaced_by_actuator : replaced_by_law;
}

}  // namespace jobs
