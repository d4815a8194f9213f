#pragma once

#include <functional>
#include <vector>

#include "engine/validation/report.h"

namespace jobs::validation {

/// Told what a part has found, as soon as it is done; one at a time, from any thread. Asked then whether to go on.
using PartDone = std::function<bool(const engine::validation::Part&, const engine::validation::Findings&)>;

/// Computes the parts of chapters on threads; the order of what comes back is that of the chapters, whatever the threads did.
/// @param most_costly  heavier parts are left out
/// @returns empty if done() asked to stop
[[nodiscard]] std::vector<engine::validation::ComputedChapter> compute_chapters(const std::vector<engine::validation::Chapter>& chapters,
                                                                                engine::validation::Cost most_costly, int threads,
                                                                                const PartDone& done);

}  // namespace jobs::validation
