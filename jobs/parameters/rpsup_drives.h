// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/actuator.h"
#include "engine/model/drive_law.h"
#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"

namespace jobs {

inline constexpr std::string_view kCrankDriveKey = "crank_drive";
inline constexpr std::string_view kRodDriveKey = "rod_drive";

/// A parameter that gives a driven coordinate of the linkage "rpsup" another law than the paper's, or an
/// actuator. A set has either this parameter, if it is given, or those that it replaces.
struct RpsupDrive {
  std::string_view key;
  engine::Motion motion;
  std::vector<std::string_view> replaced_by_law, replaced_by_actuator;
  std::string_view help;
  std::optional<engine::DriveLaw> engine::RpsupParameters::* law;
  std::optional<engine::Actuator> engine::RpsupParameters::* actuator;

  /// @param given  value of the key
  [[nodiscard]] const std::vector<std::string_view>& replaced_by(const nlohmann::json& given) const;
};

[[nodiscard]] const std::array<RpsupDrive, 2>& rpsup_drives();

/// @returns whether a drive is an actuator, which gives a force, and no law, which gives the motion
[[nodiscard]] bool is_actuator(const nlohmann::json& drive);

[[nodiscard]] const RpsupDrive* find_rpsup_drive(std::string_view key);  ///< null if there is none

/// The drive given in a parameter set in the place of one of its parameters; null if there is none.
[[nodiscard]] const RpsupDrive* find_replacing_drive(const nlohmann::json& given, std::string_view parameter);

}  // namespace jobs
