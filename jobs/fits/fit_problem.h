// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/fits/divergence.h"
#include "jobs/fits/observation.h"
#include "jobs/parameters/span.h"

namespace jobs {

/// Quantity of a sensor that a fit may find.
enum class SensorQuantity { kGain, kOffset, kDelay };

/// Parameter that a fit looks for: one of jobs, or one of a channel's sensor.
struct FitParameter {
  std::string path;  ///< "clearance_mm", "runs.1.crank_velocity_rad_s", "sensor.slider_position_m.gain"
  Span span;
  std::optional<double> start{};
  std::string name{};  ///< of the job's parameter or of the sensor's channel
  std::optional<SensorQuantity> sensor{};
  std::optional<std::size_t> run{};  ///< the only run that has it; empty: all have
};

/// Run of a measurement. Each point of a fit has one job for it.
struct FitRun {
  std::string measurement_id;
  std::size_t number = 0;  ///< in the measurement, from 0
  /// By path, of its own; every run has the same paths
  std::vector<std::pair<std::string, nlohmann::json>> parameters{};
};

/// Signal of one channel in one run. Times are those of the job.
struct FitSignal {
  std::size_t run = 0;  ///< index in FitProblem::runs
  std::string channel;
  std::size_t first_sample = 0;  ///< of the measured run, of those that follow
  MeasuredSignal measured;  ///< all samples within the job, with the windows
  MeasuredSignal compared;  ///< the fitted samples, thinned
  SensorModel sensor;       ///< without what the fit finds
  double noise = 0.0;       ///< standard deviation, in the unit of the channel
  std::size_t noise_samples = 0;  ///< the noise is estimated from; 0: it is given, or unknown
  double weight = 1.0;      ///< of its residuals; measured.sigma holds it, too
  double cycle_s = 0.0;     ///< of features: period of the drive, or a part of the samples
};

/// Search for values of parameters with which jobs give measured signals.
struct FitProblem {
  nlohmann::ordered_json common_sweep;  ///< sweep of its jobs, without cases
  std::vector<FitParameter> parameters;
  std::vector<FitRun> runs;
  std::vector<FitSignal> signals;
  std::optional<FitBasis> basis{};  ///< empty: chosen by divergence
  std::size_t replicates = 4;       ///< of each point in least squares by features
  std::size_t budget = 0;           ///< most points, replicates among them
  std::size_t population = 0;       ///< points of a generation of the population search
  std::uint64_t seed = 1;
  bool profiles = true;      ///< whether intervals come from the profile likelihood, too
  std::size_t thinning = 1;  ///< one of so many measured samples is compared
};

}  // namespace jobs
