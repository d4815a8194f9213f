// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear_picture.h"

#include <algorithm>
#include <numbers>

#include "jobs/base/optional_json.h"
#include "jobs/base/time_text.h"
#include "jobs/results/resource_json.h"

namespace jobs {
namespace {

using nlohmann::json;

/// Where a bore is deepest; null where it is round.
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
      deepest.position_mm = rings == 1 ? 0.0 : length_mm * (static_cast<double>(r) / static_cast<double>(rings - 1) - 0.5);
      deepest.angle_rad = 2.0 * std::numbers::pi * (static_cast<double>(s) + 0.5) / static_cast<double>(depth[r].size());
    }
  }
  return deepest;
}

double calc_volume_mm3(const WearGrid& depth, const json& parameters) {
  double mean_sum_mm = 0.0;  // over the rings, of the mean depth around each
  for (const auto& ring : depth)
    for (const double d : ring) mean_sum_mm += 1e-3 * d / static_cast<double>(ring.size());
  const double length_mm = parameters.at("bearing_length_mm").get<double>() / static_cast<double>(depth.size());
  return mean_sum_mm * 2.0 * std::numbers::pi * parameters.at("bearing_radius_mm").get<double>() * length_mm;
}

/// The cells of kWearColumns.
std::vector<json> cells_of(const WearCycle& cycle, std::size_t number, const std::string& job_id, const WearStudyRequest& study) {
  const Deepest deepest = find_deepest(cycle.depth_um, study.completed.at("bearing_length_mm"));
  return {number, job_id, cycle.hours, cycle.step_hours, deepest.depth_um, deepest.position_mm, deepest.angle_rad,
          study.clearance_mm() + 1e-3 * deepest.depth_um, largest_of(cycle.rate_um_h), value_or_null(cycle.rate_change),
          calc_volume_mm3(cycle.depth_um, study.completed)};
}

}  // namespace

double calc_progress(const WearStudyRequest& study, const WearCourse& course) {
  if (course.cycles.empty()) return 0.0;
  const WearCycle& last = course.cycles.back();
  double progress = static_cast<double>(course.cycles.size()) / static_cast<double>(study.rule.cycles);
  if (study.rule.hours) progress = std::max(progress, last.hours / *study.rule.hours);
  if (study.rule.deepest_um) progress = std::max(progress, largest_of(last.depth_um) / *study.rule.deepest_um);
  return std::min(progress, 1.0);
}

namespace {

json cycles_json(const ResultTable& table, const WearCourse& course) {
  json cycles = json::array();
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    json cycle = json::object();
    for (std::size_t c = 0; c < kWearColumns.size(); ++c) cycle[table.columns[c]] = table.rows[k][c];
    cycle["wear_depth_um"] = course.cycles[k].depth_um;
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

}  // namespace

json wear_summary_json(const SearchRow& row) {
  const std::string self = "/v1/wear-studies/" + row.id;
  const auto request = nlohmann::ordered_json::parse(row.request);
  return {{"id", row.id}, {"name", row.name}, {"state", row.state}, {"error", value_or_null(row.error)}, {"sweep_id", row.sweep_id},
          {"hours", json(request.value("hours", nlohmann::ordered_json()))},
          {"worn_clearance_mm", json(request.value("worn_clearance_mm", nlohmann::ordered_json()))}, {"created_at", time_text(row.created_ms)},
          {"ended_at", row.ended_ms ? json(time_text(*row.ended_ms)) : json()},
          {"links", {{"self", self}, {"results", self + "/results"}, {"cancel", self + "/cancel"}, {"retry", self + "/retry"},
                     {"events", self + "/events"}, {"sweep", "/v1/sweeps/" + row.sweep_id}}}};
}

const std::vector<std::string>& wear_listing_keys() {
  static const std::vector<std::string> keys = [] {
    SearchRow row;
    row.request = "{}";
    std::vector<std::string> found;
    const json summary = wear_summary_json(row);
    for (const auto& [key, value] : summary.items()) found.push_back(key);
    return found;
  }();
  return keys;
}

json wear_study_json(const SearchRow& row, const WearStudyRequest& study, const SweepResults& results, const WearCourse& course, int threads) {
  json made = wear_summary_json(row);
  made["counts"] = progress_json(results.sweep, threads).at("counts");
  made["progress"] = row.state == "running" ? calc_progress(study, course) : 1.0;
  made["verdict"] = kWearVerdicts[static_cast<std::size_t>(course.verdict)];
  made["rejected_steps"] = course.rejected;
  made["cycles"] = cycles_json(wear_table(row, study, results, course), course);
  made["request"] = json::parse(row.request);
  return made;
}

ResultTable wear_table(const SearchRow& row, const WearStudyRequest& study, const SweepResults& results, const WearCourse& course) {
  const ResultTable jobs = result_table(results, {});
  ResultTable table{.columns = {kWearColumns.begin(), kWearColumns.end()}, .rows = {}, .ended = row.state != "running"};
  std::vector<std::size_t> metrics;
  for (const engine::QuantityInfo& metric : engine::metric_table()) {
    metrics.push_back(static_cast<std::size_t>(std::ranges::find(jobs.columns, metric.key) - jobs.columns.begin()));
    table.columns.push_back(metric.key);
  }
  for (const WearCycle& cycle : course.cycles) {
    const auto& job = jobs.rows.at(cycle.job);
    std::vector<json> cells = cells_of(cycle, table.rows.size() + 1, job.front().get<std::string>(), study);
    for (const std::size_t column : metrics) cells.push_back(job.at(column));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
