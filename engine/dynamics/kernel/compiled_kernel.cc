// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/compiled_kernel.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

namespace {

/// @returns null if the tree is another one
template <typename Shapes>
Equations* try_shapes(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles) {
  return Shapes::fit(model) ? new CompiledEquations<Shapes>(model, joints, bristles) : nullptr;
}

}  // namespace

/// The linkage with prescribed drives, its yoke about the guide or across it, is known when the program is compiled, with a rigid coupler and with one of four parts, with clearance and
/// without. Those with rows call what is not inlined with addresses of their rooms, so that these stand in memory in any case.
Equations* make_compiled_equations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles) {
  if (Equations* rigid = try_shapes<KnownShapes<kRigidRpsup, true>>(model, joints, bristles)) return rigid;
  if (Equations* flexible = try_shapes<KnownShapes<kFlexibleRpsup, true>>(model, joints, bristles)) return flexible;
  if (Equations* ideal = try_shapes<KnownShapes<kRigidRpsup, false>>(model, joints, bristles)) return ideal;
  if (Equations* flexible_ideal = try_shapes<KnownShapes<kFlexibleRpsup, false>::Looped>(model, joints, bristles)) return flexible_ideal;
  if (Equations* rigid = try_shapes<KnownShapes<kRigidRpsupAcross, true>>(model, joints, bristles)) return rigid;
  if (Equations* flexible = try_shapes<KnownShapes<kFlexibleRpsupAcross, true>>(model, joints, bristles)) return flexible;
  if (Equations* ideal = try_shapes<KnownShapes<kRigidRpsupAcross, false>>(model, joints, bristles)) return ideal;
  if (Equations* flexible_ideal = try_shapes<KnownShapes<kFlexibleRpsupAcross, false>::Looped>(model, joints, bristles)) return flexible_ideal;
  return try_shapes<AnyShapes>(model, joints, bristles);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
