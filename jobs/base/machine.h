// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace jobs {

/// Name of this computer.
[[nodiscard]] const std::string& host_name();

/// Model of its processor, as the kernel tells it; "unknown" if it does not. Results are equal to the bit
/// between equal ones.
[[nodiscard]] const std::string& cpu_name();

}  // namespace jobs
