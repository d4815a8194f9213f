// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/parameters/job_spec.h"
#include "jobs/parameters/range.h"

namespace jobs {

enum class ParameterKind { kNumber, kInteger, kChoice };

/// Scope of a parameter: any job, each joint with clearance, each flexible body, or the RPSUP linkage alone.
enum class ParameterScope { kRun, kJoint, kMaterial, kRpsup };

/// Source of a default: printed in the paper, deduced from its numbers, fitted to the ratios of peaks that it
/// prints, or chosen by this project.
enum class DefaultSource { kPaper, kDeduced, kFitted, kChosen };

/// "paper", "deduced from the paper", "fitted to the paper's ratios" or "chosen".
[[nodiscard]] std::string_view source_name(DefaultSource source);

/// One parameter as users know it. Everything that is said about parameters (checks, defaults, schema,
/// conversion) reads this.
struct ParameterInfo {
  std::string_view key;     ///< ends in its unit
  std::string_view member;  ///< the engine's name of it, as engine::InvalidInput::field gives it
  ParameterKind kind = ParameterKind::kNumber;
  std::string_view unit;    ///< empty: none
  DefaultSource source = DefaultSource::kChosen;
  ParameterScope scope = ParameterScope::kRpsup;
  Range range;                            ///< in the key's unit; of numbers and integers
  std::vector<std::string_view> choices;  ///< the words of a choice
  std::string_view help;
  std::function<nlohmann::json(const JobSpec&)> read;          ///< in the key's unit
  std::function<void(JobSpec&, const nlohmann::json&)> write;  ///< expects a value that has been checked
};

/// All parameters but `links`, in the order in which they are shown.
[[nodiscard]] std::span<const ParameterInfo> parameter_table();

/// The parameter of that key; null if there is none.
[[nodiscard]] const ParameterInfo* find_parameter(std::string_view key);

/// The default of a parameter: what a default-constructed engine type holds.
[[nodiscard]] nlohmann::json default_value(const ParameterInfo& info);

}  // namespace jobs
