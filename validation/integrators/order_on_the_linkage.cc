// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/loop_closure.h"
#include "engine/model/rpsup.h"
#include "engine/simulate.h"
#include "validation/integrators/convergence.h"
#include "validation/integrators/parts.h"
#include "validation/reference/ideal_linkage.h"
#include "validation/support/equal_steps.h"
#include "validation/support/largest.h"

namespace validation {

namespace {

constexpr double kLinkageOrderDuration = 2.5;  // [s]; the corners of the drive laws fall on steps

RpsupParameters ideal() {
  RpsupParameters p;
  p.c_r = 0.0;
  p.rod_law = StrokeLaw::kCycloidal;  // equal steps have their order where no acceleration jumps
  return p;
}

/// Crank angle, rod displacement and slider position at the end.
double find_error(const RpsupLayout& layout, const Eigen::VectorXd& q) {
  const RpsupParameters p = ideal();
  Largest error;
  error.take(q[layout.crank] - calc_crank_angle(p, kLinkageOrderDuration).value());
  error.take(q[layout.rod] - calc_rod_displacement(p, kLinkageOrderDuration).value());
  error.take(q[layout.slider] - calc_slider(p, kLinkageOrderDuration).value());
  return error.value();
}

}  // namespace

Findings compute_order_on_the_linkage() {
  const Rpsup rpsup = build_rpsup(ideal());
  const Mechanism& mechanism = rpsup.mechanism;

  Ladder rk4;
  for (const double step : {1e-3, 5e-4, 2.5e-4}) {
    LastState last;
    (void)simulate(
        mechanism,
        {.duration = kLinkageOrderDuration, .output_rate = 1.0, .integrator = Integrator::kRk4, .step = step},
        last);
    rk4.add(step, find_error(rpsup.layout, last.q));
  }

  LoopClosure closure(mechanism);
  Evaluation assembled = MotionSystem(mechanism).make_evaluation();
  (void)closure.assemble(0.0, assembled);
  Ladder dopri5;
  for (const int count : {1250, 2500, 5000}) {
    const Evaluation at = take_equal_steps(mechanism, assembled, kLinkageOrderDuration, count);
    dopri5.add(kLinkageOrderDuration / count, find_error(rpsup.layout, at.q));
  }

  const char* reference = "closed form: drive laws, and the slider by Pythagoras";
  Findings findings;
  findings.checks.push_back(compare(
      "rk4, ideal rigid linkage at 10 rad/s after 2.5 s: observed order at steps of 0.5 and 0.25 ms",
      reference, rk4.observed_order(), 4.0, 0.1, "1", "the next term of the error, a part of the step"));
  findings.checks.push_back(compare(
      "dopri5 in equal steps, ideal rigid linkage at 10 rad/s after 2.5 s: observed order at steps of 1 and "
      "0.5 ms",
      reference, dopri5.observed_order(), 5.0, 0.2, "1", "the next term of the error, a part of the step"));
  findings.checks.push_back(
      limit("rk4 at 0.25 ms, ideal rigid linkage after 2.5 s: largest error of crank angle, rod and slider",
            reference, rk4.errors.back(), 2e-11, "rad or m", "twice what order 4 leaves"));
  return findings;
}

}  // namespace validation
