// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear_json.h"

#include <algorithm>
#include <numbers>

#include "jobs/base/optional_json.h"
#include "jobs/results/resource_json.h"
#include "jobs/wear/wear.h"

namespace jobs {
namespace {

using nlohmann::json;

/// Deepest point of a bore; null in a round one.
struct Deepest {
  double depth_um = 0.0;
  json position_mm, angle_rad;
};

Deepest find_deepest(const WearGrid& depth, double length_mm) {
  Deepest deepest;
  const std::size_t rings = depth.size();
  for (std::size_t r = 0; r < rings; ++r) {
    for (std::size_t s = 0; s < depth[r].size(); ++s) {
      if (depth[r][s] <= deepest.depth_um) continue;
      deepest.depth_um = depth[r][s];
      deepest.position_mm = ring_position_mm(r, rings, length_mm);
      deepest.angle_rad =
          2.0 * std::numbers::pi * (static_cast<double>(s) + 0.5) / static_cast<double>(depth[r].size());
    }
  }
  return deepest;
}

double calc_volume_mm3(const WearGrid& depth, const json& parameters) {
  double mean_sum_mm = 0.0;  // over the rings, of the mean depth around each
  for (const auto& ring : depth)
    for (const double d : ring) mean_sum_mm += 1e-3 * d / static_cast<double>(ring.size());
  const double length_mm =
      parameters.at("bearing_length_mm").get<double>() / static_cast<double>(depth.size());
  return mean_sum_mm * 2.0 * std::numbers::pi * parameters.at("bearing_radius_mm").get<double>() * length_mm;
}

/// The cells of kWearColumns.
std::vector<json> cells_of(const WearCycle& cycle, std::size_t number, const std::string& job_id,
                           const WearStudyRequest& study) {
  const Deepest deepest = find_deepest(cycle.depth_um, study.completed.at("bearing_length_mm"));
  return {number, job_id, cycle.hours, cycle.step_hours, deepest.depth_um, deepest.position_mm,
          deepest.angle_rad, study.clearance_mm() + 1e-3 * deepest.depth_um, largest_of(cycle.rate_um_h),
          value_or_null(cycle.rate_change), calc_volume_mm3(cycle.depth_um, study.completed)};
}

}  // namespace

double calc_progress(const WearStudyRequest& study, const WearHistory& history) {
  if (history.cycles.empty()) return 0.0;
  const WearCycle& last = history.cycles.back();
  double progress = static_cast<double>(history.cycles.size()) / static_cast<double>(study.rule.cycles);
  if (study.rule.hours) progress = std::max(progress, last.hours / *study.rule.hours);
  if (study.rule.deepest_um) {
    progress = std::max(progress, largest_of(last.depth_um) / *study.rule.deepest_um);
  }
  return std::min(progress, 1.0);
}

namespace {

json cycles_json(const ResultTable& table, const WearHistory& history) {
  json cycles = json::array();
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    json cycle = json::object();
    for (std::size_t c = 0; c < kWearColumns.size(); ++c) cycle[table.columns[c]] = table.rows[k][c];
    cycle["wear_depth_um"] = history.cycles[k].depth_um;
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

/// Column of each metric in a table of jobs.
std::vector<std::size_t> find_metric_columns(const ResultTable& jobs) {
  std::vector<std::size_t> columns;
  for (const engine::QuantityInfo& metric : engine::metric_table())
    columns.push_back(
        static_cast<std::size_t>(std::ranges::find(jobs.columns, metric.key) - jobs.columns.begin()));
  return columns;
}

}  // namespace

json wear_summary_json(const StudyRow& row) {
  const json request = json::parse(row.request);
  json made = study_json(row, "/v1/wear-studies/");
  for (const char* const end : {"hours", "worn_clearance_mm"}) made[end] = request.value(end, json());
  return made;
}

const std::vector<std::string>& wear_listing_keys() {
  static const std::vector<std::string> keys = [] {
    StudyRow row;
    row.request = "{}";
    return keys_of(wear_summary_json(row));
  }();
  return keys;
}

json wear_study_json(const StudyRow& row, const WearStudyRequest& study, const SweepResults& results,
                     const WearHistory& history, int threads) {
  json made = wear_summary_json(row);
  made["counts"] = progress_json(results.sweep, threads).at("counts");
  made["progress"] = row.state == "running" ? calc_progress(study, history) : 1.0;
  made["verdict"] = kWearVerdicts[static_cast<std::size_t>(history.verdict)];
  made["rejected_steps"] = history.rejected;
  made["cycles"] = cycles_json(wear_table(row, study, results, history), history);
  made["request"] = json::parse(row.request);
  return made;
}

ResultTable wear_table(const StudyRow& row, const WearStudyRequest& study, const SweepResults& results,
                       const WearHistory& history) {
  const ResultTable jobs = result_table(results, {});
  ResultTable table{.columns = {kWearColumns.begin(), kWearColumns.end()}, .rows = {},
                    .ended = row.state != "running"};
  for (const engine::QuantityInfo& metric : engine::metric_table()) table.columns.push_back(metric.key);
  const std::vector<std::size_t> metrics = find_metric_columns(jobs);
  for (const WearCycle& cycle : history.cycles) {
    const auto& job = jobs.rows.at(cycle.job);
    std::vector<json> cells = cells_of(cycle, table.rows.size() + 1, job.front().get<std::string>(), study);
    for (const std::size_t column : metrics) cells.push_back(job.at(column));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
