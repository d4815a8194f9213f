// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace engine {

/// kAuto: choose_integrator() says which.
enum class Integrator { kAuto, kRadau5, kRodas5, kDopri5, kRk4 };

/// @returns whether a method solves for what it steps over
[[nodiscard]] constexpr bool is_implicit(Integrator integrator) {
  return integrator == Integrator::kRadau5 || integrator == Integrator::kRodas5;
}

/// Settings of a run: its time span, its output, its integrator and the accuracy.
struct RunOptions {
  double duration = 5.0;                    ///< [s], > 0
  double output_rate = 1000.0;              ///< samples of the trajectory, [Hz]
  Integrator integrator = Integrator::kAuto;
  double step = 1e-5;                       ///< of rk4, [s]
  double relative_tolerance =
      1.5e-5;  ///< of the error-controlled integrators, [1]; kAuto: choose_tolerance()
  double absolute_tolerance = 1.5e-5;       ///< of the error-controlled integrators, likewise, in m and m/s;
                                            ///< rotations by what they carry: Tolerance
  long step_limit = 100'000'000;            ///< steps after which the run ends with kStepLimit
};

/// End of a run. A run that does not succeed keeps its samples up to then.
enum class RunStatus {
  kSucceeded,
  kAssembly,       ///< the loop cannot be closed at t = 0
  kLockUp,         ///< the loop cannot follow its drives any further
  kSingular,       ///< a change point: the loop may follow its drives in more than one way
  kContactRange,   ///< a penetration beyond what the contact's stiffness law holds for
  kNonFinite,      ///< the state is no longer a number
  kStepUnderflow,  ///< error control asks for steps below the resolution of time
  kStepLimit,      ///< RunOptions::step_limit reached
  kStopped,        ///< the caller asked for it
};

/// The word for a status that the service and its users see: "succeeded", "assembly", "lock_up",
/// "non_finite", ...
[[nodiscard]] std::string_view status_name(RunStatus status);

}  // namespace engine
