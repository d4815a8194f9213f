// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/stepper.h"

#include "engine/integrate/choose_integrator.h"
#include "engine/integrate/odeint_steppers.h"
#include "engine/integrate/radau.h"

namespace engine {

std::unique_ptr<Stepper> make_stepper(const Mechanism& mechanism, Integrator integrator,
                                      const Tolerance& tolerance) {
  switch (integrator) {
    case Integrator::kRadau5: return std::make_unique<Radau5>(tolerance, choose_radau5_settings(mechanism));
    case Integrator::kRodas5: return std::make_unique<Rodas5>(tolerance);
    case Integrator::kDopri5: return std::make_unique<Dopri5>(tolerance);
    case Integrator::kAuto:
    case Integrator::kRk4: break;
  }
  return std::make_unique<Rk4>();
}

}  // namespace engine
