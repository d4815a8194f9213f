// SPDX-License-Identifier: Apache-2.0
#include "jobs/motion/poincare.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/results/table_groups.h"

namespace jobs {

engine::Trajectory take_section(const engine::Trajectory& run, double phase) {
  const auto angle_at =
      std::ranges::find(run.channels, "crank_angle_rad", &engine::QuantityInfo::key) - run.channels.begin();
  const std::vector<double>& t = run.columns.at(0);
  const std::vector<double>& angle = run.columns.at(static_cast<std::size_t>(angle_at));
  engine::Trajectory section;
  section.channels = {run.channels[0], {.key = "turn", .help = "turns of the crank since its place at rest"}};
  std::vector<const std::vector<double>*> others;
  for (std::size_t c = 1; c < run.columns.size(); ++c) {
    if (static_cast<std::ptrdiff_t>(c) == angle_at) continue;
    section.channels.push_back(run.channels[c]);
    others.push_back(&run.columns[c]);
  }
  section.columns.resize(section.channels.size());
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double before = (angle[k - 1] - phase) / (2.0 * std::numbers::pi);
    const double after = (angle[k] - phase) / (2.0 * std::numbers::pi);
    // The whole number in (before, after], or in [after, before) of a crank that turns back.
    const double turn = after > before ? std::floor(after) : std::ceil(after);
    if (after == before || (after > before ? turn <= before : turn >= before)) continue;
    const double part = (turn - before) / (after - before);
    section.columns[0].push_back(std::lerp(t[k - 1], t[k], part));
    section.columns[1].push_back(turn);
    for (std::size_t c = 0; c < others.size(); ++c)
      section.columns[c + 2].push_back(std::lerp((*others[c])[k - 1], (*others[c])[k], part));
  }
  return section;
}

ResultTable make_bifurcation(const nlohmann::json& axes, const ResultTable& results,
                             const BifurcationQuery& query, const FindTrajectory& find) {
  if (results.rows.size() > kMostJobsOfDiagram) {
    throw WrongState("the sweep has " + std::to_string(results.rows.size()) + " jobs; a diagram is made of " +
                     std::to_string(kMostJobsOfDiagram) + " at most");
  }
  if (query.channel == "t_s" || query.channel == "crank_angle_rad") {
    throw InvalidRequest(std::vector<Fault>{
        {"/channel", "must be a channel other than t_s and crank_angle_rad, which define the section"}});
  }
  ResultTable table{.columns = axes.get<std::vector<std::string>>(), .rows = {}, .ended = results.ended};
  std::vector<std::size_t> swept;
  for (const std::string& path : table.columns) swept.push_back(find_column(results, path, ""));
  const std::size_t run_up = find_column(results, "run_up_s", "");
  const std::size_t job = find_column(results, "job_id", "");
  table.columns.insert(table.columns.end(), {"job_id", "t_s", query.channel});
  for (const auto& row : results.rows) {
    const TrajectoryQuery wanted{.channels = {query.channel, "crank_angle_rad"},
                                 .from = query.from ? *query.from : row[run_up].get<double>(),
        .to = {}};
    const auto run = find(row[job].get<std::string>(), wanted);
    if (!run) continue;
    const engine::Trajectory section = take_section(*run, query.phase);
    for (std::size_t k = 0; k < section.columns[0].size(); ++k) {
      std::vector<nlohmann::json> cells;
      for (const std::size_t column : swept) cells.push_back(row[column]);
      const double value = section.columns.back()[k];
      cells.insert(cells.end(), {row[job], section.columns[0][k],
                                 std::isfinite(value) ? nlohmann::json(value) : nlohmann::json()});
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

}  // namespace jobs
