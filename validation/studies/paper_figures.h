// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "validation/findings.h"
#include "validation/studies/study.h"

namespace validation::studies {

/// Counterparts of the paper's Figs. 5 to 9: the slider's acceleration without and with clearance, and the
/// journal's orbits.
[[nodiscard]] std::vector<Figure> draw_paper_figures(const Study& study);

}  // namespace validation::studies
