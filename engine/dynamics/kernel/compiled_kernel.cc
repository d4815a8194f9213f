// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/compiled_kernel.h"

#include "engine/dynamics/kernel/topology/topology.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

namespace {

/// @returns null if the tree is of another topology
template <typename Topology>
DynamicsKernel* try_topology(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                             std::size_t bristles) {
  return Topology::fit(model) ? new CompiledKernel<Topology>(model, joints, bristles) : nullptr;
}

}  // namespace

/// Eight topologies are static: the paper's linkage with prescribed drives, its yoke about the guide or
/// across it, with a rigid coupler or one of four elements, with or without clearance. Those with constraints
/// pass the addresses of their workspaces to functions that are not inlined: nothing of these stays in
/// registers anyway, so that the flexible ones are rolled.
DynamicsKernel* make_compiled_kernel(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                                     std::size_t bristles) {
  if (DynamicsKernel* rigid = try_topology<StaticTopology<kRigidRpsup, true>>(model, joints, bristles))
    return rigid;
  if (DynamicsKernel* flexible = try_topology<StaticTopology<kFlexibleRpsup, true>>(model, joints, bristles))
    return flexible;
  if (DynamicsKernel* ideal = try_topology<StaticTopology<kRigidRpsup, false>>(model, joints, bristles))
    return ideal;
  if (DynamicsKernel* flexible_ideal =
          try_topology<StaticTopology<kFlexibleRpsup, false>::Rolled>(model, joints, bristles))
    return flexible_ideal;
  if (DynamicsKernel* rigid = try_topology<StaticTopology<kRigidRpsupAcross, true>>(model, joints, bristles))
    return rigid;
  if (DynamicsKernel* flexible =
          try_topology<StaticTopology<kFlexibleRpsupAcross, true>>(model, joints, bristles))
    return flexible;
  if (DynamicsKernel* ideal = try_topology<StaticTopology<kRigidRpsupAcross, false>>(model, joints, bristles))
    return ideal;
  if (DynamicsKernel* flexible_ideal =
          try_topology<StaticTopology<kFlexibleRpsupAcross, false>::Rolled>(model, joints, bristles))
    return flexible_ideal;
  return try_topology<DynamicTopology>(model, joints, bristles);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
