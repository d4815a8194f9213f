#pragma once

#include <functional>
#include <utility>

#include "engine/dynamics/constraints.h"
#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"
#include "engine/validation/support/quiet_observer.h"

namespace engine::validation {

/// Calls a function at each end of a step, with the constraints as they are there.
class ConstraintObserver : public QuietObserver {
 public:
  using Visit = std::function<void(const Evaluation&, const Constraints&)>;
  ConstraintObserver(const Mechanism& mechanism, Visit visit) : constraints_(mechanism), visit_(std::move(visit)) {}

  void on_step(const Evaluation& /*start*/, const Evaluation& end) override {
    constraints_.calc(end.frames, end.q, end.qd, end.t);
    visit_(end, constraints_);
  }

 private:
  Constraints constraints_;
  Visit visit_;
};

/// Integrates a mechanism with constraints from its assembled position, changed by `disturb`, and shows every step.
/// Throws where the run does not succeed.
void integrate(const Mechanism& mechanism, const RunOptions& options, const std::function<void(Evaluation&)>& disturb,
               const ConstraintObserver::Visit& visit);

}  // namespace engine::validation
