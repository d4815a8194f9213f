// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/report/report_view.h"

namespace server::report {

/// The chosen metric and others over the axis along the charts, a line for each combination of what else is
/// varied: means with the least and the largest of what lies together. Of many combinations some are drawn,
/// evenly spread, and that with the largest value. Empty if no number is varied.
[[nodiscard]] std::string make_figures(const ReportView& view);

}  // namespace server::report
