// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include "engine/dynamics/energies.h"
#include "engine/dynamics/inverse_dynamics.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "validation/formulation/parts.h"
#include "validation/support/differences.h"
#include "validation/support/largest.h"
#include "validation/support/mass_matrix.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr int kStates = 20;
constexpr double kStep = 0.03;  // [rad] and [m], of the differences
// [rad/s] and [m/s], by which rates are changed; any gives the same where a function is quadratic
constexpr double kRate = 10.0;

/// The engine's scalars alone: T(q, qd), V(q) and R(qd).
class Scalars {
 public:
  explicit Scalars(const Mechanism& chains)
      : chains_(chains),
        system_(chains_),
        at_(system_.make_evaluation()),
        frames_(chains.coordinates.size()) {}
  Scalars(const Scalars&) = delete;  // its members refer to each other
  Scalars& operator=(const Scalars&) = delete;

  [[nodiscard]] double kinetic(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    calc_frame_motions(chains_, q, qd, Eigen::VectorXd::Zero(q.size()), frames_);
    return calc_kinetic_energy(chains_, frames_, qd);
  }
  [[nodiscard]] double potential(const Eigen::VectorXd& q) {
    calc_frame_motions(chains_, q, Eigen::VectorXd::Zero(q.size()), Eigen::VectorXd::Zero(q.size()), frames_);
    return calc_potential_energy(chains_, frames_, q);
  }
  /// Half of the power that the dampers take.
  [[nodiscard]] double rayleigh(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    evaluate(q, qd);
    return 0.5 * rates_[rates_.size() - 1];
  }
  [[nodiscard]] const Eigen::VectorXd& accelerations(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    evaluate(q, qd);
    return at_.qdd;
  }

 private:
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    const Eigen::VectorXd y = system_.make_state(q, qd);
    rates_.setZero(y.size());
    if (system_.calc_derivative(0.0, y, rates_, at_) != EvaluationStatus::kOk)
      at_.qdd.setConstant(std::nan(""));
  }

  Mechanism chains_;
  MotionSystem system_;
  Evaluation at_;
  std::vector<FrameMotion> frames_;
  Eigen::VectorXd rates_;
};

/// dT/dqd, exact since T is quadratic in the rates.
Eigen::VectorXd calc_momenta(Scalars& scalars, const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
  Eigen::VectorXd p(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const Eigen::VectorXd change = kRate * Eigen::VectorXd::Unit(q.size(), i);
    p[i] = (scalars.kinetic(q, qd + change) - scalars.kinetic(q, qd - change)) / (2.0 * kRate);
  }
  return p;
}

/// Column j of M holds the momenta at a unit rate of coordinate j.
Eigen::MatrixXd calc_mass_matrix_from_energy(Scalars& scalars, const Eigen::VectorXd& q) {
  Eigen::MatrixXd M(q.size(), q.size());
  for (Eigen::Index j = 0; j < q.size(); ++j)
    M.col(j) = calc_momenta(scalars, q, kRate * Eigen::VectorXd::Unit(q.size(), j)) / kRate;
  return M;
}

/// h = d/dt dT/dqd - dT/dq at constant rates. Along qd the momenta change with q alone; the step is of a unit
/// way, so that none of the functions has a frequency above 2.
Eigen::VectorXd calc_coriolis(Scalars& scalars, const ChainState& state) {
  const double way = state.qd.lpNorm<1>();
  Eigen::VectorXd h =
      way *
      first_derivative(
          [&](double s) { return calc_momenta(scalars, state.q + s / way * state.qd, state.qd); }, kStep);
  for (Eigen::Index i = 0; i < h.size(); ++i)
    h[i] -= first_derivative(
        [&](double s) { return scalars.kinetic(state.q + s * Eigen::VectorXd::Unit(h.size(), i), state.qd); },
        kStep);
  return h;
}

Eigen::VectorXd calc_potential_slope(Scalars& scalars, const Eigen::VectorXd& q) {
  Eigen::VectorXd slope(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i)
    slope[i] = first_derivative(
        [&](double s) { return scalars.potential(q + s * Eigen::VectorXd::Unit(q.size(), i)); }, kStep);
  return slope;
}

