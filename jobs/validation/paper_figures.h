#pragma once

#include <vector>

#include "engine/validation/findings.h"
#include "jobs/validation/study.h"

namespace jobs::validation {

/// Counterparts of the paper's Figs. 5 to 9: the slider's acceleration without and with clearance, and the journal's orbits.
[[nodiscard]] std::vector<engine::validation::Figure> draw_paper_figures(const Study& study);

}  // namespace jobs::validation
