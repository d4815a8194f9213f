// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace jobs {

/// Size for texts, rounded to megabytes; below 10 MB to two digits: "12 MB", "0.43 MB".
[[nodiscard]] std::string size_text(double bytes);

}  // namespace jobs
