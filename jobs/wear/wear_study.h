// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "jobs/store/store.h"
#include "jobs/studies/study_desk.h"

namespace jobs {

/// Studies of a bearing that is worn over the hours: the bore after each step is a job, whose wear makes the next step. See parse_wear_request() and
/// WearFollower.
/// @param store  where the trajectories are that tell the wear; outlives what is made
[[nodiscard]] std::unique_ptr<StudyKind> make_wear_study(const Store& store);

}  // namespace jobs
