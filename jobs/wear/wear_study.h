// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "jobs/studies/study_runner.h"

namespace jobs {

class SweepReader;

/// Wear studies: a bearing is worn over the hours. The bore after each step is a job, whose wear gives the
/// next step. See parse_wear_request() and WearIntegrator.
/// @param reader  of the trajectories that give the wear; outlives the result
[[nodiscard]] std::unique_ptr<StudyType> make_wear_study(const SweepReader& reader);

}  // namespace jobs
