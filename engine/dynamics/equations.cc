#include "engine/dynamics/equations.h"

#include <cstddef>

namespace engine {

// compiled_equations.cc, once for each.
inline namespace baseline {
Equations* make_compiled_equations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles);
}
namespace avx2 {
Equations* make_compiled_equations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles);
}
namespace avx512 {
Equations* make_compiled_equations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles);
}

std::vector<std::string_view> instruction_sets() {
  std::vector<std::string_view> sets{"baseline"};
  if (__builtin_cpu_supports("avx2")) sets.push_back("avx2");
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) sets.push_back("avx512");
  return sets;
}

std::unique_ptr<Equations> make_equations(std::string_view instruction_set, const TreeModel& model, const std::vector<ClearanceJoint>& joints) {
  std::size_t bristles = 0;
  for (const ClearanceJoint& joint : joints) bristles += static_cast<std::size_t>(joint.bristle_count());
  const auto make = instruction_set == "avx512" ? avx512::make_compiled_equations
                    : instruction_set == "avx2" ? avx2::make_compiled_equations
                                                : baseline::make_compiled_equations;
  return std::unique_ptr<Equations>(make(model, joints, bristles));
}

}  // namespace engine
