// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/rpsup.h"
#include "charts/chart.h"
#include "validation/kinematics/parts.h"
#include "validation/kinematics/stabilisation.h"
#include "validation/support/largest.h"
#include "validation/support/random.h"
#include "validation/support/text.h"

namespace validation {

namespace {

struct Stabilisation {
  Coupler coupler;
  double alpha, beta;
  double step;  ///< [s]
};

/// Solution of Phi_dd + 2 alpha Phi_d + beta^2 Phi = 0 from given Phi and Phi_d. The equation holds for any
/// violation: the accelerations are chosen to make it hold.
double calc_law(const Stabilisation& s, double Phi, double Phi_d, double t) {
  const double decay = std::exp(-s.alpha * t);
  const double rate = Phi_d + s.alpha * Phi;
  if (s.alpha == s.beta) return decay * (Phi + rate * t);
  if (s.alpha < s.beta) {
    const double w = std::sqrt(s.beta * s.beta - s.alpha * s.alpha);
    return decay * (Phi * std::cos(w * t) + rate / w * std::sin(w * t));
  }
  const double w = std::sqrt(s.alpha * s.alpha - s.beta * s.beta);
  return decay * (Phi * std::cosh(w * t) + rate / w * std::sinh(w * t));
}

/// Rows of ideal joint and both drives over 0.1 s, from a state violated at random by up to 1 mm, 1 mrad and
/// 0.1 m/s, 0.1 rad/s.
struct History {
  Eigen::VectorXd Phi, Phi_d;          ///< at the start
  std::vector<double> t;
  std::vector<Eigen::VectorXd> rows;   ///< Phi at the steps' ends
};

History record(const Stabilisation& s) {
  RpsupParameters p;
  p.coupler = s.coupler;
  p.c_r = 0.0;
  p.run_up = 0.25;
  p.drive = DriveEnforcement::kBaumgarte;
  p.baumgarte_alpha = s.alpha;
  p.baumgarte_beta = s.beta;
  const Mechanism mechanism = build_rpsup(p).mechanism;
  History history;
  const auto disturb = [&](Evaluation& start) {
    Random random(5);
    for (Eigen::Index i = 0; i < start.q.size(); ++i) {
      // the coupler starts straight
      if (mechanism.coordinates[static_cast<std::size_t>(i)].stiffness > 0.0) continue;
      start.q[i] += random.symmetric(1e-3);
      start.qd[i] += random.symmetric(0.1);
    }
    calc_frame_motions(mechanism, start.q, start.qd, Eigen::VectorXd::Zero(start.q.size()), start.frames);
    const Violation violation = read_violation(mechanism, start);
    history.Phi = violation.Phi;
    history.Phi_d = violation.Phi_d;
  };
  integrate(mechanism, {.duration = 0.1, .integrator = Integrator::kRk4, .step = s.step}, disturb,
            [&](const Evaluation& at) {
              history.t.push_back(at.t);
              history.rows.push_back(read_violation(mechanism, at).Phi);
            });
  return history;
}

charts::Chart draw_decay(const Stabilisation& s, const History& history) {
  charts::Chart chart{.title = "alpha = " + number(s.alpha) + " 1/s, beta = " + number(s.beta) + " 1/s",
                      .x_label = "t [s]",
                      .y_label = "Phi [mm]"};
  const char* names[] = {"gap along x", "gap along y", "gap along z"};
  const char* colours[] = {charts::kBlue, charts::kOrange, charts::kGreen};
  for (Eigen::Index row = 0; row < 3; ++row) {
    charts::Series run{.label = std::string(names[row]) + ", run", .x = {}, .y = {}, .colour = colours[row]};
    charts::Series law{.label = row == 0 ? "law" : "",
                       .x = {},
                       .y = {},
                       .colour = charts::kGrey,
                       .markers = true,
                       .width = 0.0};
    const std::size_t stride = history.t.size() / 500;
    for (std::size_t k = 0; k < history.t.size(); k += stride) {
      run.x.push_back(history.t[k]);
      run.y.push_back(1e3 * history.rows[k][row]);
      if (k % (25 * stride) != 0) continue;
      law.x.push_back(history.t[k]);
      law.y.push_back(1e3 * calc_law(s, history.Phi[row], history.Phi_d[row], history.t[k]));
    }
    chart.series.push_back(std::move(run));
    chart.series.push_back(std::move(law));
  }
  return chart;
}

Check compare_decay(const Stabilisation& s, const History& history) {
  Largest worst;
  for (std::size_t k = 0; k < history.t.size(); ++k)
    for (Eigen::Index row = 0; row < history.Phi.size(); ++row)
      worst.take(history.rows[k][row] - calc_law(s, history.Phi[row], history.Phi_d[row], history.t[k]));
  const double largest = history.Phi.cwiseAbs().maxCoeff();
  const std::string of = std::string(s.coupler == Coupler::kRigid ? "rigid" : "flexible") +
                         " coupler, alpha = " + number(s.alpha) + " 1/s, beta = " + number(s.beta) + " 1/s";
  return limit("violation of joint and drives over 0.1 s from a disturbed start, " + of,
               "solution of Phi_dd + 2 alpha Phi_d + beta^2 Phi = 0", worst.value() / largest, 1e-8, "1",
               "drift of rk4 with steps of " + number(s.step) +
                   " s, at most 5e-12 m or rad, relative to the first violation");
}

constexpr Stabilisation kStabilisations[] = {{Coupler::kRigid, 100.0, 100.0, 1e-4},
                                             {Coupler::kRigid, 20.0, 100.0, 1e-4},
                                             {Coupler::kRigid, 150.0, 60.0, 1e-4},
                                             {Coupler::kFlexible, 100.0, 100.0, 2e-5}};

}  // namespace

Findings compute_violation_decay() {
  Findings findings;
  std::vector<charts::Chart> charts;
  for (const Stabilisation& s : kStabilisations) {
    const History history = record(s);
    findings.checks.push_back(compare_decay(s, history));
    if (s.coupler == Coupler::kRigid) charts.push_back(draw_decay(s, history));
  }
  findings.figures.push_back(
      {"violation_decay.svg",
       "A violated joint closes as the stabilisation's equation says (rigid coupler, drives by multipliers).",
       charts::draw(charts, 3, 400, 280)});
  return findings;
}

}  // namespace validation