/// dR/dqd, exact since R is quadratic.
Eigen::VectorXd calc_dissipation_slope(Scalars& scalars, const ChainState& state) {
  Eigen::VectorXd slope(state.q.size());
  for (Eigen::Index i = 0; i < state.q.size(); ++i) {
    const Eigen::VectorXd change = kRate * Eigen::VectorXd::Unit(state.q.size(), i);
    slope[i] = (scalars.rayleigh(state.q, state.qd + change) - scalars.rayleigh(state.q, state.qd - change)) /
               (2.0 * kRate);
  }
  return slope;
}

Mechanism without_gravity(Mechanism chains) {
  chains.gravity_W.setZero();
  return chains;
}

Mechanism without_springs(Mechanism chains) {
  for (Coordinate& c : chains.coordinates) c.stiffness = 0.0;
  return chains;
}

/// M, h, g and the whole of Lagrange's equations: differences relative to the largest entry.
struct Differences {
  Largest mass, coriolis, gravity, motion;
};

Differences compare_slopes(const RpsupParameters& parameters) {
  const Mechanism chains = open_chains(build_rpsup(parameters).mechanism);
  const Mechanism weightless = without_gravity(chains);
  const Mechanism springless = without_springs(chains);
  Scalars scalars(chains);
  Scalars springless_scalars(springless);
  InverseDynamics inverse_dynamics(chains);
  InverseDynamics weightless_dynamics(weightless);
  std::vector<FrameMotion> frames(chains.coordinates.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(frames.size()));
  Random random(23);
  Differences worst;
  for (int k = 0; k < kStates; ++k) {
    const ChainState state = draw_state(chains, random);
    const Eigen::MatrixXd M = calc_mass_matrix_from_energy(scalars, state.q);
    const Eigen::VectorXd h = calc_coriolis(scalars, state);
    const Eigen::VectorXd g = calc_potential_slope(springless_scalars, state.q);

    calc_frame_motions(weightless, state.q, state.qd, zero, frames);
    worst.coriolis.take(relative_difference(weightless_dynamics.calc(frames), h));
    calc_frame_motions(chains, state.q, zero, zero, frames);
    worst.gravity.take(relative_difference(inverse_dynamics.calc(frames), g));
    worst.mass.take(relative_difference(validation::calc_mass_matrix(chains, state.q), M));

    const Eigen::VectorXd& qdd = scalars.accelerations(state.q, state.qd);
    const double largest_term = (M.cwiseAbs() * qdd.cwiseAbs()).maxCoeff();
    const Eigen::VectorXd inertia = M * qdd;
    const Eigen::VectorXd residual =
        inertia + h + calc_potential_slope(scalars, state.q) + calc_dissipation_slope(scalars, state);
    worst.motion.take(residual.allFinite() ? residual.cwiseAbs().maxCoeff() / largest_term : std::nan(""));
  }
  return worst;
}

}  // namespace

Findings compute_energy_differences() {
  Findings findings;
  const std::string central = ", central differences of order 8 over " + number(kStep) + " rad or m";
  for (const CouplerCase& c : coupler_cases()) {
    const Differences worst = compare_slopes(c.parameters);
    const std::string at = ", " + c.name + ", 20 random states";
    const auto add = [&](const std::string& what, const std::string& reference, double difference,
                         double bound, const std::string& why) {
      findings.checks.push_back(limit(what + at, reference, difference, bound, "1", why));
    };
    add("mass matrix M",
        "second derivatives of the engine's kinetic energy T by the rates (exact, for T is quadratic in "
        "them)",
        worst.mass.value(), 1e-13, "rounding of T, relative to the largest entry of M");
    add("Coriolis and centrifugal terms h", "d/dt dT/dqd - dT/dq of the engine's kinetic energy T" + central,
        worst.coriolis.value(), 1e-10,
        "T rounds at 2e-16; over the step and times the sum of the rates (up to 200 rad/s) that is near "
        "1e-11 of h. Truncation, with no frequency "
        "above 2: (2 x 0.03)^8 2 / 630 = 5e-13 of the momenta, times the same sum");
    add("gravity terms g", "dV/dq of the engine's potential energy V without springs" + central,
        worst.gravity.value(), 1e-12,
        "V rounds at 2e-16, over the step 2e-14; truncation 0.03^8 / 630 = 1e-15");
    add("accelerations of the free chains, M qdd + h + g + s_f = 0",
        "Lagrange's equations with the engine's T, V and half of its lost power R" + central,
        worst.motion.value(), 1e-11,
        "rounding of T over the step and times the sum of the rates, and truncation of the same size, "
        "relative to the largest row "
        "of |M| |qdd|");
  }
  return findings;
}

}  // namespace validation
