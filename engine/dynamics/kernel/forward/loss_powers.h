// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Dissipated powers, [W], or their tangents: of contacts along their normals, of friction, of springs'
/// dampers.
template <typename T>
struct LossPowers {
  T impact{}, friction{}, structural{};
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
