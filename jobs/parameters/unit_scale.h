// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "jobs/parameters/span.h"

namespace jobs {

/// Part of a span at a value: 0 at `from`, 1 at `to`; by logarithms where the span is logarithmic.
/// @param span  from < to
[[nodiscard]] double part_at(const Span& span, double value);

/// Value at a part of a span, unrounded: the inverse of part_at(), beyond the ends as well.
[[nodiscard]] double value_at(const Span& span, double part);

}  // namespace jobs
