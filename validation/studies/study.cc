// SPDX-License-Identifier: Apache-2.0
#include "validation/studies/study.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "validation/studies/text.h"

namespace validation::studies {

using nlohmann::ordered_json;

std::string describe(const StudyCase& c) {
  return to_text("%g mm, ", c.clearance_mm) + to_text("%g rad/s, ", c.crank_velocity_rad_s) + c.coupler;
}

std::vector<std::size_t> StudyTable::find(const StudyCase& c, const std::string& more, double value) const {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < results_.rows.size(); ++row) {
    if (number(row, "clearance_mm") != c.clearance_mm ||
        number(row, "crank_velocity_rad_s") != c.crank_velocity_rad_s)
      continue;
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
  if (!value.is_number())
    throw std::out_of_range("row " + std::to_string(row) + " of the study has no " + column);
  return value.get<double>();
}

std::string StudyTable::text(std::size_t row, const std::string& column) const {
  return cell(row, column).get<std::string>();
}

std::vector<double> StudyTable::numbers(const std::vector<std::size_t>& rows,
                                        const std::string& column) const {
  std::vector<double> values;
  for (const std::size_t row : rows) values.push_back(number(row, column));
  return values;
}

namespace {

/// The cases that are said to converge, by the other integrator and with tolerances at which its own error is
/// below the perturbation's.
ordered_json tighter_request(const ordered_json& replicates) {
  ordered_json cases = ordered_json::array();
  for (const StudyCase& c : converging_cases())
    cases.push_back({{"coupler", c.coupler},
                     {"clearance_mm", c.clearance_mm},
                     {"crank_velocity_rad_s", c.crank_velocity_rad_s}});
  return {
      {"name", "validation: tighter tolerances"},
      {"parameters", {{"integrator", "dopri5"}, {"relative_tolerance", 1e-9}, {"absolute_tolerance", 1e-10}}},
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

bool converges(const StudyCase& c) { return c.clearance_mm == 0.0 || c.crank_velocity_rad_s < 15.0; }

std::vector<ordered_json> study_requests() {
  const ordered_json replicates{{"count", 5}, {"perturbation", 1e-6}, {"seed", 1}};
  return {
      {{"name", "validation: ideal joint"},
       {"sweep",
        {{"clearance_mm", {0.0}}, {"crank_velocity_rad_s", kCrankVelocities}, {"coupler", kCouplers}}}},
      {{"name", "validation: joint with clearance"},
       {"sweep",
        {{"clearance_mm", kClearances}, {"crank_velocity_rad_s", kCrankVelocities}, {"coupler", kCouplers}}},
       {"replicates", replicates}},
      tighter_request(replicates),
  };
}

Study make_study(std::vector<ResultTable> results, TrajectoryReader read_trajectory) {
  return {StudyTable(std::move(results.at(0))), StudyTable(std::move(results.at(1))),
          StudyTable(std::move(results.at(2))), std::move(read_trajectory)};
}

}  // namespace validation::studies
