// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/fits/fit_problem.h"
#include "jobs/fits/fitted_measurements.h"
#include "jobs/parameters/span.h"

namespace jobs {

/// Samples that tell their noise.
inline constexpr std::size_t kFewestForNoise = 50;

/// Channel of a measured run, beside the parameters of its jobs.
struct SignalSource {
  const FittedMeasurement& measurement;
  std::size_t run;     ///< in the measurement
  std::size_t column;  ///< of the channel
  const nlohmann::json& job_parameters;
  Span delays;  ///< of the sensor that the fit may find, [s]
};

/// Signal in the job's time, without its run's number, its cycle and the thinned samples. Its scale is the
/// noise, if given, else the standard deviation of the fitted samples, over the weight.
[[nodiscard]] FitSignal make_fit_signal(const SignalSource& source);

/// Reason why residuals of a signal have no scale; empty if they have one.
[[nodiscard]] std::string describe_scale_fault(const FitSignal& signal);

/// Samples per second of the jobs: a multiple of the measured ones if these are evenly spaced, so that jobs
/// have the same times; else ten times as many.
/// @param time_s  ascending, at least two
[[nodiscard]] double find_output_rate(const std::vector<double>& time_s);

}  // namespace jobs
