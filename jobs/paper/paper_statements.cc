// SPDX-License-Identifier: Apache-2.0
#include "jobs/paper/paper_statements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/base/optional_json.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/results/table_groups.h"
#include "jobs/statistics/first_order_index.h"
#include "jobs/statistics/median.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> kAxes{"clearance_mm", "crank_velocity_rad_s", "coupler"};
constexpr std::array<const char*, 2> kCouplers{"rigid", "flexible"};
constexpr std::array<double, 2> kClearances{0.25, 0.5};  // [mm]
constexpr double kSlow = 10.0, kFast = 15.0;             // of the growths, [rad/s]
constexpr double kGrowthWithin = 0.2, kSameWithin = 0.05;
constexpr double kPeaksRightTo =
    1e-3;  // accuracy that default tolerances aim at: ratios nearer to 1 show no difference

/// One case of the paper's sweeps.
struct PaperCase {
  double clearance = 0.0, velocity = 0.0;
  std::string coupler;
  auto operator<=>(const PaperCase&) const = default;
};

/// The peaks of one setting, each the median of its replicates.
using Peaks = std::map<PaperCase, double>;

/// Ratios of peaks that one statement speaks of; empty if the setting has no peak for them.
using Ratios = std::vector<double>;

std::optional<double> ratio_of(const Peaks& peaks, const PaperCase& over, const PaperCase& under) {
  const auto a = peaks.find(over), b = peaks.find(under);
  return a != peaks.end() && b != peaks.end() && b->second > 0.0 ? std::optional(a->second / b->second)
                                                                 : std::nullopt;
}

/// All of some ratios, or none.
Ratios gather(const std::vector<std::optional<double>>& ratios) {
  Ratios all;
  for (const auto& ratio : ratios) {
    if (!ratio) return {};
    all.push_back(*ratio);
  }
  return all;
}

Ratios flexible_over_rigid_ideal(const Peaks& peaks) {
  std::vector<std::optional<double>> ratios;
  for (const auto& [c, peak] : peaks)
    if (c.clearance == 0.0 && c.coupler == "rigid")
      ratios.push_back(ratio_of(peaks, {0.0, c.velocity, "flexible"}, c));
  return gather(ratios);
}

Ratios growth(const Peaks& peaks, double clearance, const char* coupler) {
  return gather({ratio_of(peaks, {clearance, kFast, coupler}, {clearance, kSlow, coupler})});
}

Ratios wide_over_narrow(const Peaks& peaks, double velocity) {
  std::vector<std::optional<double>> ratios;
  for (const char* const coupler : kCouplers)
    ratios.push_back(ratio_of(peaks, {0.5, velocity, coupler}, {0.25, velocity, coupler}));
  return gather(ratios);
}

Ratios flexible_over_rigid(const Peaks& peaks, double velocity) {
  std::vector<std::optional<double>> ratios;
  for (const double clearance : kClearances)
    ratios.push_back(ratio_of(peaks, {clearance, velocity, "flexible"}, {clearance, velocity, "rigid"}));
  return gather(ratios);
}

struct Statement {
  std::string name;
  std::string text;
  json number;  ///< of the seven; null: the same at another velocity
  json paper;   ///< the ratio that it prints; null: it says only that the ratios are below 1
  std::function<Ratios(const Peaks&)> ratios;
  std::function<bool(double)> allows;  ///< every ratio
};

bool is_below_1(double ratio) { return ratio < 1.0 - kPeaksRightTo; }

std::string to_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

Statement growth_statement(int number, double clearance, const char* coupler, double paper) {
  return {.name = "growth_" + std::string(coupler) + "_" + to_text(clearance) + "_mm",
          .text = "peak at 15 rad/s over that at 10 rad/s, " + to_text(clearance) + " mm, " + coupler +
                  " coupler",
          .number = number,
          .paper = paper,
          .ratios = [=](const Peaks& peaks) { return growth(peaks, clearance, coupler); },
          .allows = [=](double ratio) { return std::abs(ratio / paper - 1.0) <= kGrowthWithin; }};
}

