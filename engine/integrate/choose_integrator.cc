// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/choose_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace engine {

namespace {

// Divisors of the tolerances: the smallest that leave only a few in a hundred of the converging peaks more
// than 0.1 % off, of some hundred sets of parameters at random, against dopri5 at 1e-9.
constexpr double kForSlowBristles = 2.0;
constexpr double kForOtherFriction = 30.0;  // quick friction, or none, which damps nothing
constexpr double kForWornBores = 7.5;
constexpr double kForElements = 7.5;        // contact elements with other friction

// Friction without bristles reverses within micrometres per second: impacts that follow amplify what is lost
// there. At looser tolerances peaks were up to 24 % off.
constexpr double kLargestWithoutBristles = 1e-9;

constexpr double kSlowBristles = 300.0;  // stiffness, [1/m]

constexpr auto is_elastic = [](const auto& spring) { return spring.stiffness > 0.0; };

bool has_friction(const ClearanceParameters& joint) {
  return joint.friction && joint.friction->law != FrictionLaw::kNone;
}

bool has_slow_friction(const ClearanceParameters& joint) {
  return joint.friction && joint.friction->law == FrictionLaw::kLuGre &&
         joint.friction->sigma_0 <= kSlowBristles;
}

/// Bristles so stiff that they follow the journal's vibrations, or friction that jumps with the velocity.
bool has_quick_friction(const ClearanceParameters& joint) {
  return has_friction(joint) && !has_slow_friction(joint);
}

bool has_friction_without_bristles(const ClearanceParameters& joint) {
  return has_friction(joint) && !has_bristles(joint.friction->law);
}

double choose_refinement(const ClearanceParameters& joint) {
  if (has_slow_friction(joint)) return joint.worn ? kForWornBores : kForSlowBristles;
  return joint.form == RadialForm::kElements ? kForElements : kForOtherFriction;
}

/// @returns whether any joint with clearance has the property
template <typename Has>
bool has_any(const Mechanism& mechanism, const Has& has) {
  return std::ranges::any_of(mechanism.cut_joints,
                             [&](const CutJoint& joint) { return joint.clearance && has(*joint.clearance); });
}

bool has_elastic_links(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.coordinates, is_elastic) ||
         std::ranges::any_of(mechanism.springs, is_elastic);
}

}  // namespace

bool has_clearance(const Mechanism& mechanism) {
  return has_any(mechanism, [](const ClearanceParameters&) { return true; });
}

bool has_joint_friction(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.actuations, [](const Actuation& actuation) {
    return std::holds_alternative<JointFriction>(actuation.element);
  });
}

bool is_rigid(const Mechanism& mechanism) {
  constexpr auto is_damped = [](const auto& spring) { return spring.damping > 0.0; };
  constexpr auto has_drag = [](const PointSpring& spring) { return spring.drag > 0.0; };
  return !has_clearance(mechanism) && !has_elastic_links(mechanism) && mechanism.actuations.empty() &&
         mechanism.body_loads.empty() &&
         std::ranges::none_of(mechanism.coordinates, is_damped) &&
         std::ranges::none_of(mechanism.springs, is_damped) &&
         std::ranges::none_of(mechanism.springs, has_drag);
}

Integrator choose_integrator(const Mechanism& mechanism, Integrator requested) {
  if (requested != Integrator::kAuto) return requested;
  return has_any(mechanism, has_friction_without_bristles) && !has_elastic_links(mechanism)
             ? Integrator::kDopri5
             : Integrator::kRadau5;
}

Radau5Settings choose_radau5_settings(const Mechanism& mechanism) {
  if (!has_clearance(mechanism)) return {};
  const bool slow = !has_any(
      mechanism, [](const ClearanceParameters& joint) { return !has_slow_friction(joint); });
  // Contacts change the Jacobian so often that it need not be a good one.
  return {.error_weight = 50.0, .newton_tolerance = slow ? 4e-5 : 1e-5, .keep_jacobian_below = 0.05};
}

double choose_longest_step(const Mechanism& mechanism, Integrator integrator) {
  // The cubic that finds a ring's contact in a step needs no shorter one.
  constexpr double kLongest = 1e-3;  // [s]
  // The interpolation inside a step of radau5 is of order 5: samples and contacts there are as good.
  constexpr double kLongestRigid = 2e-3;  // [s]
  // Without clearance: values inside a step are interpolated well enough.
  constexpr double kLongestImplicit = 5e-3;  // [s]
  // Friction excites vibrations of elastic links, measured up to 1.3 kHz, that grow a hundredfold in 5 ms.
  // Longer steps of radau5 damp them as fast.
  constexpr double kLongestElastic = 4e-4;  // [s]
  // Quick friction excites vibrations of the journal on its bore, of several kHz, which count even where they
  // decay: at the tolerances chosen here, longer steps left peaks up to 15 % off.
  constexpr double kLongestQuick = 1e-4;  // [s]
  if (!has_clearance(mechanism)) return is_implicit(integrator) ? kLongestImplicit : kLongest;
  if (integrator != Integrator::kRadau5) return kLongest;
  if (has_any(mechanism, has_quick_friction)) return kLongestQuick;
  return has_elastic_links(mechanism) ? kLongestElastic : kLongestRigid;
}

double choose_stability_check_interval(const Mechanism& mechanism, Integrator integrator,
                                       Eigen::Index free_coordinates) {
  // A check costs O(n^3), a dense step O(n^2), a recursive step O(n); the recursion is cheaper from about n =
  // 28 on. An interval of max(n, n^2 / 28) ms keeps the checks' share of a run constant. Below n = 14 shorter
  // ones find nothing that changes a peak: bursts of vibrations last about 10 ms.
  constexpr double kPerCoordinate = 1e-3;  // [s]
  constexpr double kFewest = 14.0, kDenseUpTo = 28.0;
  const bool has_any_friction = has_joint_friction(mechanism) || has_any(mechanism, has_friction);
  if (!has_any_friction || !is_implicit(integrator) || free_coordinates == 0)
    return std::numeric_limits<double>::infinity();
  const auto n = std::max(kFewest, static_cast<double>(free_coordinates));
  return kPerCoordinate * n * std::max(1.0, n / kDenseUpTo);
}

double choose_tolerance(const Mechanism& mechanism, double requested) {
  double refinement = 1.0;
  for (const CutJoint& joint : mechanism.cut_joints)
    if (joint.clearance) refinement = std::max(refinement, choose_refinement(*joint.clearance));
  // Tolerances below 1e-7 resolve more and more by themselves: the divisor shrinks to 1 at 1e-10, and the
  // result stays monotonic.
  constexpr double kNoneFrom = 1e-10, kAllFrom = 1e-7;
  const double part = std::clamp(std::log(requested / kNoneFrom) / std::log(kAllFrom / kNoneFrom), 0.0, 1.0);
  const double divided = requested / std::pow(refinement, part);
  return has_any(mechanism, has_friction_without_bristles) ? std::min(divided, kLargestWithoutBristles)
                                                           : divided;
}

}  // namespace engine
