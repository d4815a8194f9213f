// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace jobs {

/// JSON Schema (2020-12) of the parameters of a job: type, unit, range, default, where the default comes
/// from.
[[nodiscard]] nlohmann::json parameter_schema();

}  // namespace jobs
