// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"
#include "jobs/trajectories/trajectory_query.h"

namespace jobs {

/// The state of a run once a turn, whenever the crank passes an angle: linear between the samples around that
/// instant.
/// @param run  t_s first, crank_angle_rad, and what else is wanted
/// @param phase  the angle, [rad]
/// @returns t_s, turn (its number, from the crank's place at rest) and what else was wanted; a row a turn
[[nodiscard]] engine::Trajectory take_section(const engine::Trajectory& run, double phase);

/// Finds channels of a job; empty if it has none.
using FindTrajectory =
    std::function<std::optional<engine::Trajectory>(const std::string& job_id, const TrajectoryQuery& query)>;

/// Query of a bifurcation diagram.
struct BifurcationQuery {
  std::string channel = "journal_x_mm";
  double phase = 0.0;          ///< of the crank, [rad]
  std::optional<double> from;  ///< [s]; empty: from the end of each job's run-up on
};

inline constexpr std::size_t kMostJobsOfDiagram = 1000;

/// A channel once a turn for all jobs of a sweep: rows of what is swept, job_id, t_s and the channel.
/// @param results  rows with job_id, the columns of `axes` and run_up_s
/// @throws InvalidRequest ("/channel", and what find throws); WrongState if there are more than
///     kMostJobsOfDiagram rows
[[nodiscard]] ResultTable make_bifurcation(const nlohmann::json& axes, const ResultTable& results,
                                           const BifurcationQuery& query, const FindTrajectory& find);

}  // namespace jobs
