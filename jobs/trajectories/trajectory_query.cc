// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/trajectory_query.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/trajectories/decimate.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {

std::vector<std::string> wanted_channels(const std::vector<std::string>& asked) {
  if (asked.empty()) return {};
  std::vector<std::string> wanted{"t_s"};
  for (const std::string& channel : asked) {
    if (std::ranges::find(wanted, channel) == wanted.end()) wanted.push_back(channel);
  }
  return wanted;
}

namespace {

void check_channel_names(const std::vector<std::string>& channels,
                         const std::vector<std::string_view>& known, std::vector<Fault>& faults) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (std::ranges::find(known, channels[i]) != known.end()) continue;
    faults.push_back({"/channels/" + std::to_string(i),
                      "\"" + channels[i] + "\": " +
                          describe_unknown_key(channels[i], known, "GET /v1/jobs/{id}/trajectory")});
  }
}

/// @param wanted  how many channels there will be, the time among them
void check_points(std::size_t points, std::size_t wanted, std::vector<Fault>& faults) {
  const std::size_t channels = wanted == 0 ? 0 : wanted - 1;
  if (points >= fewest_points(channels)) return;
  faults.push_back({"/points", "must be at least " + std::to_string(fewest_points(channels)) +
                                   ", the ends and two for each of the " + std::to_string(channels) +
                                   " channels"});
}

/// @param trajectory  with t_s as its first column
void cut(const TrajectoryQuery& query, engine::Trajectory& trajectory) {
  if (trajectory.columns.empty()) return;
  const std::vector<double>& t = trajectory.columns.front();
  const auto begin = query.from ? std::ranges::lower_bound(t, *query.from) - t.begin() : std::ptrdiff_t{0};
  const auto end = query.to ? std::ranges::upper_bound(t, *query.to) - t.begin() : std::ssize(t);
  for (std::vector<double>& column : trajectory.columns)
    column = std::vector<double>(column.begin() + begin, column.begin() + std::max(begin, end));
}

}  // namespace

void check_query(const TrajectoryQuery& query, const std::vector<engine::QuantityInfo>& channels) {
  std::vector<std::string_view> known;
  for (const auto& channel : channels) known.push_back(channel.key);
  std::vector<Fault> faults;
  check_channel_names(query.channels, known, faults);
  if (query.from && std::isnan(*query.from)) faults.push_back({"/from", "must be a number"});
  if (query.to && std::isnan(*query.to)) faults.push_back({"/to", "must be a number"});
  if (query.from && query.to && *query.from > *query.to)
    faults.push_back({"/to", "must not be less than from"});
  if (query.points)
    check_points(*query.points,
                 query.channels.empty() ? known.size() : wanted_channels(query.channels).size(), faults);
  if (!faults.empty()) throw InvalidRequest(std::move(faults));
}

engine::Trajectory read_trajectory(std::span<const std::byte> blob, const TrajectoryQuery& query) {
  check_query(query, decode_channels(blob));
  engine::Trajectory trajectory = decode_trajectory(blob, wanted_channels(query.channels));
  cut(query, trajectory);
  if (query.points) decimate(*query.points, trajectory);
  return trajectory;
}

}  // namespace jobs
