// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace jobs {

/// Channel that was measured: name, and correction of its sensor. Samples are kept as they were sent. The
/// corrected signal at time t is sign * gain * x(t + delay_s) + offset.
struct MeasuredChannel {
  std::string name;                     ///< of the trajectory's channel, which ends in the unit
  std::string column;                   ///< its name in the file
  double sign = 1.0;                    ///< 1 or -1: direction of the sensor's axis
  double gain = 1.0;                    ///< > 0
  double offset = 0.0;                  ///< in the unit of the channel
  double delay_s = 0.0;                 ///< of the signal behind the motion, [s]
  std::optional<double> low_pass_hz{};  ///< cut-off frequency of the sensor; empty: unknown or none
};

/// Samples of one run of the machine.
struct MeasuredRun {
  nlohmann::json parameters = nlohmann::json::object();  ///< those of a job that are known of the run
  std::vector<double> time_s;                ///< strictly increasing, at least kFewestMeasuredSamples
  std::vector<std::vector<double>> columns;  ///< one a channel, each as long as time_s; finite
};

/// Measurement: signals of one or several runs, with the same channels.
struct Measurement {
  std::string name;
  std::vector<MeasuredChannel> channels;
  std::vector<MeasuredRun> runs;
};

inline constexpr const char* kTimeColumn = "time_s";
/// Name of the time in trajectories. Files may use it, too.
inline constexpr const char* kTrajectoryTime = "t_s";
inline constexpr std::size_t kFewestMeasuredSamples = 2;
inline constexpr std::size_t kMostMeasuredChannels = 200;
inline constexpr std::size_t kMostMeasuredColumns = 1000;  ///< of a file, chosen or not
inline constexpr std::size_t kMostMeasuredRuns = 1000;
/// Numbers of a measurement, times among them: 64 MB.
inline constexpr std::size_t kMostMeasuredValues = 8'000'000;

}  // namespace jobs
