// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/rpsup.h"
#include "validation/kinematics/parts.h"
#include "validation/kinematics/stabilisation.h"
#include "validation/reference/ideal_linkage.h"
#include "validation/reference/paper_linkage.h"
#include "validation/reference/trace_form.h"
#include "validation/support/largest.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kLongestStep = 1e-3;  // [s], of the error-controlled method

struct DriftRun {
  Coupler coupler;
  DriveEnforcement drive;
  double step;  ///< [s], of rk4; 0: dopri5
};

/// Acceleration with which the constraints would open if the coordinates went on at constant rates and the
/// drives as they do, in the trace form: of the joint's centres apart, of z_b on x_j and y_j, of driven
/// coordinates from their laws.
class Opening {
 public:
  explicit Opening(const RpsupParameters& p) : p_(p), chains_(make_paper_chains(p)) {}

  [[nodiscard]] double calc(const Evaluation& at) const {
    const auto n = static_cast<FrameIndex>(chains_.coordinates.size());
    const std::array<double, 2> drives{calc_crank_angle(p_, at.t).derivative(2),
                                       calc_rod_displacement(p_, at.t).derivative(2)};
    const bool prescribed = p_.drive == DriveEnforcement::kPrescribed;
    const auto second = [&](FrameIndex frame) {
      Eigen::Matrix4d T_dd = calc_convective_transform(chains_, frame, at.q, at.qd);
      if (!prescribed) return T_dd;
      const FrameTransforms transforms = calc_transforms(chains_, frame, at.q);
      for (std::size_t k = 0; k < drives.size(); ++k) T_dd += transforms.T_i[k] * drives[k];
      return T_dd;
    };
    const auto first = [&](const FrameTransforms& frame) {
      Eigen::Matrix4d T_d = Eigen::Matrix4d::Zero();
      for (std::size_t k = 0; k < frame.T_i.size(); ++k)
        T_d += frame.T_i[k] * at.qd[static_cast<Eigen::Index>(k)];
      return T_d;
    };
    const FrameTransforms b = calc_transforms(chains_, n - 3, at.q);
    const FrameTransforms j = calc_transforms(chains_, n - 1, at.q);
    const Eigen::Matrix4d b_d = first(b), j_d = first(j), b_dd = second(n - 3), j_dd = second(n - 1);
    const Eigen::Vector4d B(calc_bearing_x(p_), 0.0, 0.0, 1.0);
    double largest = (j_dd.col(3) - b_dd * B).norm();
    for (const int axis : {0, 1})
      largest =
          std::max(largest, std::abs(b_dd.col(2).dot(j.T.col(axis)) + 2.0 * b_d.col(2).dot(j_d.col(axis)) +
                                     b.T.col(2).dot(j_dd.col(axis))));
    return prescribed ? largest : std::max({largest, std::abs(drives[0]), std::abs(drives[1])});
  }

 private:
  RpsupParameters p_;
  Mechanism chains_;
};

/// Largest magnitudes in a run.
struct Drift {
  Largest position, velocity;    ///< |Phi|, [m], [1]; |Phi_d|
  Largest opening;               ///< gamma
  Largest coordinates, rates;    ///< sums of their magnitudes
};

Drift measure_drift(const RpsupParameters& p, const RunOptions& options) {
  const Opening opening(p);
  Drift drift;
  double next_look = 0.0;
  const Mechanism mechanism = build_rpsup(p).mechanism;
  integrate(mechanism, options, [](Evaluation&) {}, [&](const Evaluation& at) {
    const Violation violation = read_violation(mechanism, at);
    for (const double row : violation.Phi) drift.position.take(row);
    for (const double row : violation.Phi_d) drift.velocity.take(row);
    if (at.t < next_look) return;
    next_look += 1e-3;
    drift.opening.take(opening.calc(at));
    drift.coordinates.take(at.q.lpNorm<1>());
    drift.rates.take(at.qd.lpNorm<1>());
  });
  return drift;
}

/// Largest drift that the local errors of a step can add up to.
struct Bound {
  double position, velocity;
};

/// Where a constraint opens with the acceleration gamma, one step of rk4 from the closed state ends at
/// (carried out by hand for a point on a parabola)
///
///     Phi = -alpha beta^2 gamma h^5 / 48,   Phi_d = (alpha^2 beta^2 / 24 - beta^4 / 96) gamma h^5,
///
/// to leading order. Rounding adds four roundings of every coordinate and rate. Stabilisation answers an
/// error e_q in Phi and e_v in Phi_d a step, of any signs, with at most (2 alpha e_q + e_v) / (h beta^2) in
/// Phi and (e_q + 2 e_v / (e alpha)) / h in Phi_d: integrals of the critically damped answers' magnitudes,
/// alpha = beta.
Bound calc_bound(const RpsupParameters& p, double h, const Drift& drift) {
  const double beta = p.baumgarte_beta;
  const double rounding = 4.0 * 0.5 * std::numeric_limits<double>::epsilon();
  const double e_q = std::pow(beta, 3) * drift.opening.value() * std::pow(h, 5) / 48.0 +
                     rounding * drift.coordinates.value();
  const double e_v =
      std::pow(beta, 4) * drift.opening.value() * std::pow(h, 5) / 32.0 + rounding * drift.rates.value();
  return {(2.0 * beta * e_q + e_v) / (h * beta * beta), (e_q + 2.0 / std::exp(1.0) / beta * e_v) / h};
}

