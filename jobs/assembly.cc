// SPDX-License-Identifier: Apache-2.0
#include "jobs/assembly.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/simulate_linkage.h"
#include "jobs/base/errors.h"
#include "jobs/requests/parameters.h"
#include "jobs/runs/run_record.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::string_view kPosePrefix = "pose_";
constexpr std::array<std::string_view, 7> kPoseParts{"_x_m", "_y_m", "_z_m", "_qx", "_qy", "_qz", "_qw"};

/// Part of a pose that a channel is, by its index in kPoseParts.
std::optional<std::size_t> part_of_pose(std::string_view channel) {
  if (!channel.starts_with(kPosePrefix)) return std::nullopt;
  for (std::size_t i = 0; i < kPoseParts.size(); ++i)
    if (channel.ends_with(kPoseParts[i])) return i;
  return std::nullopt;
}

json poses_json(const engine::Trajectory& trajectory) {
  json poses = json::object();
  for (std::size_t c = 0; c < trajectory.channels.size(); ++c) {
    const std::string_view channel = trajectory.channels[c].key;
    const auto part = part_of_pose(channel);
    if (!part || trajectory.columns[c].empty()) continue;
    const std::string link(
        channel.substr(kPosePrefix.size(), channel.size() - kPosePrefix.size() - kPoseParts[*part].size()));
    poses[link][*part] = trajectory.columns[c].front();
  }
  return poses;
}

}  // namespace

json find_assembly(const json& parameters) {
  JobSpec spec = to_job_spec(complete_parameters(parameters, "/parameters"));
  constexpr double kMoment = 1e-6;  // [s]
  spec.options.duration = kMoment;
  spec.parameters.run_up = 0.5 * kMoment;
  const RunRecord run = run_and_record(spec, engine_runner(), [](double) { return false; });
  if (run.trajectory.columns.empty() || run.trajectory.columns.front().empty())
    throw InvalidRequest(std::vector<Fault>{{"/parameters", run.error_detail}});
  return {
      {"poses", poses_json(run.trajectory)},
      {"undriven_freedoms", spec.linkage ? json(engine::count_undriven_freedoms(*spec.linkage)) : json()}};
}

}  // namespace jobs
