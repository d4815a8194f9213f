// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "validation/report/report.h"

namespace validation::studies {

/// Told what a part has found, as soon as it is done; one at a time, from any thread.
using PartDone = std::function<void(const Part&, const Findings&)>;

/// Parts that are no more costly.
[[nodiscard]] std::size_t count_parts(const std::vector<Chapter>& chapters, Cost most_costly);

/// Computes the parts of chapters on threads; the order of what comes back is that of the chapters, whatever
/// the threads did.
/// @param most_costly  heavier parts are left out
/// @throws what a part has thrown; parts that have not begun by then are left
[[nodiscard]] std::vector<ComputedChapter> compute_chapters(const std::vector<Chapter>& chapters,
                                                                                Cost most_costly, int threads,
                                                                                const PartDone& done);

}  // namespace validation::studies
