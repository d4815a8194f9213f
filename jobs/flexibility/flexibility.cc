// SPDX-License-Identifier: Apache-2.0
#include "jobs/flexibility/flexibility.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/base/optional_json.h"
#include "jobs/requests/axis.h"
#include "jobs/results/table_groups.h"
#include "jobs/statistics/replicate_statistics.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr double kSame = 1e-3;  // accuracy of peaks: a ratio nearer to 1 shows no difference
constexpr const char* kLosses[] = {"friction_work_j", "impact_loss_j", "structural_loss_j"};

/// Axis of a sweep that makes a link rigid or flexible.
struct LinkAxis {
  std::string path;
  std::size_t column;
  json rigid, flexible;
};

bool is_elements_of_a_beam(const std::string& path) {
  return path.starts_with("linkage.bodies.") && path.ends_with(".beam.elements");
}

/// An axis of beams: 1 and another number.
std::optional<LinkAxis> find_beam_axis(const std::string& path, const ResultTable& results) {
  LinkAxis axis{.path = path, .column = find_column(results, path, ""), .rigid = 1, .flexible = {}};
  bool has_rigid = false;
  for (const auto& row : results.rows) {
    const json& elements = row[axis.column];
    if (elements.is_null()) continue;  // of another linkage
    if (elements == 1) has_rigid = true;
    else if (axis.flexible.is_null()) axis.flexible = elements;
    else if (axis.flexible != elements) return std::nullopt;
  }
  return has_rigid && !axis.flexible.is_null() ? std::optional(axis) : std::nullopt;
}

LinkAxis find_link_axis(const json& sweep, const ResultTable& results) {
  for (const json& axis : sweep.at("axes")) {
    const auto path = axis.get<std::string>();
    if (path == "coupler") return {path, find_column(results, path, ""), "rigid", "flexible"};
    if (!is_elements_of_a_beam(path)) continue;
    if (auto found = find_beam_axis(path, results)) return std::move(*found);
  }
  throw WrongState(
      "the sweep has no rigid and flexible jobs to pair: it varies neither the coupler nor, between 1 and "
      "one other number, the elements of a beam");
}

/// The values of a column in those rows of a group whose link is this one.
std::vector<double> values_of(const ResultTable& results, const RowGroup& group, const LinkAxis& link,
                              const json& which, std::size_t column) {
  std::vector<double> values;
  for (const std::size_t r : group.rows) {
    if (results.rows[r][link.column] != which) continue;
    if (const auto value = number_in(results.rows[r][column])) values.push_back(*value);
  }
  return values;
}

/// Both links at one combination.
struct Pair {
  ReplicateStatistics rigid, flexible;
  std::optional<double> ratio, least, largest;
};

Pair pair_of(const ResultTable& results, const RowGroup& group, const LinkAxis& link, std::size_t metric) {
  Pair pair{.rigid = calc_replicate_statistics(values_of(results, group, link, link.rigid, metric)),
            .flexible = calc_replicate_statistics(values_of(results, group, link, link.flexible, metric)),
            .ratio = {},
            .least = {},
            .largest = {}};
  // Ratios of signs say nothing
  const bool comparable = pair.rigid.count > 0 && pair.flexible.count > 0 && *pair.rigid.min > 0.0;
  if (!comparable) return pair;
  pair.ratio = *pair.flexible.mean / *pair.rigid.mean;
  pair.least = *pair.flexible.min / *pair.rigid.max;
  pair.largest = *pair.flexible.max / *pair.rigid.min;
  return pair;
}

/// @returns whether the scatter of a pair is known
bool has_replicates(const Pair& pair) { return pair.rigid.count > 1 && pair.flexible.count > 1; }

/// Side of 1 on which every ratio of a pair is: -1, 1, or 0 if they make no difference, are on both sides, or
/// their scatter is not known.
int side_of(const Pair& pair) {
  if (!pair.ratio || !has_replicates(pair)) return 0;
  return *pair.largest < 1.0 - kSame ? -1 : *pair.least > 1.0 + kSame ? 1 : 0;
}

json verdict_of(const Pair& pair) {
  if (!pair.ratio) return nullptr;
  if (!has_replicates(pair)) return "one_run_each";
  const int side = side_of(pair);
  return side < 0 ? "helps" : side > 0 ? "harms" : "either";
}

