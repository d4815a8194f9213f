// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_drive.h"

#include <algorithm>
#include <numbers>
#include <string_view>
#include <utility>

#include "jobs/linkages/linkage_actuator.h"
#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/rpsup_drives.h"

namespace jobs {
namespace {

using nlohmann::json;
using Numbers = std::vector<double>;

/// Faults that the keys of a law have together, or that its ranges do not show.
void check_law(const json& drive, engine::Motion motion, const std::string& pointer,
               std::vector<Fault>& faults) {
  if (drive.at("law") == "run_up")
    if (std::string detail = describe_run_up_fault(drive.value("time_s", 0.0)); !detail.empty())
      faults.push_back({pointer + "/time_s", std::move(detail)});
  if (drive.at("law") == "table")
    check_table(drive, "times_s", slides(motion) ? "values_m" : "values_rad", pointer, faults);
  if (drive.at("law") == "velocity_table")
    check_table(drive, "times_s", slides(motion) ? "velocities_m_s" : "velocities_rad_s", pointer, faults);
}

/// Lets the former key stand for the present one, but not beside it.
void allow_former_key(const json& drive, engine::Motion motion, const std::string& pointer,
                      LinkageFields& fields, std::vector<Fault>& faults) {
  const auto [key, former_key] = coefficient_keys(motion);
  if (!drive.contains(former_key)) return;
  std::ranges::find(fields, std::string_view(key), &LinkageField::key)->required = false;
  if (drive.contains(key))
    faults.push_back({pointer + pointer_token(former_key),
                      std::string("is the former name of ") + key + ": give one of them"});
}

engine::StrokeLaw stroke_law_of(const std::string& word) {
  if (word == "cosine") return engine::StrokeLaw::kCosine;
  return word == "parabolic" ? engine::StrokeLaw::kParabolic : engine::StrokeLaw::kCycloidal;
}

}  // namespace

void check_drive(const json& drive, engine::Motion motion, const std::string& pointer,
                 std::vector<Fault>& faults) {
  if (!drive.is_object()) return faults.push_back({pointer, "must be an object with a law or an actuator"});
  if (is_actuator(drive)) return check_actuator(drive, motion, pointer, faults);
  const std::size_t before = faults.size();
  const std::string law =
      drive.contains("law") && drive.at("law").is_string() ? drive.at("law").get<std::string>() : "";
  if (std::ranges::find(kLaws, law) == std::end(kLaws))
    return check_fields(json{{"law", drive.value("law", json())}}, drive_fields(motion, ""), pointer, faults);
  LinkageFields fields = drive_fields(motion, law);
  if (law == "polynomial") allow_former_key(drive, motion, pointer, fields, faults);
  check_fields(drive, fields, pointer, faults);
  if (faults.size() == before) check_law(drive, motion, pointer, faults);
}

void check_table(const json& table, const std::string& variable, std::string_view values,
                 const std::string& pointer, std::vector<Fault>& faults) {
  constexpr double kLeastStep = 0.999999e-6;  // rounded
  const auto at = table.at(variable).get<Numbers>();
  const auto too_close = [](double a, double b) { return !(b - a >= kLeastStep); };
  if (std::ranges::adjacent_find(at, too_close) != at.end())
    faults.push_back({pointer + pointer_token(variable),
                      std::string("must rise, each by 1e-6 ") + (variable == "times_s" ? "s " : "") +
                          "or more"});
  if (table.at(values).size() != at.size())
    faults.push_back(
        {pointer + pointer_token(values),
         "must have one value for each of the " + std::to_string(at.size()) + " of " + variable});
}

std::string describe_run_up_fault(double time_s) {
  return time_s == 0.0 || time_s >= 1e-6 ? ""
                                         : "must be 0 (at full velocity from the start) or at least 1e-6 s";
}

json canonical_drive(const json& drive, engine::Motion motion) {
  json canonical = canonical_description(drive);
  if (is_actuator(canonical)) return canonical_actuator(std::move(canonical), motion);
  const auto [key, former_key] = coefficient_keys(motion);
  if (canonical.contains(former_key)) {
    canonical[key] = canonical.at(former_key);
    canonical.erase(former_key);
  }
  if (canonical.at("law") == "velocity_table" && !canonical.contains("interpolation"))
    canonical["interpolation"] = "monotone_cubic";
  return canonical;
}

engine::DriveLaw read_drive(const json& drive, engine::Motion motion,
                            const engine::RpsupParameters& defaults) {
  const auto at = [&](const char* in_metres, const char* in_radians) {
    return drive.value(slides(motion) ? in_metres : in_radians, 0.0);
  };
  const auto numbers = [&](const char* in_metres, const char* in_radians) {
    return drive.at(slides(motion) ? in_metres : in_radians).get<Numbers>();
  };
  const std::string law = drive.at("law").get<std::string>();
  if (law == "run_up")
    return engine::RunUp{at("velocity_m_s", "velocity_rad_s"), drive.value("time_s", defaults.run_up),
                         at("from_m", "from_rad")};
  if (law == "rise_return_pause")
    return engine::RiseReturnPause{
        at("stroke_m", "stroke_rad"), drive.at("stroke_time_s").get<double>(), drive.value("pause_s", 0.0),
        stroke_law_of(drive.value("stroke_law", "cycloidal")), at("from_m", "from_rad")};
  if (law == "cycloidal")
    return engine::CycloidalRise{at("from_m", "from_rad"), at("rise_m", "rise_rad"),
                                 drive.value("begin_s", 0.0), drive.at("time_s").get<double>()};
  if (law == "harmonic")
    return engine::Harmonic{at("mean_m", "mean_rad"), at("amplitude_m", "amplitude_rad"),
                            2.0 * std::numbers::pi * drive.at("frequency_hz").get<double>(),
                            drive.value("phase_rad", 0.0)};
  if (law == "polynomial") {
    const auto [key, former_key] = coefficient_keys(motion);
    return engine::Polynomial{drive.at(drive.contains(key) ? key : former_key).get<Numbers>()};
  }
  if (law == "table")
    return engine::Spline(drive.at("times_s").get<Numbers>(), numbers("values_m", "values_rad"));
  const bool linear = drive.value("interpolation", "") == "linear";
  return engine::VelocityTable(
      drive.at("times_s").get<Numbers>(), numbers("velocities_m_s", "velocities_rad_s"),
      linear ? engine::TableInterpolation::kLinear : engine::TableInterpolation::kMonotoneCubic,
      at("from_m", "from_rad"));
}

}  // namespace jobs