Statement order_of_clearances(json number, double velocity) {
  return {.name = "order_of_clearances_" + to_text(velocity) + "_rad_s",
          .text = "peak with 0.5 mm over that with 0.25 mm at " + to_text(velocity) +
                  " rad/s, rigid and flexible coupler",
          .number = std::move(number),
          .paper = nullptr,
          .ratios = [=](const Peaks& peaks) { return wide_over_narrow(peaks, velocity); },
          .allows = is_below_1};
}

Statement order_of_couplers(json number, double velocity) {
  return {.name = "order_of_couplers_" + to_text(velocity) + "_rad_s",
          .text = "peak with a flexible coupler over that with a rigid one at " + to_text(velocity) +
                  " rad/s, 0.25 and 0.5 mm",
          .number = std::move(number),
          .paper = nullptr,
          .ratios = [=](const Peaks& peaks) { return flexible_over_rigid(peaks, velocity); },
          .allows = is_below_1};
}

/// The seven, then the orders at the other velocities.
std::vector<Statement> make_statements(const std::vector<double>& velocities) {
  std::vector<Statement> statements{
      {.name = "ideal_couplers",
       .text = "no clearance: peak with a flexible coupler over that with a rigid one, at every velocity",
       .number = 1,
       .paper = 1.0,
       .ratios = flexible_over_rigid_ideal,
       .allows = [](double ratio) { return std::abs(ratio - 1.0) <= kSameWithin; }},
      growth_statement(2, 0.25, "rigid", 8.5),
      growth_statement(3, 0.25, "flexible", 4.0),
      growth_statement(4, 0.5, "rigid", 3.5),
      growth_statement(5, 0.5, "flexible", 1.25),
      order_of_clearances(6, kFast),
      order_of_couplers(7, kFast),
  };
  for (const double velocity : velocities)
    if (velocity != kFast) statements.push_back(order_of_clearances(nullptr, velocity));
  for (const double velocity : velocities)
    if (velocity != kFast) statements.push_back(order_of_couplers(nullptr, velocity));
  return statements;
}

/// The rows of a sweep by what it varies beside the paper's three axes.
struct Settings {
  std::vector<std::string> parameters;
  std::vector<std::vector<json>> values;  ///< of the parameters, one list a setting
  std::vector<Peaks> peaks;               ///< one a setting
};

std::vector<std::size_t> find_axes(const ResultTable& results) {
  std::vector<std::size_t> axes;
  for (const char* const axis : kAxes) {
    const auto found = std::ranges::find(results.columns, axis);
    if (found == results.columns.end())
      throw WrongState(std::string("the sweep does not vary ") + axis +
                       "; the paper's statements compare clearances, crank velocities and couplers");
    axes.push_back(static_cast<std::size_t>(found - results.columns.begin()));
  }
  return axes;
}

/// A case may stand in several rows: its replicates.
Peaks gather_peaks(const ResultTable& results, const RowGroup& group, const std::vector<std::size_t>& axes,
                   std::size_t metric) {
  std::map<PaperCase, std::vector<double>> replicates;
  for (const std::size_t r : group.rows) {
    const auto& row = results.rows[r];
    const auto clearance = number_in(row[axes[0]]), velocity = number_in(row[axes[1]]),
               peak = number_in(row[metric]);
    if (clearance && velocity && peak && row[axes[2]].is_string())
      replicates[{*clearance, std::abs(*velocity), row[axes[2]].get<std::string>()}].push_back(*peak);
  }
  Peaks peaks;
  for (auto& [c, values] : replicates) peaks[c] = calc_median(std::move(values));
  return peaks;
}

/// The columns of what a sweep varies beside the axes.
std::vector<std::size_t> find_parameter_columns(const ResultTable& results,
                                                const std::vector<std::size_t>& axes) {
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < results.columns.size(); ++k) {
    const std::string& column = results.columns[k];
    const bool given = is_varied_by_cases(column) || is_path_in_description(column) ||
                       std::ranges::find(known_paths(), column) != known_paths().end();
    if (given && std::ranges::find(axes, k) == axes.end()) columns.push_back(k);
  }
  return columns;
}

