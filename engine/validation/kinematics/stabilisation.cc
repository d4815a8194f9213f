#include "engine/validation/kinematics/stabilisation.h"

#include <stdexcept>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/integrate/integration.h"

namespace engine::validation {

void integrate(const Mechanism& mechanism, const RunOptions& options, const std::function<void(Evaluation&)>& disturb,
               const ConstraintObserver::Visit& visit) {
  LoopClosure closure(mechanism);
  Evaluation start = MotionSystem(mechanism).make_evaluation();
  if (!closure.assemble(0.0, start)) throw std::runtime_error("a mechanism of the validation cannot be assembled");
  disturb(start);
  ConstraintObserver observer(mechanism, visit);
  const RunEnd end = Integration(mechanism, options, observer).run(start);
  if (end.status != RunStatus::kSucceeded) throw std::runtime_error("an integration of the validation failed: " + end.detail);
}

}  // namespace engine::validation
