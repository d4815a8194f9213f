// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/report/report_view.h"

namespace server::report {

/// The metric over the first two axes, a map for each combination of the others: means of what lies together.
/// Empty of a design, whose points lie beside each other, of one axis, and of more values than a page holds.
[[nodiscard]] std::string make_heat_maps(const ReportView& view);

}  // namespace server::report
