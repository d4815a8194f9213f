// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/compiled_equations.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

Equations* make_compiled_equations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles) {
  return new CompiledEquations(model, joints, bristles);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
