// SPDX-License-Identifier: Apache-2.0
#include "jobs/sensitivity/sensitivity.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/base/optional_json.h"
#include "jobs/requests/sampled_designs.h"
#include "jobs/results/table_groups.h"
#include "jobs/statistics/effect_points.h"
#include "jobs/statistics/replicate_statistics.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kEffectCells = 5;
constexpr std::size_t kIndexCells = 6;

/// A sweep's design, its parameters in the order of the request: the resource has them in the order of the
/// alphabet, but lists what is swept in that of the request.
ordered_json design_of(const json& sweep) {
  const json given = sweep.at("request").value("design", json::object());
  const json type = given.value("type", json());
  if (type != "morris" && type != "saltelli")
    throw WrongState("the sweep has no design of type morris or saltelli");
  ordered_json design = ordered_json::object();
  for (const auto& [key, value] : given.items()) design[key] = value;
  design["over"] = ordered_json::object();
  for (const json& path : sweep.at("axes")) {
    if (given.at("over").contains(path))
      design["over"][path.get<std::string>()] = given.at("over").at(path.get<std::string>());
  }
  return design;
}

/// The response of one combination at the points of the design.
using Response = std::vector<ReplicateStatistics>;

/// @param replicates  column of the replicates' numbers: each point begins with its first; empty: a row a
/// point
Response response_of(const ResultTable& results, const RowGroup& group, std::size_t metric,
                     const std::optional<std::size_t>& replicates) {
  Response response;
  for (auto row = group.rows.begin(); row != group.rows.end();) {
    std::vector<double> values;
    do {
      if (const auto value = number_in(results.rows[*row][metric])) values.push_back(*value);
    } while (++row != group.rows.end() && replicates && results.rows[*row][*replicates] != 0);
    response.push_back(calc_replicate_statistics(values));
  }
  return response;
}

/// The blocks of the design in which every point has a value.
struct WholeBlocks {
  UnitPoints points;
  std::vector<double> values;
  /// Mean variance between replicates, of points with two values or more; empty: there are none such.
  std::optional<double> within;
  double of_means = 0.0;  ///< mean variance of their means by that alone
  std::size_t blocks = 0, missing = 0;
};

bool is_whole_block(const Response& response, std::size_t first, std::size_t width) {
  const auto points = std::span(response).subspan(first, width);
  return std::ranges::all_of(points, [](const ReplicateStatistics& point) { return point.mean.has_value(); });
}

void set_scatter(const Response& replicated, WholeBlocks& whole) {
  if (replicated.empty()) return;
  const auto count = static_cast<double>(replicated.size());
  whole.within = 0.0;
  for (const ReplicateStatistics& point : replicated) {
    const double share = *point.spread * *point.spread / count;
    *whole.within += share;
    whole.of_means += share / static_cast<double>(point.count);
  }
}

WholeBlocks whole_blocks_of(const UnitPoints& points, const Response& response, std::size_t width) {
  WholeBlocks whole;
  Response replicated;
  for (std::size_t first = 0; first < points.size(); first += width) {
    if (!is_whole_block(response, first, width)) {
      ++whole.missing;
      continue;
    }
    ++whole.blocks;
    for (std::size_t k = first; k < first + width; ++k) {
      whole.points.push_back(points[k]);
      whole.values.push_back(*response[k].mean);
      if (response[k].spread) replicated.push_back(response[k]);
    }
  }
  set_scatter(replicated, whole);
  return whole;
}

/// The part of a single run's variance that lies between replicates; null without them, or where nothing
/// varies. The means of the points vary by that, too.
json noise_of(const WholeBlocks& whole, const ReplicateStatistics& all) {
  if (!whole.within || !all.spread || *all.spread == 0.0) return nullptr;
  const double between = std::max(0.0, *all.spread * *all.spread - whole.of_means);
  return *whole.within / (*whole.within + between);
}

