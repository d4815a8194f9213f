// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/unit_scale.h"

#include <cmath>

namespace jobs {

double part_at(const Span& span, double value) {
  return span.logarithmic ? std::log(value / span.from) / std::log(span.to / span.from)
                          : (value - span.from) / (span.to - span.from);
}

double value_at(const Span& span, double part) {
  return span.logarithmic ? geometric_between(span.from, span.to, part)
                          : span.from + (span.to - span.from) * part;
}

}  // namespace jobs
