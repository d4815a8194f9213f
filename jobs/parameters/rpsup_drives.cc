// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/rpsup_drives.h"

#include <algorithm>

namespace jobs {

const std::array<RpsupDrive, 2>& rpsup_drives() {
  static const std::array<RpsupDrive, 2> drives{
      RpsupDrive{.key = kCrankDriveKey,
                 .motion = engine::Motion::kRotation,
                 .replaced = {"crank_velocity_rad_s", "crank_start_rad"},
                 .help = "Law of the crank's angle from x, in the place of crank_velocity_rad_s and "
                         "crank_start_rad. Peaks still count from run_up_s on",
                 .member = &engine::RpsupParameters::crank_drive},
      RpsupDrive{.key = kRodDriveKey,
                 .motion = engine::Motion::kTranslation,
                 .replaced = {"rod_start_m", "rod_stroke_mm", "rod_stroke_time_s", "rod_pause_s", "rod_law"},
                 .help = "Law of the rod's displacement along the crank, 0 with the S joint at rod_length_m "
                         "from the crank's axis, in the place of rod_start_m and of the stroke",
                 .member = &engine::RpsupParameters::rod_drive}};
  return drives;
}

const RpsupDrive* find_rpsup_drive(std::string_view key) {
  const auto found = std::ranges::find(rpsup_drives(), key, &RpsupDrive::key);
  return found == rpsup_drives().end() ? nullptr : &*found;
}

const RpsupDrive* find_replacing_drive(const nlohmann::json& given, std::string_view parameter) {
  for (const RpsupDrive& drive : rpsup_drives())
    if (given.contains(drive.key) && std::ranges::find(drive.replaced, parameter) != drive.replaced.end())
      return &drive;
  return nullptr;
}

}  // namespace jobs
