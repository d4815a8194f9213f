// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_drive.h"

#include <algorithm>
#include <numbers>

#include "jobs/linkages/linkage_fields.h"
#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;
using Numbers = std::vector<double>;

void check_table(const json& drive, engine::Motion motion, const std::string& pointer,
                 std::vector<Fault>& faults) {
  const auto times = drive.at("times_s").get<Numbers>();
  const char* const values = slides(motion) ? "values_m" : "values_rad";
  if (times.size() < 2 ||
      std::ranges::adjacent_find(times, [](double a, double b) { return !(a < b); }) != times.end())
    faults.push_back({pointer + "/times_s", "must be two times or more, each later than the one before"});
  if (drive.at(values).size() != times.size())
    faults.push_back({pointer + pointer_token(values),
                      "must have one value for each of the " + std::to_string(times.size()) + " times"});
}

engine::StrokeLaw stroke_law_of(const std::string& word) {
  if (word == "cosine") return engine::StrokeLaw::kCosine;
  return word == "parabolic" ? engine::StrokeLaw::kParabolic : engine::StrokeLaw::kCycloidal;
}

}  // namespace

void check_drive(const json& drive, engine::Motion motion, const std::string& pointer,
                 std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const std::string law =
      drive.contains("law") && drive.at("law").is_string() ? drive.at("law").get<std::string>() : "";
  if (std::ranges::find(kLaws, law) == std::end(kLaws)) {
    const LinkageFields any = drive_fields(motion, "");
    check_fields(json{{"law", drive.value("law", json())}}, any, pointer, faults);
    return;
  }
  check_fields(drive, drive_fields(motion, law), pointer, faults);
  if (law == "table" && faults.size() == before) check_table(drive, motion, pointer, faults);
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
  if (law == "polynomial") return engine::Polynomial{numbers("coefficients_m_s", "coefficients_rad_s")};
  return engine::Spline(drive.at("times_s").get<Numbers>(), numbers("values_m", "values_rad"));
}

}  // namespace jobs
