// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

#include <Eigen/Core>

#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"
#include "validation/engine_names.h"
#include "validation/support/quiet_observer.h"

namespace validation {

/// Phi and its rate, of an ideal joint (5 rows) and both drives (2 rows).
struct Violation {
  Eigen::VectorXd Phi, Phi_d;
};

/// Read off poses, velocities and coordinates, without the engine's class of constraints.
[[nodiscard]] Violation read_violation(const Mechanism& mechanism, const Evaluation& at);

/// Calls a function at each end of a step.
class ConstraintObserver : public QuietObserver {
 public:
  using Visit = std::function<void(const Evaluation&)>;
  explicit ConstraintObserver(Visit visit) : visit_(std::move(visit)) {}

  void on_step(const Evaluation& /*start*/, const Evaluation& end) override { visit_(end); }

 private:
  Visit visit_;
};

/// Integrates a mechanism with constraints from its assembled position, changed by `disturb`, and shows every
/// step. Throws where the run does not succeed.
void integrate(const Mechanism& mechanism, const RunOptions& options,
               const std::function<void(Evaluation&)>& disturb, const ConstraintObserver::Visit& visit);

}  // namespace validation
