// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/table_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "jobs/base/errors.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/parameter_path.h"

namespace jobs {
namespace {

/// The columns that are results: neither what tells jobs apart nor what was given.
std::vector<std::string_view> metrics_of(const ResultTable& table) {
  constexpr std::array<std::string_view, 3> kOfJobs{"job_id", "state", "replicate"};
  const auto& parameters = known_paths();
  std::vector<std::string_view> metrics;
  for (const std::string& column : table.columns) {
    const bool given = is_varied_by_cases(column) || is_path_in_description(column) ||
                       std::ranges::find(parameters, column) != parameters.end();
    if (!given && std::ranges::find(kOfJobs, column) == kOfJobs.end()) metrics.emplace_back(column);
  }
  return metrics;
}

/// @returns whether values of a column differ by more than rounding
bool varies(const ResultTable& table, std::size_t column) {
  std::optional<double> least, most;
  for (const auto& row : table.rows) {
    const auto value = number_in(row[column]);
    if (!value) continue;
    least = std::min(*value, least.value_or(*value));
    most = std::max(*value, most.value_or(*value));
  }
  return least && *most - *least > 1e-9 * std::max(std::abs(*least), std::abs(*most));
}

/// Time of a peak, by the end of its name.
bool is_time(std::string_view metric) { return metric.ends_with("_time_s"); }

/// Adds the coordinates that move by a law in the linkage that parameters describe, if they do: "crank", or
/// "guide_slide" of several freedoms.
void add_driven_coordinates(const nlohmann::json& parameters, std::vector<std::string>& driven) {
  const auto joints = nlohmann::json::json_pointer("/linkage/joints");
  if (!parameters.contains(joints)) return;
  const auto law = nlohmann::json::json_pointer("/drive/law");
  for (const auto& [name, joint] : parameters.at(joints).items()) {
    if (joint.contains(law)) driven.push_back(name);
    const auto freedoms = joint.value("freedoms", nlohmann::json::object());
    for (const auto& [part, freedom] : freedoms.items())
      if (freedom.contains(law)) driven.push_back(name + "_" + part);
  }
}

/// The same of a sweep's parameters and of all its cases.
std::vector<std::string> driven_coordinates(const nlohmann::json& sweep) {
  std::vector<std::string> driven;
  if (!sweep.contains("request")) return driven;
  const nlohmann::json& request = sweep.at("request");
  add_driven_coordinates(request.value("parameters", nlohmann::json::object()), driven);
  for (const auto& each : request.value("cases", nlohmann::json::array()))
    add_driven_coordinates(each, driven);
  return driven;
}

/// The metrics that vary, but those of coordinates that move by a law, and times.
std::vector<std::string> free_metrics(const nlohmann::json& sweep, const ResultTable& table) {
  const std::vector<std::string> driven = driven_coordinates(sweep);
  std::vector<std::string> free;
  for (const std::string_view metric : metrics_of(table)) {
    const auto is_of = [&](const std::string& coordinate) {
      return metric.starts_with("peak_" + coordinate + "_acceleration") ||
             metric.starts_with("rms_" + coordinate + "_acceleration");
    };
    if (is_time(metric) || std::ranges::any_of(driven, is_of)) continue;
    if (varies(table, find_column(table, std::string(metric), ""))) free.emplace_back(metric);
  }
  return free;
}

}  // namespace

std::size_t find_column(const ResultTable& table, const std::string& name, const std::string& pointer) {
  const auto found = std::ranges::find(table.columns, name);
  if (found != table.columns.end()) return static_cast<std::size_t>(found - table.columns.begin());
  const std::vector<std::string_view> known(table.columns.begin(), table.columns.end());
  throw InvalidRequest(
      std::vector<Fault>{{pointer, "\"" + name + "\": " + describe_unknown_key(name, known)}});
}

std::vector<RowGroup> group_rows(const ResultTable& table, const std::vector<std::size_t>& columns) {
  std::vector<RowGroup> groups;
  std::map<nlohmann::json, std::size_t> indices;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    nlohmann::json values = nlohmann::json::array();
    for (const std::size_t column : columns) values.push_back(table.rows[r][column]);
    const auto [index, is_new] = indices.try_emplace(values, groups.size());
    if (is_new) groups.push_back({.values = values.get<std::vector<nlohmann::json>>(), .rows = {}});
    groups[index->second].rows.push_back(r);
  }
  return groups;
}

std::string choose_metric(const ResultTable& table, const std::string& wanted) {
  const auto metrics = metrics_of(table);
  const std::string usual(kReplicateMetric);
  const bool has_usual = std::ranges::find(metrics, usual) != metrics.end();
  if (wanted.empty() && !metrics.empty()) return has_usual ? usual : std::string(metrics.front());
  if (std::ranges::find(metrics, wanted) != metrics.end()) return wanted;
  std::string known;
  for (const std::string_view metric : metrics) known += (known.empty() ? "" : ", ") + std::string(metric);
  throw InvalidRequest(
      std::vector<Fault>{{"/metric", "\"" + wanted + "\" is no metric of this sweep, which has " + known}});
}

std::string choose_free_metric(const nlohmann::json& sweep, const ResultTable& table,
                               const std::string& wanted) {
  std::string usual = choose_metric(table, wanted);
  if (!wanted.empty() || usual == kReplicateMetric) return usual;
  const std::vector<std::string> free = free_metrics(sweep, table);
  const auto acceleration = std::ranges::find_if(
      free, [](const std::string& metric) { return metric.find("_acceleration_") != std::string::npos; });
  if (acceleration != free.end()) return *acceleration;
  return free.empty() ? usual : free.front();
}

std::vector<std::string> choose_metrics(const ResultTable& table, std::span<const std::string_view> wanted) {
  const auto metrics = metrics_of(table);
  const auto has = [&](std::string_view metric) {
    return std::ranges::find(metrics, metric) != metrics.end();
  };
  std::vector<std::string> chosen;
  if (!has(wanted.front())) {
    for (const std::string_view metric : metrics)
      if (!is_time(metric) && chosen.size() < wanted.size()) chosen.emplace_back(metric);
    return chosen;
  }
  for (const std::string_view metric : wanted) {
    if (has(metric)) chosen.emplace_back(metric);
  }
  return chosen;
}

std::size_t find_metric(const ResultTable& table, const std::string& metric) {
  return find_column(table, choose_metric(table, metric), "/metric");
}

std::optional<double> number_in(const nlohmann::json& cell) {
  return cell.is_number() ? std::optional(cell.get<double>()) : std::nullopt;
}

}  // namespace jobs
