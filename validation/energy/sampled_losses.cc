// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "engine/model/rpsup.h"
#include "engine/simulate.h"
#include "validation/energy/parts.h"
#include "validation/support/quiet_observer.h"

namespace validation {

namespace {

constexpr double kSampling = 1e6;  // [Hz]

/// Trapezoids.
class Integral {
 public:
  void take(double t, double value) {
    if (taken_) sum_ += 0.5 * (t - t_) * (value + value_);
    t_ = t;
    value_ = value;
    taken_ = true;
  }
  [[nodiscard]] double sum() const { return sum_; }

 private:
  double sum_ = 0.0, t_ = 0.0, value_ = 0.0;
  bool taken_ = false;
};

/// Losses of a joint with a single ring in its middle, from force and motion of the journal alone.
class ContactLosses : public QuietObserver {
 public:
  ContactLosses(double c_r, double r_j, double K) : c_r_(c_r), r_j_(r_j), K_(K) {}

  void on_sample(const Evaluation& at) override {
    const JournalMotion& journal = at.joints[0].journal;
    const double distance = std::hypot(journal.p_bj.x(), journal.p_bj.y());
    const Eigen::Vector3d n(journal.p_bj.x() / distance, journal.p_bj.y() / distance, 0.0);
    const double normal = at.joints[0].load.radial_normal_sum;
    const double depth = std::max(0.0, distance - c_r_);
    impact.take(at.t, (normal - K_ * std::pow(depth, 1.5)) * n.dot(journal.v));
    // The force less its normal part is friction, at the place r_j n of the journal.
    const Eigen::Vector3d along = at.joints[0].load.force + normal * n;
    friction.take(at.t, -along.dot(journal.v + journal.w.cross(r_j_ * n)));
    energy = at.energy;
  }

  Integral impact, friction;
  EnergyAccount energy;

 private:
  double c_r_, r_j_, K_;
};

/// Heat of the coupler's dampers: D = 2 zeta / omega_1 (E I, E I, G J) / dl on each of its joints' three
/// rates.
class DamperLosses : public QuietObserver {
 public:
  DamperLosses(const RpsupParameters& p, FrameIndex coupler)
      : first_(coupler + 1), joints_(p.rigid_elements - 1) {
    const double d4 = std::pow(p.coupler_diameter, 4);
    const double bending = p.youngs_modulus * std::numbers::pi * d4 / 64.0;
    const double torsion = p.shear_modulus * std::numbers::pi * d4 / 32.0;
    const double density = p.links[2].mass / p.coupler_length;
    const double omega = std::pow(std::numbers::pi / p.coupler_length, 2) * std::sqrt(bending / density);
    const double scale = 2.0 * p.coupler_damping_ratio / omega / (p.coupler_length / joints_);
    damping_ = {scale * bending, scale * bending, scale * torsion};
  }

  void on_sample(const Evaluation& at) override {
    double power = 0.0;
    for (int joint = 0; joint < joints_; ++joint)
      for (int axis = 0; axis < 3; ++axis) {
        const double rate = at.qd[first_ + 3 * joint + axis];
        power += damping_[static_cast<std::size_t>(axis)] * rate * rate;
      }
    structural.take(at.t, power);
    energy = at.energy;
  }

  Integral structural;
  EnergyAccount energy;

 private:
  FrameIndex first_;
  int joints_;
  std::array<double, 3> damping_{};
};

void sample_run(const Mechanism& mechanism, double duration, Observer& losses) {
  (void)simulate(mechanism,
                 {.duration = duration,
                  .output_rate = kSampling,
                  .integrator = Integrator::kDopri5,
                  .relative_tolerance = 1e-8,
                  .absolute_tolerance = 1e-9},
                 losses);
}

/// Project paper: K = 4 / (3 pi 2 h) sqrt(r_b r_j / c_r), h = (1 - nu^2) / (pi E), nu = E / (2 G) - 1.
double calc_contact_stiffness(const RpsupParameters& p, double r_j) {
  const double nu = 0.5 * p.youngs_modulus / p.shear_modulus - 1.0;
  return 2.0 * p.youngs_modulus / (3.0 * (1.0 - nu * nu)) * std::sqrt(p.bearing_radius * r_j / p.c_r);
}

ContactLosses sample_contact_losses() {
  RpsupParameters parameters;
  parameters.radial_levels = 1;
  parameters.c_a = 5e-3;  // the faces do not touch
  const double r_j = parameters.bearing_radius - parameters.c_r;
  ContactLosses losses(parameters.c_r, r_j, calc_contact_stiffness(parameters, r_j));
  sample_run(build_rpsup(parameters).mechanism, 0.2, losses);
  return losses;
}

void add_contact_losses(Findings& findings) {
  const ContactLosses losses = sample_contact_losses();
  const char* why =
      "trapezoids of 1 us that contain an onset, where the power sets in as t^1.5: (1 us / time in contact, "
      "100 us or more)^2.5";
  const std::string what = "rigid, 0.25 mm, 10 rad/s, one ring, 0.2 s: ";
  findings.checks.push_back(compare(
      what + "impact loss",
      "integral of (f_n - K delta^1.5) times the penetration rate, from samples of force and motion",
      losses.energy.impact_loss, losses.impact.sum(), 1e-5 * losses.impact.sum(), "J", why));
  findings.checks.push_back(
      compare(what + "friction loss",
              "integral of the force along the bore times the sliding velocity, from the same samples",
              losses.energy.friction_loss, losses.friction.sum(), 1e-5 * losses.friction.sum(), "J", why));
}

Check compare_damper_losses() {
  RpsupParameters parameters;
  parameters.coupler = Coupler::kFlexible;
  const Rpsup rpsup = build_rpsup(parameters);
  DamperLosses losses(parameters, rpsup.layout.coupler);
  sample_run(rpsup.mechanism, 0.1, losses);
  return compare(
      "flexible, 0.25 mm, 10 rad/s, 0.1 s: structural loss",
      "integral of rate^T D rate, D from E, G and the rod's size, from samples of the coupler's angles",
      losses.energy.structural_loss, losses.structural.sum(), 1e-7 * losses.structural.sum(), "J",
      "ten times the tolerance, 1e-8; trapezoids of a smooth power err only by its slope at the end, h^2 w "
      "/ (12 T): 8e-9 at w = 1e4 rad/s");
}

}  // namespace

Findings compute_sampled_losses() {
  Findings findings;
  add_contact_losses(findings);
  findings.checks.push_back(compare_damper_losses());
  return findings;
}

}  // namespace validation
