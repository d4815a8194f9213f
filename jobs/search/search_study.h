// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "jobs/studies/study_runner.h"

namespace jobs {

/// Searches: how far a parameter may go until a metric exceeds its bound. See parse_search_request().
[[nodiscard]] std::unique_ptr<StudyType> make_search_study();

}  // namespace jobs
