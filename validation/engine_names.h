// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {}

/// Comparisons of the engine with results from elsewhere. Names of the engine stand here as they do inside
/// the engine.
namespace validation {
using namespace engine;
}
