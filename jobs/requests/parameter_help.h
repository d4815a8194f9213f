// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace jobs {

/// The parameters of a job for a terminal, one a line: key, default, unit, what is allowed, meaning.
[[nodiscard]] std::string parameter_help();

}  // namespace jobs
