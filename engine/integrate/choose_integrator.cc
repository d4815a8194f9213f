#include "engine/integrate/choose_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace engine {

namespace {

/// Against dopri5 at 1e-6, radau5 has peaks of the continuum within 0.02 % from 10 to 1000 1/m, and misses one at 3000 1/m.
constexpr double kSlowBristles = 300.0;  // stiffness, [1/m]

// What tolerances are divided by. With 1.5e-5 undivided, rodas5 misses a third of the peaks that converge by 0.1 % to several percent, radau5 with
// contact elements one in thirty by up to 1.2 %.
constexpr double kForChangingContacts = 7.5;
constexpr double kForElementsWithRadau5 = 3.75;
constexpr double kForJumpingFriction = 30.0;  // across a band of velocities that a step may leap

constexpr auto is_elastic = [](const auto& spring) { return spring.stiffness > 0.0; };

bool has_friction(const ClearanceParameters& joint) { return joint.friction && joint.friction->law != FrictionLaw::kNone; }

bool has_slow_friction(const ClearanceParameters& joint) {
  return !joint.worn && joint.friction && joint.friction->law == FrictionLaw::kLuGre && joint.friction->sigma_0 <= kSlowBristles;
}

double choose_refinement(const ClearanceParameters& joint, Integrator integrator) {
  if (has_slow_friction(joint)) {
    if (joint.form == RadialForm::kContinuum) return 1.0;
    return integrator == Integrator::kRadau5 ? kForElementsWithRadau5 : kForChangingContacts;
  }
  const bool jumps = has_friction(joint) && !has_bristles(joint.friction->law);
  return jumps ? kForJumpingFriction : kForChangingContacts;
}

bool has_elastic_links(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.coordinates, is_elastic) || std::ranges::any_of(mechanism.springs, is_elastic);
}

}  // namespace

bool has_clearance(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.cut_joints, [](const CutJoint& joint) { return joint.clearance.has_value(); });
}

Integrator choose_integrator(const Mechanism& mechanism, Integrator wanted) {
  if (wanted != Integrator::kAuto) return wanted;
  const bool elastic = has_elastic_links(mechanism);
  const bool long_steps_suit = std::ranges::all_of(mechanism.cut_joints, [&](const CutJoint& joint) {
    if (!joint.clearance) return true;
    return has_slow_friction(*joint.clearance) && !(elastic && joint.clearance->form == RadialForm::kElements);
  });
  return long_steps_suit ? Integrator::kRadau5 : Integrator::kRodas5;
}

double choose_longest_step(const Mechanism& mechanism, Integrator integrator) {
  constexpr double kLongest = 1e-3;          // [s]; short enough for the cubic that finds a ring's contact inside a step
  constexpr double kLongestImplicit = 5e-3;  // [s]; of an implicit method without such a joint: short enough for what is read from inside
  // Friction feeds vibrations of elastic links, measured up to 1.3 kHz, that grow a hundredfold in 5 ms. Longer steps of radau5 damp them as fast.
  constexpr double kLongestElastic = 4e-4;  // [s]
  if (!has_clearance(mechanism)) return is_implicit(integrator) ? kLongestImplicit : kLongest;
  return integrator == Integrator::kRadau5 && has_elastic_links(mechanism) ? kLongestElastic : kLongest;
}

double choose_time_between_looks(const Mechanism& mechanism, Integrator integrator, Eigen::Index free_coordinates) {
  // A look costs as the cube of the coordinates, a step as their number to their square: so it takes about as large a part of a run with any number.
  constexpr double kForEach = 1e-3;  // [s]
  constexpr double kFew = 28.0;
  const bool is_fed = std::ranges::any_of(mechanism.cut_joints, [](const CutJoint& joint) { return joint.clearance && has_friction(*joint.clearance); });
  if (!is_fed || !is_implicit(integrator) || free_coordinates == 0) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(free_coordinates);
  return kForEach * n * std::max(1.0, n / kFew);
}

double choose_tolerance(const Mechanism& mechanism, double wanted) {
  const Integrator integrator = choose_integrator(mechanism, Integrator::kAuto);
  double refinement = 1.0;
  for (const CutJoint& joint : mechanism.cut_joints)
    if (joint.clearance) refinement = std::max(refinement, choose_refinement(*joint.clearance, integrator));
  // Less and less of it towards tolerances that resolve all that changes: a smaller tolerance is a smaller one everywhere.
  constexpr double kNoneFrom = 1e-10, kAllFrom = 1e-7;
  const double part = std::clamp(std::log(wanted / kNoneFrom) / std::log(kAllFrom / kNoneFrom), 0.0, 1.0);
  return wanted / std::pow(refinement, part);
}

}  // namespace engine
