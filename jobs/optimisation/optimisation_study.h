// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "jobs/studies/study_runner.h"

namespace jobs {

/// Optimisations: values of parameters for which metrics are least or largest. See
/// parse_optimisation_request() and Optimiser.
[[nodiscard]] std::unique_ptr<StudyType> make_optimisation_study();

}  // namespace jobs
