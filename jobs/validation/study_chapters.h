#pragma once

#include <vector>

#include "engine/validation/report.h"
#include "jobs/validation/study.h"

namespace jobs::validation {

// One file a chapter, of the same name.
[[nodiscard]] engine::validation::ComputedChapter energy_of_the_grid(const Study& study);
[[nodiscard]] engine::validation::ComputedChapter sensitivity(const Study& study);
[[nodiscard]] engine::validation::ComputedChapter paper(const Study& study);

/// All that the study shows, in the report's order.
[[nodiscard]] std::vector<engine::validation::ComputedChapter> study_chapters(const Study& study);

}  // namespace jobs::validation
