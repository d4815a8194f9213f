// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/compiled_equations.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

Equations* make_compiled_equations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles) {
  if (RpsupShapes<1>::fit(model)) return new CompiledEquations<RpsupShapes<1>>(model, joints, bristles);
  if (RpsupShapes<4>::fit(model)) return new CompiledEquations<RpsupShapes<4>>(model, joints, bristles);
  return new CompiledEquations<AnyShapes>(model, joints, bristles);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
