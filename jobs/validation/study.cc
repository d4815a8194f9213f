#include "jobs/validation/study.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "jobs/validation/text.h"

namespace jobs::validation {

using nlohmann::ordered_json;

std::string describe(const StudyCase& c) {
  return to_text("%g mm, ", c.clearance_mm) + to_text("%g rad/s, ", c.crank_velocity_rad_s) + c.coupler;
}

std::vector<std::size_t> StudyTable::find(const StudyCase& c, const std::string& more, double value) const {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < results_.rows.size(); ++row) {
    if (number(row, "clearance_mm") != c.clearance_mm || number(row, "crank_velocity_rad_s") != c.crank_velocity_rad_s) continue;
    if (text(row, "coupler") != c.coupler || (!more.empty() && number(row, more) != value)) continue;
    rows.push_back(row);
  }
  if (rows.empty()) throw std::out_of_range("the study has no case " + describe(c));
  return rows;
}

const nlohmann::json& StudyTable::cell(std::size_t row, const std::string& column) const {
  const auto found = std::find(results_.columns.begin(), results_.columns.end(), column);
  if (found == results_.columns.end()) throw std::out_of_range("the study has no column " + column);
  return results_.rows.at(row).at(static_cast<std::size_t>(found - results_.columns.begin()));
}

double StudyTable::number(std::size_t row, const std::string& column) const {
  const nlohmann::json& value = cell(row, column);
  if (!value.is_number()) throw std::out_of_range("row " + std::to_string(row) + " of the study has no " + column);
  return value.get<double>();
}

std::string StudyTable::text(std::size_t row, const std::string& column) const { return cell(row, column).get<std::string>(); }

std::vector<double> StudyTable::numbers(const std::vector<std::size_t>& rows, const std::string& column) const {
  std::vector<double> values;
  for (const std::size_t row : rows) values.push_back(number(row, column));
  return values;
}

const std::vector<OpenParameter>& open_parameters() {
  static const std::vector<OpenParameter> parameters{
      {"bearing_length_mm", "length of the bearing", {10.0, 40.0}},
      {"rod_stroke_mm", "stroke of slider (1,2)", {25.0, 75.0}},
      {"guide_offset_z_m", "offset of the guide along the crank's axis", {0.1, 0.3}},
      {"guide_offset_y_m", "offset of the guide upwards", {0.05}},
      {"contact_stiffness_scale", "stiffness of the contact", {0.5, 2.0}},
      {"coupler_damping_ratio", "damping of the coupler", {0.002, 0.05}},
      {"gravity_m_s2", "gravity", {0.0}},
  };
  return parameters;
}

namespace {

/// The cases that are said to converge, by the other integrator and with tolerances at which its own error is below the perturbation's.
ordered_json tighter_request(const ordered_json& replicates) {
  ordered_json cases = ordered_json::array();
  for (const StudyCase& c : converging_cases())
    cases.push_back({{"coupler", c.coupler}, {"clearance_mm", c.clearance_mm}, {"crank_velocity_rad_s", c.crank_velocity_rad_s}});
  return {{"name", "validation: tighter tolerances"},
          {"parameters", {{"integrator", "dopri5"}, {"relative_tolerance", 1e-7}, {"absolute_tolerance", 1e-8}}},
          {"cases", cases},
          {"replicates", replicates}};
}

}  // namespace

std::vector<StudyCase> converging_cases() {
  std::vector<StudyCase> cases;
  for (const double clearance : kClearances) {
    for (const double velocity : kCrankVelocities)
      for (const std::string coupler : kCouplers)
        if (const StudyCase c{clearance, velocity, coupler}; converges(c)) cases.push_back(c);
  }
  return cases;
}

bool converges(const StudyCase& c) { return c.coupler == "rigid" || c.clearance_mm == 0.0 || c.crank_velocity_rad_s <= 5.0; }

std::vector<ordered_json> study_requests() {
  const ordered_json replicates{{"count", 5}, {"perturbation", 1e-6}, {"seed", 1}};
  std::vector<ordered_json> requests{
      {{"name", "validation: ideal joint"},
       {"sweep", {{"clearance_mm", {0.0}}, {"crank_velocity_rad_s", kCrankVelocities}, {"coupler", kCouplers}}}},
      {{"name", "validation: joint with clearance"},
       {"sweep", {{"clearance_mm", kClearances}, {"crank_velocity_rad_s", kCrankVelocities}, {"coupler", kCouplers}}},
       {"replicates", replicates}},
      tighter_request(replicates),
  };
  for (const OpenParameter& parameter : open_parameters())
    requests.push_back({{"name", "validation: " + parameter.key},
                        {"sweep",
                         {{parameter.key, parameter.values},
                          {"clearance_mm", kClearances},
                          {"crank_velocity_rad_s", {10.0, 15.0}},
                          {"coupler", parameter.key == "coupler_damping_ratio" ? ordered_json{"flexible"} : ordered_json(kCouplers)}}}});
  return requests;
}

Study make_study(std::vector<ResultTable> results, TrajectoryReader read_trajectory) {
  std::vector<StudyTable> tables;
  for (ResultTable& table : results) tables.emplace_back(std::move(table));
  Study study{std::move(tables.at(0)), std::move(tables.at(1)), std::move(tables.at(2)), {}, std::move(read_trajectory)};
  study.open.assign(std::make_move_iterator(tables.begin() + 3), std::make_move_iterator(tables.end()));
  return study;
}

}  // namespace jobs::validation