std::string name_of_run(const DriftRun& run) {
  return std::string(run.coupler == Coupler::kRigid ? "rigid" : "flexible") + " coupler, drives " +
         (run.drive == DriveEnforcement::kPrescribed ? "prescribed" : "by multipliers") + ", " +
         (run.step > 0.0 ? "rk4 with steps of " + number(run.step) + " s, rod by the cycloidal law"
                         : "dopri5 with tolerances of 1e-6 and 1e-7");
}

Findings measure_all(const std::vector<DriftRun>& runs, RpsupParameters p, double duration) {
  Findings findings;
  const std::string span = number(duration) + " s, crank at " + number(p.crank_velocity) + " rad/s after " +
                           number(p.run_up) + " s";
  Table table{.caption = "Largest violation of the constraints of ideal joint and drives over " + span +
                         ", alpha = beta = 100 1/s. Lengths in m, angles in rad.",
              .head = {"run", "|Phi|", "bound of |Phi|", "|dPhi/dt| [1/s]", "bound of |dPhi/dt| [1/s]"},
              .rows = {},
              .reproducible_to = 10.0};
  Table openings{
      .caption = "Largest acceleration gamma with which the constraints would open at constant rates, over " +
                 span + ", each millisecond.",
      .head = {"run", "gamma [m/s^2, 1/s^2]"},
      .rows = {}};
  for (const DriftRun& run : runs) {
    p.coupler = run.coupler;
    p.drive = run.drive;
    const bool fixed = run.step > 0.0;
    p.rod_law = fixed ? StrokeLaw::kCycloidal
                      : RpsupParameters{}.rod_law;  // rk4 does not end its steps where an acceleration jumps
    RunOptions options{.duration = duration,
                       .integrator = Integrator::kDopri5,
                       .relative_tolerance = 1e-6,
                       .absolute_tolerance = 1e-7,
                       .step_limit = 1'000'000};
    if (fixed) {
      options.integrator = Integrator::kRk4;
      options.step = run.step;
    }
    const Drift drift = measure_drift(p, options);
    const Bound bound = calc_bound(p, fixed ? run.step : kLongestStep, drift);
    const std::string at = ", " + name_of_run(run) + ", " + span;
    const std::string why =
        fixed ? "what stabilisation leaves of rk4's errors and of rounding in a step, e_q and e_v: "
              : "that of rk4 with 1 ms, the longest step of this method of order 5: ";
    findings.checks.push_back(limit("largest |Phi|" + at, "the loop is closed", drift.position.value(),
                                    bound.position, "m or rad", why + "(2 alpha e_q + e_v) / (h beta^2)"));
    findings.checks.push_back(limit("largest |dPhi/dt|" + at, "the loop stays closed", drift.velocity.value(),
                                    bound.velocity, "m/s or rad/s", why + "(e_q + 2 e_v / (e alpha)) / h"));
    table.rows.push_back({name_of_run(run), number(drift.position.value(), 2), number(bound.position, 2),
                          number(drift.velocity.value(), 2), number(bound.velocity, 2)});
    openings.rows.push_back({name_of_run(run), number(drift.opening.value())});
  }
  findings.tables = {std::move(table), std::move(openings)};
  return findings;
}

RpsupParameters ideal_parameters() {
  RpsupParameters p;
  p.c_r = 0.0;
  return p;
}

/// The drift of two steps, one half of the other: its order.
void add_order(const RpsupParameters& p, Findings& findings) {
  const auto drift_at = [&](double step) {
    return measure_drift(p, {.duration = 0.75, .integrator = Integrator::kRk4, .step = step});
  };
  const Drift coarse = drift_at(1e-3);
  const Drift fine = drift_at(5e-4);
  const std::string what =
      ": order in the step, rigid coupler, drives by multipliers, rk4 with steps of 1 ms and 0.5 ms";
  const std::string why = "higher orders of h beta = 0.1 count some per cent, a tenth of an order";
  findings.checks.push_back(compare("drift |Phi|" + what, "order of rk4",
                                    std::log2(coarse.position.value() / fine.position.value()), 4.0, 0.15,
                                    "1", why));
  findings.checks.push_back(compare("drift |dPhi/dt|" + what, "order of rk4",
                                    std::log2(coarse.velocity.value() / fine.velocity.value()), 4.0, 0.15,
                                    "1", why));
}

}  // namespace

Findings compute_constraint_drift() {
  RpsupParameters p = ideal_parameters();
  p.run_up = 0.25;
  std::vector<DriftRun> runs;
  for (const DriveEnforcement drive : {DriveEnforcement::kPrescribed, DriveEnforcement::kBaumgarte}) {
    for (const double step : {1e-3, 5e-4, 1e-4, 1e-5, 0.0}) runs.push_back({Coupler::kRigid, drive, step});
    for (const double step : {5e-5, 0.0}) runs.push_back({Coupler::kFlexible, drive, step});
  }
  Findings findings = measure_all(runs, p, 0.75);
  p.drive = DriveEnforcement::kBaumgarte;
  add_order(p, findings);
  return findings;
}

Findings compute_long_constraint_drift() {
  std::vector<DriftRun> runs;
  for (const DriveEnforcement drive : {DriveEnforcement::kPrescribed, DriveEnforcement::kBaumgarte}) {
    for (const double step : {1e-4, 1e-5, 0.0}) runs.push_back({Coupler::kRigid, drive, step});
    for (const double step : {1e-5, 0.0}) runs.push_back({Coupler::kFlexible, drive, step});
  }
  return measure_all(runs, ideal_parameters(), 5.0);
}

}  // namespace validation
