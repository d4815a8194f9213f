// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/dynamics_kernel.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>

namespace engine {

// kernel/compiled_kernel.cc is compiled once for each.
inline namespace baseline {
DynamicsKernel* make_compiled_kernel(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                                     std::size_t bristles, AppliedValues applied);
}
namespace avx2 {
DynamicsKernel* make_compiled_kernel(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                                     std::size_t bristles, AppliedValues applied);
}
namespace avx512 {
DynamicsKernel* make_compiled_kernel(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                                     std::size_t bristles, AppliedValues applied);
}

namespace {

struct InstructionSet {
  std::string_view name;
  bool (*is_supported)();
  decltype(&baseline::make_compiled_kernel) make;
};

/// Instruction sets for which this program was compiled (RPSUP_INSTRUCTION_SETS), the best one last.
constexpr InstructionSet kCompiled[] = {
#ifdef RPSUP_HAS_baseline
    {"baseline", [] { return true; }, baseline::make_compiled_kernel},
#endif
#ifdef RPSUP_HAS_avx2
    {"avx2", [] { return __builtin_cpu_supports("avx2") != 0; }, avx2::make_compiled_kernel},
#endif
#ifdef RPSUP_HAS_avx512
    {"avx512",
     [] {
       return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl");
     },
     avx512::make_compiled_kernel},
#endif
};

}  // namespace

std::vector<std::string_view> instruction_sets() {
  std::vector<std::string_view> sets;
  for (const InstructionSet& set : kCompiled)
    if (set.is_supported()) sets.push_back(set.name);
  return sets;
}

std::unique_ptr<DynamicsKernel> make_dynamics_kernel(std::string_view instruction_set, const TreeModel& model,
                                                     const std::vector<ClearanceJoint>& joints,
                                                     AppliedValues applied) {
  std::size_t bristles = 0;
  for (const ClearanceJoint& joint : joints) bristles += static_cast<std::size_t>(joint.bristle_count());
  const auto* const set = std::ranges::find(kCompiled, instruction_set, &InstructionSet::name);
  assert(set != std::end(kCompiled));
  return std::unique_ptr<DynamicsKernel>(set->make(model, joints, bristles, applied));
}

}  // namespace engine
