#include "engine/integrate/choose_integrator.h"

#include <algorithm>

namespace engine {

namespace {

/// Against dopri5 at 1e-6, radau5 has peaks within 0.02 % from 10 to 1000 1/m, and misses one at 3000 1/m.
constexpr double kSlowBristles = 300.0;  // stiffness, [1/m]

constexpr auto is_elastic = [](const auto& spring) { return spring.stiffness > 0.0; };

bool has_slow_friction(const ClearanceParameters& joint) {
  return joint.form == RadialForm::kContinuum && !joint.worn && joint.friction && joint.friction->law == FrictionLaw::kLuGre &&
         joint.friction->sigma_0 <= kSlowBristles;
}

}  // namespace

Integrator choose_integrator(const Mechanism& mechanism, Integrator wanted) {
  if (wanted != Integrator::kAuto) return wanted;
  const bool elastic = std::ranges::any_of(mechanism.coordinates, is_elastic) || std::ranges::any_of(mechanism.springs, is_elastic);
  const bool missed = std::ranges::any_of(mechanism.cut_joints, [&](const CutJoint& joint) {
    return joint.clearance && (elastic || !has_slow_friction(*joint.clearance));
  });
  return missed ? Integrator::kRodas5 : Integrator::kRadau5;
}

}  // namespace engine
