// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "validation/report/report.h"
#include "validation/studies/study.h"

namespace validation::studies {

// One file a chapter, of the same name.
[[nodiscard]] ComputedChapter energy_of_the_grid(const Study& study);
[[nodiscard]] ComputedChapter sensitivity(const Study& study);
[[nodiscard]] ComputedChapter paper(const Study& study);

/// All that the study shows, in the report's order.
[[nodiscard]] std::vector<ComputedChapter> study_chapters(const Study& study);

}  // namespace validation::studies
