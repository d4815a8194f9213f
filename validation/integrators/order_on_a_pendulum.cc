// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>

#include "charts/chart.h"
#include "validation/integrators/convergence.h"
#include "validation/integrators/parts.h"
#include "validation/support/equal_steps.h"
#include "validation/support/largest.h"
#include "validation/support/simple_mechanisms.h"
#include "validation/support/text.h"

namespace validation {

namespace {

// A compound pendulum let go at 2.5 rad from its rest, in a field that makes it swing some 80 times a second: then it is the tolerance
// that decides the steps, not the longest one that the engine takes (1 ms).
constexpr double kPendulumGravity = 1e5;   // [m/s^2]
constexpr double kPendulumMass = 2.0;      // [kg]
constexpr double kArm = 0.3;       // to the centre of mass, [m]
constexpr double kPendulumInertia = 0.25;  // about the pivot, [kg m^2]
constexpr double kPendulumStart = 2.5;     // [rad]
constexpr double kPendulumDuration = 0.02; // [s]
constexpr double kDown = -0.5 * std::numbers::pi;  // the coordinate of its rest

Mechanism make_pendulum() {
  Mechanism m;
  m.coordinates.push_back({.name = "angle", .placement = {}, .axis = Axis::kZ, .mass = kPendulumMass, .com = {kArm, 0.0, 0.0},
                           .inertia = Eigen::Vector3d(0.01, kPendulumInertia, kPendulumInertia).asDiagonal()});
  m.gravity_W = {0.0, -kPendulumGravity, 0.0};
  return m;
}

/// sin(angle / 2) = k sn(omega t + K(k), k), k = sin(start / 2), omega^2 = m g s / I.
double exact_angle(double t) {
  const long double k = std::sin(0.5L * static_cast<long double>(kPendulumStart));
  const long double omega = std::sqrt(static_cast<long double>(kPendulumMass * kPendulumGravity * kArm / kPendulumInertia));
  const long double u = omega * static_cast<long double>(t) + boost::math::ellint_1(k);
  return static_cast<double>(2.0L * std::asin(k * boost::math::jacobi_sn(k, u)));
}

double calc_error(double coordinate) { return std::abs(coordinate - kDown - exact_angle(kPendulumDuration)); }

struct ControlledRun {
  double error;
  long steps;
};

ControlledRun swing(const RunOptions& options) {
  LastState last;
  const RunOutcome end = run_from(make_pendulum(), options, Eigen::VectorXd::Constant(1, kPendulumStart + kDown), Eigen::VectorXd::Zero(1), last);
  return {calc_error(last.q[0]), end.steps};
}

Ladder climb_rk4() {
  Ladder ladder;
  for (const int count : {100, 200, 400, 800, 1600}) {
    const double step = kPendulumDuration / count;
    ladder.add(step, swing({.duration = kPendulumDuration, .output_rate = 1.0, .integrator = Integrator::kRk4, .step = step}).error);
  }
  return ladder;
}

Ladder climb_dopri5() {
  Ladder ladder;
  const Mechanism pendulum = make_pendulum();
  Evaluation start = MotionSystem(pendulum).make_evaluation();
  start.q[0] = kPendulumStart + kDown;
  for (const int count : {50, 100, 200, 400}) ladder.add(kPendulumDuration / count, calc_error(take_equal_steps(pendulum, start, kPendulumDuration, count).q[0]));
  return ladder;
}

}  // namespace

Findings compute_order_on_a_pendulum() {
  const Ladder rk4 = climb_rk4();
  const Ladder dopri5 = climb_dopri5();
  Ladder controlled;
  Largest worst;
  Table table{.caption = "The pendulum with error control: the error follows the tolerance.",
              .head = {"tolerance, relative and absolute", "steps", "error of the angle [rad]", "error over tolerance"},
              .reproducible_to = 0.1};
  std::vector<double> tolerances;
  for (int exponent = 4; exponent <= 12; ++exponent) {
    const double tolerance = std::pow(10.0, -exponent);
    const ControlledRun r = swing({.duration = kPendulumDuration, .output_rate = 1.0, .integrator = Integrator::kDopri5, .relative_tolerance = tolerance,
                                 .absolute_tolerance = tolerance});
    controlled.add(kPendulumDuration / static_cast<double>(r.steps), r.error);
    tolerances.push_back(tolerance);
    worst.take(r.error / tolerance);
    if (exponent < 12) table.rows.push_back({number(tolerance), std::to_string(r.steps), number(r.error, 2), number(r.error / tolerance, 2)});
  }
  const char* reference = "closed form in Jacobi's elliptic functions (Boost.Math)";
  const char* next_term = "the next term of the error, a part of the step";
  Findings findings;
  findings.checks.push_back(compare("rk4, pendulum of 78 swings a second: observed order at steps of 25 and 12.5 us", reference,
                                    rk4.observed_order(), 4.0, 0.05, "1", next_term));
  findings.checks.push_back(compare("dopri5 in equal steps, pendulum of 78 swings a second: observed order at steps of 100 and 50 us", reference,
                                    dopri5.observed_order(), 5.0, 0.1, "1", next_term));
  const std::size_t n = tolerances.size();
  findings.checks.push_back(compare("dopri5 with error control: exponent of the error over the tolerance, 1e-8 to 1e-12", reference,
                                    std::log(controlled.errors[n - 5] / controlled.errors[n - 1]) / std::log(tolerances[n - 5] / tolerances[n - 1]),
                                    1.0, 0.1, "1", "a quarter more or less of error at either end"));
  findings.checks.push_back(compare("dopri5 with error control: exponent of the error over the mean step, 1e-8 to 1e-12", reference,
                                    std::log(controlled.errors[n - 5] / controlled.errors[n - 1]) / std::log(controlled.steps[n - 5] / controlled.steps[n - 1]),
                                    5.0, 0.4, "1", "a run begins with some steps that are smaller than it needs"));
  findings.checks.push_back(limit("dopri5 with error control: largest error over tolerance, 1e-4 to 1e-12", reference, worst.value(), 1.0, "1",
                                  "the error of 1.6 swings is of the size of the tolerance"));
  charts::Chart chart{.title = "error of the angle [rad]", .x_label = "step, or mean step [s]", .y_label = "", .x_scale = charts::Scale::kLog, .y_scale = charts::Scale::kLog,
              .y_min = 2e-13, .y_max = 1e-2};
  chart.series.push_back({.label = "rk4", .x = rk4.steps, .y = rk4.errors, .colour = charts::kBlue, .markers = true});
  chart.series.push_back({.label = "dopri5, equal steps", .x = dopri5.steps, .y = dopri5.errors, .colour = charts::kOrange, .markers = true});
  chart.series.push_back({.label = "dopri5, error control", .x = controlled.steps, .y = controlled.errors, .colour = charts::kGreen, .markers = true});
  findings.tables.push_back(std::move(table));
  findings.figures.push_back({"integrators_order.svg", "Where the motion is smooth the errors fall with the methods' orders, 4 and 5.",
                              charts::draw({chart}, 1)});
  return findings;
}

}  // namespace validation
