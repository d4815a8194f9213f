// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tests/bench/precision/study.h"

namespace bench {

/// A row a measurement.
[[nodiscard]] std::string write_csv(const std::vector<Measurement>& measurements);

/// For each coupler and setting: mean cost, and the worst error of known and of fresh cases.
void print_summary(std::ostream& out, const std::vector<Measurement>& measurements);

/// Worst error over mean cost, a chart for each coupler. SVG.
[[nodiscard]] std::string draw_figure(const std::vector<Measurement>& measurements);

}  // namespace bench
