// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/compiled_kernel.h"

#include "engine/dynamics/kernel/topology/rpsup_joints.h"
#include "engine/dynamics/kernel/topology/topology.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

namespace {

/// @returns null if the tree is of another topology
template <typename Topology>
DynamicsKernel* try_topology(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                             std::size_t bristles, AppliedValues applied) {
  return Topology::fit(model) ? new CompiledKernel<Topology>(model, joints, bristles, applied) : nullptr;
}

/// The kernel of the first topology that fits.
template <typename... Topologies>
DynamicsKernel* try_topologies(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                               std::size_t bristles, AppliedValues applied) {
  DynamicsKernel* kernel = nullptr;
  (void)(((kernel = try_topology<Topologies>(model, joints, bristles, applied)) != nullptr) || ...);
  return kernel;
}

}  // namespace

/// Seven topologies are static, all of the paper's linkage. In six the drives are prescribed. The yoke turns
/// about the guide or across it. For each yoke there are three: with clearance and a rigid coupler, with
/// clearance and a coupler of four elements, and that coupler without clearance. (Drives determine the motion
/// of rigid links without clearance: see LoopClosure.) The topology without clearance is rolled: its
/// constraint solver passes addresses of the workspaces to functions that are not inlined, so that nothing
/// stays in registers. In the seventh, of the rigid linkage with clearance, an actuator moves the crank.
///
/// With RPSUP_FEW_TOPOLOGIES there are four, one of each kind, which take the compiler less time; other
/// linkages are slower.
DynamicsKernel* make_compiled_kernel(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                                     std::size_t bristles, AppliedValues applied) {
#if defined(RPSUP_FEW_TOPOLOGIES)
  return try_topologies<StaticTopology<kRigidRpsup, true>, StaticTopology<kFlexibleRpsup, true>,
                        StaticTopology<kFlexibleRpsup, false>::Rolled,
                        StaticTopology<kRigidRpsupAcross, true>, DynamicTopology>(model, joints, bristles,
                                                                                  applied);
#else
  return try_topologies<
      StaticTopology<kRigidRpsup, true>, StaticTopology<kFlexibleRpsup, true>,
      StaticTopology<kFlexibleRpsup, false>::Rolled, StaticTopology<kRigidRpsupAcross, true>,
      StaticTopology<kFlexibleRpsupAcross, true>, StaticTopology<kFlexibleRpsupAcross, false>::Rolled,
      StaticTopology<kActuatedRpsup, true>, DynamicTopology>(model, joints, bristles, applied);
#endif
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
