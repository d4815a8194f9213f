#pragma once

#include "engine/validation/findings.h"

namespace engine::validation {

[[nodiscard]] Findings compute_hertz_stiffness();
[[nodiscard]] Findings compute_rebounds();
[[nodiscard]] Findings compute_elastic_impacts();
[[nodiscard]] Findings compute_ring_of_elements();
[[nodiscard]] Findings compute_impacts_of_a_ring();
[[nodiscard]] Findings compute_turning_journal();
[[nodiscard]] Findings compute_whole_runs_with_elements();
[[nodiscard]] Findings compute_tilted_journal();
[[nodiscard]] Findings compute_axial_faces();

}  // namespace engine::validation
