// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/mechanism.h"
#include "jobs/base/errors.h"
#include "jobs/parameters/range.h"

namespace jobs {

/// Kind of value under a key of a described linkage.
enum class FieldKind {
  kNumber,
  kInteger,
  kBoolean,
  kText,     ///< at most 100 bytes
  kWord,     ///< one of `words`
  kBody,     ///< a body's name, or "ground"
  kPoint,    ///< three numbers
  kInertia,  ///< three numbers, or six: xx, yy, zz, xy, xz, yz
  kNumbers,  ///< a list of numbers
  kObject,   ///< an object of its own, checked by itself
  kEffort,   ///< a number, or an object as above: the law of a force, torque or voltage
};

[[nodiscard]] constexpr bool slides(engine::Motion motion) { return motion == engine::Motion::kTranslation; }

/// One key of an object of the description. Checks and the schema read these tables.
struct LinkageField {
  std::string_view key;
  FieldKind kind = FieldKind::kNumber;
  Range range = {};
  std::string_view unit = {};
  std::string_view help = {};
  bool required = false;
  std::vector<std::string_view> words = {};
  std::size_t fewest = 1;  ///< of a list of numbers
};

inline constexpr std::size_t kMostNumbers = 10'000;  ///< of a list

using LinkageFields = std::vector<LinkageField>;

[[nodiscard]] const LinkageFields& linkage_fields();                       ///< of the description itself
[[nodiscard]] const LinkageFields& body_fields();
[[nodiscard]] const LinkageFields& beam_fields();
[[nodiscard]] const LinkageFields& joint_fields();
[[nodiscard]] const LinkageFields& spring_fields();
[[nodiscard]] const LinkageFields& accelerometer_fields();
[[nodiscard]] LinkageFields freedom_fields(engine::Motion motion);
[[nodiscard]] LinkageFields drive_fields(engine::Motion motion, std::string_view law);

/// Keys of the coefficients of a polynomial drive, which has one of both. The former key looks like a rate's.
struct CoefficientKeys {
  const char* key;
  const char* former_key;
};
[[nodiscard]] CoefficientKeys coefficient_keys(engine::Motion motion);
[[nodiscard]] const LinkageFields& clearance_fields();  ///< parameters of a job that a clearance joint may
                                                        ///< have

inline constexpr std::string_view kLaws[] = {"run_up",     "rise_return_pause", "cycloidal",     "harmonic",
                                             "polynomial", "table",             "velocity_table"};

/// The faults of an object's keys and of the values that can be judged by themselves.
void check_fields(const nlohmann::json& object, const LinkageFields& fields, const std::string& pointer,
                  std::vector<Fault>& faults);

/// The schema of an object of these keys.
[[nodiscard]] nlohmann::json schema_of_fields(const LinkageFields& fields);

}  // namespace jobs