/// The structural loss, and its part of all losses, on the mean over the flexible jobs.
std::pair<json, json> structural_loss_of(const ResultTable& results, const RowGroup& group,
                                         const LinkAxis& link) {
  double all = 0.0;
  std::optional<double> taken;
  for (const char* const loss : kLosses) {
    const auto mean = calc_replicate_statistics(
                          values_of(results, group, link, link.flexible, find_column(results, loss, "")))
                          .mean;
    if (mean) all += *mean;
    taken = mean;  // the last one is structural
  }
  if (!taken) return {nullptr, nullptr};
  return {*taken, all > 0.0 ? json(*taken / all) : json()};
}

/// Groups in the order of their values along a column.
using GroupLine = std::map<double, std::size_t>;

/// The groups with ratios, in lines along a column; all else is equal in a line.
std::map<json, GroupLine> find_lines(const std::vector<RowGroup>& groups, const std::vector<Pair>& pairs,
                                     std::size_t along) {
  std::map<json, GroupLine> lines;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto x = number_in(groups[g].values[along]);  // jobs of another linkage may have none
    if (!pairs[g].ratio || !x) continue;
    json others = groups[g].values;
    others.erase(along);
    lines[others][*x] = g;
  }
  return lines;
}

void find_reversals_in(const GroupLine& line, const std::vector<Pair>& pairs, std::vector<json>& reversals) {
  int last_side = 0;
  double last_x = 0.0;
  for (const auto& [x, group] : line) {
    const int side = side_of(pairs[group]);
    if (side == 0) continue;
    if (side == -last_side) reversals[group] = last_x;
    last_side = side;
    last_x = x;
  }
}

/// For each group the last value before it along a column at which every ratio was on one side of 1, if all
/// are on the other side here.
std::vector<json> find_reversals(const std::vector<RowGroup>& groups, const std::vector<Pair>& pairs,
                                 std::optional<std::size_t> along) {
  std::vector<json> reversals(groups.size());
  if (!along) return reversals;
  for (const auto& [others, line] : find_lines(groups, pairs, *along))
    find_reversals_in(line, pairs, reversals);
  return reversals;
}

void append(const ReplicateStatistics& statistics, std::vector<json>& cells) {
  cells.insert(cells.end(),
               {statistics.count, value_or_null(statistics.mean), value_or_null(statistics.spread),
                value_or_null(statistics.min), value_or_null(statistics.max)});
}

}  // namespace

ResultTable compare_links(const json& sweep, const ResultTable& results, const std::string& metric) {
  const std::size_t metric_column = find_metric(results, metric);
  const LinkAxis link = find_link_axis(sweep, results);
  ResultTable table{.columns = {}, .rows = {}, .ended = results.ended};
  std::vector<std::size_t> columns;
  std::optional<std::size_t> along;
  for (const json& axis : sweep.at("axes")) {
    const auto path = axis.get<std::string>();
    if (path == link.path) continue;
    if (!along && is_numeric(path)) along = columns.size();
    columns.push_back(find_column(results, path, ""));
    table.columns.push_back(path);
  }
  const std::string along_name = along ? table.columns[*along] : "";
  table.columns.insert(table.columns.end(),
                       {"metric", "ratio", "ratio_least", "ratio_largest", "verdict", "along",
                        "reverses_from", "coupler_loss_j", "coupler_loss_part"});
  for (const std::string which : {"rigid", "flexible"}) {
    for (const char* const part : {"_count", "_mean", "_spread", "_min", "_max"})
      table.columns.push_back(which + part);
  }
  const auto groups = group_rows(results, columns);
  std::vector<Pair> pairs;
  for (const RowGroup& group : groups) pairs.push_back(pair_of(results, group, link, metric_column));
  const auto reversals = find_reversals(groups, pairs, along);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Pair& pair = pairs[g];
    const auto [loss, part] = structural_loss_of(results, groups[g], link);
    std::vector<json> cells = groups[g].values;
    cells.insert(cells.end(),
                 {metric, value_or_null(pair.ratio), value_or_null(pair.least), value_or_null(pair.largest),
                  verdict_of(pair), along ? json(along_name) : json(), reversals[g], loss, part});
    append(pair.rigid, cells);
    append(pair.flexible, cells);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
