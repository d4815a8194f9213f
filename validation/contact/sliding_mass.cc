// SPDX-License-Identifier: Apache-2.0
#include "validation/contact/sliding_mass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/integration.h"
#include "validation/support/quiet_observer.h"

namespace validation {

namespace {

/// Watches one impact.
class ImpactObserver : public QuietObserver {
 public:
  explicit ImpactObserver(double c_r) : c_r_(c_r) {}

  void on_step(const Evaluation& start, const Evaluation& end) override {
    const double before = start.q[0] - c_r_;
    const double after = end.q[0] - c_r_;
    // Steps end within 1e-10 m of an onset or a parting, and the speed is constant there.
    const double crossing = end.t - after / end.qd[0];
    if (before <= 0.0 && after > 0.0) impact.onset_time = crossing;
    if (before > 0.0 && after <= 0.0) {
      parted = true;
      impact.contact_time = crossing - impact.onset_time;
    }
    impact.force = std::max(impact.force, end.joints[0].load.radial_normal_sum);
    impact.depth = std::max(impact.depth, start.qd[0] > 0.0 && end.qd[0] <= 0.0 ? find_reversal(start, end) : after);
    impact.speed = -end.qd[0];
    impact.loss = end.energy.impact_loss;
  }

  Impact impact;
  bool parted = false;

 private:
  /// Depth where the velocity, linear in the short step in which it changes its sign, is zero.
  [[nodiscard]] double find_reversal(const Evaluation& start, const Evaluation& end) const {
    const double s = start.qd[0] / (start.qd[0] - end.qd[0]);
    return start.q[0] - c_r_ + 0.5 * s * (end.t - start.t) * start.qd[0];
  }

  double c_r_;
};

}  // namespace

ClearanceParameters one_ring(double c_r) {
  ClearanceParameters joint;
  joint.c_r = c_r;
  joint.c_a = 1.0;
  joint.K_a = 0.0;
  joint.n_r = 1;
  joint.K = hertz_stiffness(joint.r_b, c_r, 2.1e11, 0.3125);
  return joint;
}

Mechanism make_sliding_mass(const ClearanceParameters& joint, double mass, double turned) {
  Mechanism mechanism;
  mechanism.coordinates.push_back({.name = "x", .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kX, .mass = mass});
  CutJoint cut{.bearing = {}, .journal = {}, .clearance = joint};
  cut.journal_frame = 0;
  const double c = std::cos(turned);
  const double s = std::sin(turned);
  cut.journal.R << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  mechanism.cut_joints.push_back(cut);
  return mechanism;
}

Impact simulate_impact(const Mechanism& sliding_mass, double gap, double v0, double contact, RunOptions steps) {
  const double c_r = sliding_mass.cut_joints[0].clearance->c_r;
  steps.duration = gap / v0 + 3.0 * contact;
  ImpactObserver observer(c_r);
  Evaluation start = MotionSystem(sliding_mass).make_evaluation();
  start.q[0] = c_r - gap;
  start.qd[0] = v0;
  const RunOutcome end = Integration(sliding_mass, steps, observer).run(start);
  if (end.status != RunStatus::kSucceeded || !observer.parted) throw std::runtime_error("an impact of the validation failed: " + end.detail);
  return observer.impact;
}

double calc_hertz_time(double K, double mass, double v0) { return hertz_time_factor() * std::pow(1.25 * mass * v0 * v0 / K, 0.4) / v0; }

double hertz_time_factor() { return 0.8 * std::tgamma(0.4) * std::tgamma(0.5) / std::tgamma(0.9); }

double hertz_stiffness(double r_b, double c_r, double youngs_modulus, double nu) {
  const double E = youngs_modulus / (2.0 * (1.0 - nu * nu));
  const double R = 1.0 / (1.0 / (r_b - c_r) - 1.0 / r_b);
  return 4.0 / 3.0 * E * std::sqrt(R);
}

double rebound_ratio(double c) {
  double low = 0.0;
  double high = 1.0;  // e = 1 for c = 0; below, the left side less the right one falls with e
  while (high - low > std::numeric_limits<double>::epsilon()) {
    const double e = 0.5 * (low + high);
    (c * (1.0 + e) > std::log((1.0 + c) / (1.0 - c * e)) ? low : high) = e;
  }
  return 0.5 * (low + high);
}

}  // namespace validation