void append(const Estimate& estimate, std::vector<json>& cells) {
  for (const double value : {estimate.value, estimate.low, estimate.high}) cells.emplace_back(value);
}

std::vector<std::vector<json>> effect_cells(const WholeBlocks& whole) {
  std::vector<std::vector<json>> cells;
  for (const std::optional<ElementaryEffects>& effects :
       calc_elementary_effects(whole.points, whole.values)) {
    std::vector<json>& row = cells.emplace_back();
    if (!effects) {
      row.resize(kEffectCells);
      continue;
    }
    row.emplace_back(effects->mean);
    append(effects->mean_size, row);
    row.emplace_back(effects->deviation);
  }
  return cells;
}

std::vector<std::vector<json>> index_cells(const WholeBlocks& whole, std::size_t dimensions) {
  std::vector<std::vector<json>> cells;
  for (const SobolIndices& indices : calc_sobol_indices(whole.values, dimensions)) {
    cells.emplace_back();
    append(indices.first_order, cells.back());
    append(indices.total, cells.back());
  }
  return cells;
}

/// The cells of each parameter; nulls if there are too few blocks, or too few effects.
std::vector<std::vector<json>> measures_of(bool morris, const WholeBlocks& whole, std::size_t dimensions) {
  if (whole.blocks < 2)
    return std::vector<std::vector<json>>(dimensions, std::vector<json>(morris ? kEffectCells : kIndexCells));
  return morris ? effect_cells(whole) : index_cells(whole, dimensions);
}

void add_measure_columns(bool morris, std::vector<std::string>& columns) {
  columns.insert(columns.end(),
                 {"metric", "parameter", "blocks", "blocks_missing", "mean", "deviation", "noise"});
  if (morris) {
    columns.insert(columns.end(),
                   {"effect_mean", "effect_size", "effect_size_low", "effect_size_high", "effect_deviation"});
  } else {
    columns.insert(columns.end(), {"first_order", "first_order_low", "first_order_high", "total", "total_low",
                                   "total_high"});
  }
}

}  // namespace

ResultTable calc_sensitivity(const json& sweep, const ResultTable& results, const std::string& metric) {
  const std::size_t metric_column = find_metric(results, metric);
  const ordered_json design = design_of(sweep);
  const bool morris = design.at("type") == "morris";
  const UnitPoints points = effect_positions_of(design);
  const auto replicate = std::ranges::find(results.columns, "replicate");
  const std::optional<std::size_t> replicates =
      replicate == results.columns.end()
          ? std::nullopt
          : std::optional(static_cast<std::size_t>(replicate - results.columns.begin()));
  const std::size_t dimensions = design.at("over").size();
  ResultTable table{.columns = {}, .rows = {}, .ended = results.ended};
  std::vector<std::size_t> others;
  for (const json& path : sweep.at("axes")) {
    if (design.at("over").contains(path)) continue;
    table.columns.push_back(path.get<std::string>());
    others.push_back(find_column(results, path.get<std::string>(), ""));
  }
  add_measure_columns(morris, table.columns);
  for (const RowGroup& group : group_rows(results, others)) {
    Response response = response_of(results, group, metric_column, replicates);
    response.resize(points.size());  // cases that were added to the sweep follow
    const WholeBlocks whole = whole_blocks_of(points, response, dimensions + (morris ? 1 : 2));
    const ReplicateStatistics all = calc_replicate_statistics(whole.values);
    const auto measures = measures_of(morris, whole, dimensions);
    std::size_t input = 0;
    for (const auto& [path, range] : design.at("over").items()) {
      std::vector<json> cells = group.values;
      cells.insert(cells.end(), {metric, path, whole.blocks, whole.missing, value_or_null(all.mean),
                                 value_or_null(all.spread), noise_of(whole, all)});
      cells.insert(cells.end(), measures[input].begin(), measures[input].end());
      table.rows.push_back(std::move(cells));
      ++input;
    }
  }
  return table;
}

}  // namespace jobs
