// SPDX-License-Identifier: Apache-2.0
// Friction of a pressed journal that turns: one bristle for a ring, or one for each element that comes and goes.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/integration.h"
#include "validation/contact/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kOmega = 4.0;   // [rad/s], what the linkage's joint has at times
constexpr double kDepth = 4e-6;  // [m]
constexpr double kMuK = 0.2;     // of the study; the journal slides 19 times as fast as Stribeck's velocity
constexpr int kElements = 720;
constexpr double kPitch = 2.0 * std::numbers::pi / kElements;

/// Takes the drive's work at each sample.
class WorkObserver : public QuietObserver {
 public:
  void on_sample(const Evaluation& at) override { work.push_back(at.energy.drive_work[0]); }
  std::vector<double> work;
};

ClearanceParameters make_rubbing_joint(RadialForm form, double sigma_0) {
  ClearanceParameters joint = one_ring();
  joint.form = form;
  joint.n_ce = kElements;
  joint.chi = 0.0;  // no damping in the normal law
  joint.friction = FrictionParameters{
      .mu_s = 0.1, .mu_k = kMuK, .sigma_0 = sigma_0, .sigma_1 = 5.0, .sigma_2 = 0.0, .v_s = 1e-3};
  return joint;
}

/// A journal that turns in a bearing whose axis is held c_r + 4 um beside its own.
Mechanism make_turning_journal(const ClearanceParameters& joint) {
  Mechanism mechanism;
  mechanism.coordinates.push_back({.name = "psi", .placement = {}, .axis = Axis::kZ, .mass = 1.0, .inertia = Eigen::Matrix3d::Identity()});
  mechanism.drives = {{0, RunUp{kOmega, 0.0}}};
  CutJoint cut{.bearing = {}, .journal = {}, .clearance = joint};
  cut.journal_frame = 0;
  // At the start bristles are there for the elements beyond the journal's x axis: the contact lies among them.
  cut.journal.R = Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  cut.bearing.p = {-joint.c_r - kDepth, 0.0, 0.0};
  mechanism.cut_joints.push_back(cut);
  return mechanism;
}

/// Mean torque that turns the journal at 4 rad/s.
double simulate_torque(RadialForm form, double sigma_0) {
  const Mechanism mechanism = make_turning_journal(make_rubbing_joint(form, sigma_0));
  // Samples, one for each pitch that the journal has turned. An element passes through the arc in 42 of them, a ring's bristle takes longer.
  const std::size_t from = form == RadialForm::kElements ? 100 : 700;
  const std::size_t to = from + 50;
  const double rate = kOmega / kPitch;
  const RunOptions options{.duration = static_cast<double>(to) / rate, .output_rate = rate, .integrator = Integrator::kDopri5,
                           .relative_tolerance = 1e-9, .absolute_tolerance = 1e-11};
  WorkObserver observer;
  const RunOutcome end = Integration(mechanism, options, observer).run(MotionSystem(mechanism).make_evaluation());
  if (end.status != RunStatus::kSucceeded || observer.work.size() <= to) throw std::runtime_error("a run of the validation failed: " + end.detail);
  return (observer.work[to] - observer.work[from]) / (static_cast<double>(to - from) * kPitch);
}

/// Torque of a ring of infinitely many elements. One that has slid by s since it came into contact has the bristle
/// z = g / sigma_0 (1 - exp(-sigma_0 s / g)), so the friction ratio g + (sigma_1 v - g) exp(-sigma_0 s / g).
double integrate_torque(double sigma_0) {
  const ClearanceParameters joint = one_ring();
  const double r_j = joint.r_j();
  const double e = joint.c_r + kDepth;
  const double end = std::acos((joint.r_b * joint.r_b - r_j * r_j - e * e) / (2.0 * e * r_j));
  const double stiffness = joint.K * 3.0 * std::sqrt(joint.c_r) / (4.0 * std::numbers::sqrt2);  // of the elements, per angle
  const auto density = [&](double theta) {
    const double rho = std::hypot(e + r_j * std::cos(theta), r_j * std::sin(theta));
    const double cosine = (e * std::cos(theta) + r_j) / rho;  // between the bore's normal and the journal's
    const double v = kOmega * r_j * cosine;
    const double slid = r_j * (theta + end);
    const double ratio = kMuK + (5.0 * v - kMuK) * std::exp(-sigma_0 * slid / kMuK);
    return stiffness * (rho - joint.r_b) * ratio * r_j * cosine;
  };
  constexpr int kPanels = 20'000;
  double sum = density(-end) + density(end);
  for (int k = 1; k < kPanels; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * density(-end + 2.0 * end * k / kPanels);
  return sum * 2.0 * end / kPanels / 3.0;
}

double calc_coulomb_torque() {
  const ClearanceParameters joint = one_ring();
  return kMuK * joint.K * std::pow(kDepth, 1.5) * joint.r_j();
}

Check compare_continuum_torque(double found, const std::string& at) {
  const double coulomb = calc_coulomb_torque();
  return compare("torque of a turning journal, continuum" + at, "mu_k K delta^1.5 r_j", found, coulomb,
                 1e-5 * coulomb, "N m",
                 "the bristle tends to its steady bend like exp(-sigma_0 v t / mu_k): 1e-6 is left");
}

Check compare_elements_torque(double found, double expected, const std::string& at) {
  return compare(
      "torque of a turning journal, 720 elements" + at,
      "integral over the arc of normal force times mu_k + (sigma_1 v - mu_k) exp(-sigma_0 s / mu_k)", found,
      expected, 1e-5 * expected, "N m",
      "elements come into contact inside steps of error control: a few parts in a million");
}

void add_torques(Findings& findings, Table& table, double sigma_0) {
  const std::string at = ", sigma_0 = " + number(sigma_0, 5) + " 1/m";
  const double coulomb = calc_coulomb_torque();
  const double continuum = simulate_torque(RadialForm::kContinuum, sigma_0);
  const double elements = simulate_torque(RadialForm::kElements, sigma_0);
  const double expected = integrate_torque(sigma_0);
  findings.checks.push_back(compare_continuum_torque(continuum, at));
  findings.checks.push_back(compare_elements_torque(elements, expected, at));
  table.rows.push_back({number(sigma_0, 5), number(continuum / coulomb, 5), number(elements / coulomb, 4),
                        number(expected / coulomb, 4)});
}

}  // namespace

Findings compute_turning_journal() {
  Findings findings;
  Table table{
      .caption =
          "Mean torque of a journal that turns at 4 rad/s, pressed 4 um into the bore, c_r = 0.25 mm, over that of Coulomb's friction with mu_k = "
          "0.2. A ring of the closed form keeps its bristle; an element's begins anew each time it comes into contact, and has left "
          "the contact before it is bent. Where bristles bend fast (sigma_0 = 10,000 1/m) there is no difference but the ring's normal force.",
      .head = {"sigma_0 [1/m]", "continuum", "720 elements", "infinitely many elements"},
      .rows = {}};
  for (const double sigma_0 : {100.0, 1000.0, 10'000.0}) add_torques(findings, table, sigma_0);
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace validation