Settings gather_settings(const ResultTable& results) {
  const std::vector<std::size_t> axes = find_axes(results);
  const std::size_t metric = find_column(results, std::string(kReplicateMetric), "");
  Settings settings;
  const std::vector<std::size_t> columns = find_parameter_columns(results, axes);
  for (const std::size_t k : columns) settings.parameters.push_back(results.columns[k]);
  for (const RowGroup& group : group_rows(results, columns)) {
    settings.values.push_back(group.values);
    settings.peaks.push_back(gather_peaks(results, group, axes, metric));
  }
  return settings;
}

std::vector<double> velocities_of(const Settings& settings) {
  std::vector<double> velocities;
  for (const Peaks& peaks : settings.peaks)
    for (const auto& [c, peak] : peaks) velocities.push_back(c.velocity);
  std::ranges::sort(velocities);
  velocities.erase(std::unique(velocities.begin(), velocities.end()), velocities.end());
  return velocities;
}

/// Outcome of one statement over the settings that have its peaks.
struct StatementOutcome {
  std::vector<std::size_t> settings;         ///< those that have its peaks
  std::vector<double> least, largest, logs;  ///< of each one's ratios; the logarithm of their geometric mean
  std::size_t holding = 0;  ///< settings in which the statement holds
};

StatementOutcome check_statement(const Statement& statement, const Settings& settings) {
  StatementOutcome outcome;
  for (std::size_t s = 0; s < settings.peaks.size(); ++s) {
    const Ratios ratios = statement.ratios(settings.peaks[s]);
    if (ratios.empty()) continue;
    const auto [least, largest] = std::ranges::minmax_element(ratios);
    double log_sum = 0.0;
    for (const double ratio : ratios) log_sum += std::log(ratio);
    outcome.settings.push_back(s);
    outcome.least.push_back(*least);
    outcome.largest.push_back(*largest);
    outcome.logs.push_back(log_sum / static_cast<double>(ratios.size()));
    outcome.holding += std::ranges::all_of(ratios, statement.allows) ? 1 : 0;
  }
  return outcome;
}

json index_of(const Statement& statement, const StatementOutcome& outcome, const Settings& settings,
              std::size_t parameter) {
  if (statement.number.is_null() || outcome.settings.size() < kFewestSettings) return nullptr;
  std::vector<json> inputs;
  for (const std::size_t s : outcome.settings) inputs.push_back(settings.values[s][parameter]);
  return value_or_null(calc_first_order_index(inputs, outcome.logs));
}

bool has_indices(const Settings& settings) { return settings.peaks.size() >= kFewestSettings; }

/// The cells of a statement without its indices.
std::vector<json> outcome_cells(const Statement& statement, const StatementOutcome& outcome) {
  const std::size_t count = outcome.settings.size();
  return {statement.name,
          statement.number,
          statement.text,
          statement.paper,
          count > 0 ? json(calc_median(outcome.least)) : json(),
          count > 0 ? json(calc_median(outcome.largest)) : json(),
          count,
          count > 0 ? json(static_cast<double>(outcome.holding) / static_cast<double>(count)) : json(),
          count > 0 ? json(outcome.holding == count) : json()};
}

std::vector<json> statement_cells(const Statement& statement, const Settings& settings) {
  const StatementOutcome outcome = check_statement(statement, settings);
  std::vector<json> cells = outcome_cells(statement, outcome);
  for (std::size_t k = 0; has_indices(settings) && k < settings.parameters.size(); ++k)
    cells.push_back(index_of(statement, outcome, settings, k));
  return cells;
}

}  // namespace

ResultTable hold_against_paper(const ResultTable& results) {
  const Settings settings = gather_settings(results);
  ResultTable table{.columns = {"statement", "number", "text", "paper", "found_least", "found_largest",
                                "settings", "share", "holds"},
                    .rows = {},
                    .ended = results.ended};
  if (has_indices(settings))
    for (const std::string& parameter : settings.parameters) table.columns.push_back("index." + parameter);
  for (const Statement& statement : make_statements(velocities_of(settings)))
    table.rows.push_back(statement_cells(statement, settings));
  return table;
}

}  // namespace jobs
