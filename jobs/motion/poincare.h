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

/// Channels of a Poincare section.
struct SectionChannels {
  std::string angle;                ///< its passages make the section
  std::vector<std::string> wanted;  ///< of the section
  std::vector<std::string> read;    ///< these, the angle, and the derivatives of both that a run keeps
};

/// @param kept    channels of the run
/// @param angle   empty: the crank's, of a described linkage that of the first freedom that turns
/// @param wanted  empty: the journal's position, of a described linkage that in its first joint with
///     clearance, or else the first freedom beside the angle, and its rate
/// @throws InvalidRequest ("/angle"); WrongState if the linkage has no such channels
[[nodiscard]] SectionChannels choose_section(const std::vector<std::string>& kept, const std::string& angle,
                                             std::vector<std::string> wanted);

/// The state of a run once a turn, whenever the crank, or another freedom that turns, passes an angle.
/// Instant and state are those of polynomials through the samples and their stored derivatives: the error
/// falls with the 4th power of the sampling interval, of a position with rate and acceleration with the 6th
/// (as far as the instant is right), of forces, accelerations and velocities without derivatives with the
/// 2nd.
/// Source: M. Henon, On the numerical computation of Poincare maps, Physica D 5 (1982) 412-414, asks for the
/// crossing to the accuracy of the integration; here as accurately as samples allow.
/// @param run  t_s first, and the channels to read
/// @param phase  the angle, [rad]
/// @returns t_s, turn (its number, from the place at rest) and what else is wanted; a row a turn
[[nodiscard]] engine::Trajectory take_section(const engine::Trajectory& run, const SectionChannels& channels,
                                              double phase);

/// Access to the runs of a sweep's jobs, by a job's id.
struct RunReader {
  /// Channels of a query; empty if the job has no trajectory.
  std::function<std::optional<engine::Trajectory>(const std::string&, const TrajectoryQuery&)> find;
  /// Names of all channels; none of a job that is not there.
  std::function<std::vector<std::string>(const std::string&)> list_channels;
};

/// Query of a bifurcation diagram.
struct BifurcationQuery {
  std::string channel{};       ///< empty: as choose_section() chooses
  std::string angle{};         ///< the same
  double phase = 0.0;          ///< of the angle, [rad]
  std::optional<double> from;  ///< [s]; empty: from the end of each job's run-up on
};

inline constexpr std::size_t kMostJobsOfDiagram = 1000;

/// A channel once a turn for all jobs of a sweep: rows of what is swept, job_id, t_s and the channel.
/// @param results  rows with job_id, the columns of `axes` and run_up_s
/// @throws InvalidRequest ("/channel", and what the reader throws); WrongState if there are more than
///     kMostJobsOfDiagram rows, and what choose_section() throws
[[nodiscard]] ResultTable make_bifurcation(const nlohmann::json& axes, const ResultTable& results,
                                           const BifurcationQuery& query, const RunReader& reader);

}  // namespace jobs
