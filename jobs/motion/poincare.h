// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"
#include "jobs/trajectories/trajectory_query.h"

namespace jobs {

/// Channels that take_section needs for those that are wanted: these, crank_angle_rad, and the derivatives
/// that a run keeps of both.
[[nodiscard]] std::vector<std::string> section_channels(std::vector<std::string> wanted);

/// The state of a run once a turn, whenever the crank passes an angle. Instant and state are those of
/// polynomials through the samples and their stored derivatives: the error falls with the 4th power of the
/// sampling interval, of a position with rate and acceleration with the 6th (as far as the instant is right),
/// of forces, accelerations and velocities without derivatives with the 2nd.
/// Source: M. Henon, On the numerical computation of Poincare maps, Physica D 5 (1982) 412-414, asks for the
/// crossing to the accuracy of the integration; here as accurately as samples allow.
/// @param run  t_s first, crank_angle_rad, what else is wanted, and derivatives of these if there are any
/// @param phase  the angle, [rad]
/// @param wanted  channels; empty: all of the run's
/// @returns t_s, turn (its number, from the crank's place at rest) and what else was wanted; a row a turn
[[nodiscard]] engine::Trajectory take_section(const engine::Trajectory& run, double phase,
                                              const std::vector<std::string>& wanted = {});

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
