// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "jobs/fits/fit_request.h"
#include "jobs/studies/study_runner.h"

namespace jobs {

class SweepReader;

/// Fits: values of parameters with which jobs give measured signals. See parse_fit_request() and FitSampler.
/// @param reader  of the trajectories that are compared; outlives the result
[[nodiscard]] std::unique_ptr<StudyType> make_fit_study(const SweepReader& reader,
                                                        FindMeasurement find_measurement);

}  // namespace jobs
