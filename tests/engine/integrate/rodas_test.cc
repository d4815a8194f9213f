// SPDX-License-Identifier: Apache-2.0
// The coefficients of rodas5 by the order conditions, its order, stability and place among Odeint's steppers.

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Dense>
#include <boost/numeric/odeint/external/eigen/eigen_algebra.hpp>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/controlled_step_result.hpp>
#include <gtest/gtest.h>

#include "engine/integrate/rodas.h"

namespace engine {
namespace {

namespace odeint = boost::numeric::odeint;

using Rodas5 = Rodas5Coefficients;

/// The method in the form of the order conditions, from its own: Gamma = (1 / gamma - C)^-1, alpha = a Gamma, b = m Gamma.
struct ClassicalForm {
  Eigen::MatrixXd Gamma, alpha, beta;
  Eigen::VectorXd b, b_embedded;
};

ClassicalForm make_classical_form() {
  const auto s = static_cast<Eigen::Index>(Rodas5::kStages);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(s, s);
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(s, s);
  for (std::size_t i = 0; i < Rodas5::kStages; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      a(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = Rodas5::a[i][j];
      C(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = Rodas5::C[i][j];
    }
  ClassicalForm form;
  form.Gamma = (Eigen::MatrixXd::Identity(s, s) / Rodas5::gamma - C).inverse();
  form.alpha = a * form.Gamma;
  form.beta = form.alpha + form.Gamma;
  Eigen::VectorXd m = a.row(s - 1).transpose();
  form.b_embedded = form.Gamma.transpose() * m;
  m[s - 1] = 1.0;
  form.b = form.Gamma.transpose() * m;
  return form;
}

/// Defects of the sums over the trees of an order. Source: Hairer and Wanner, section IV.7, table 7.1 and the
/// rule behind the table, with beta_ij including the diagonal gamma: alpha where a vertex branches,
/// beta where it does not.
std::vector<double> find_defects(const ClassicalForm& m, const Eigen::VectorXd& b, int order) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(b.size());
  const Eigen::VectorXd alpha = m.alpha * ones;
  const Eigen::VectorXd beta = m.beta * ones;
  const Eigen::VectorXd alpha_2 = alpha.cwiseAbs2();
  const Eigen::VectorXd alpha_3 = alpha.cwiseProduct(alpha_2);
  const Eigen::VectorXd beta_2 = m.beta * beta;
  const Eigen::VectorXd alpha_beta = m.alpha * beta;
  switch (order) {
    case 1: return {b.sum() - 1.0};
    case 2: return {b.dot(beta) - 1.0 / 2.0};
    case 3: return {b.dot(alpha_2) - 1.0 / 3.0, b.dot(beta_2) - 1.0 / 6.0};
    case 4:
      return {b.dot(alpha_3) - 1.0 / 4.0, b.dot(alpha.cwiseProduct(alpha_beta)) - 1.0 / 8.0, b.dot(m.beta * alpha_2) - 1.0 / 12.0,
              b.dot(m.beta * beta_2) - 1.0 / 24.0};
    default:
      return {b.dot(alpha_2.cwiseAbs2()) - 1.0 / 5.0,
              b.dot(alpha_2.cwiseProduct(alpha_beta)) - 1.0 / 10.0,
              b.dot(alpha_beta.cwiseAbs2()) - 1.0 / 20.0,
              b.dot(alpha.cwiseProduct(m.alpha * alpha_2)) - 1.0 / 15.0,
              b.dot(alpha.cwiseProduct(m.alpha * beta_2)) - 1.0 / 30.0,
              b.dot(m.beta * alpha_3) - 1.0 / 20.0,
              b.dot(m.beta * alpha.cwiseProduct(alpha_beta)) - 1.0 / 40.0,
              b.dot(m.beta * (m.beta * alpha_2)) - 1.0 / 60.0,
              b.dot(m.beta * (m.beta * beta_2)) - 1.0 / 120.0};
  }
}

double largest(const std::vector<double>& defects) {
  double most = 0.0;
  for (const double defect : defects) most = std::max(most, std::abs(defect));
  return most;
}

constexpr double kRodasDigits = 1e-12;  // sixteen digits of coefficients up to 300

TEST(Rodas5Stepper, MeetsTheConditionsOfItsOrder) {
  const ClassicalForm m = make_classical_form();
  for (int order = 1; order <= Rodas5::kOrder; ++order) EXPECT_LT(largest(find_defects(m, m.b, order)), kRodasDigits) << order;
  for (int order = 1; order < Rodas5::kOrder; ++order) EXPECT_LT(largest(find_defects(m, m.b_embedded, order)), kRodasDigits) << order;
  EXPECT_GT(largest(find_defects(m, m.b_embedded, Rodas5::kOrder)), 1e-4);
}

// c and d are the row sums of alpha and Gamma: they are what a time that is one more entry of y would get.
TEST(Rodas5Stepper, TreatsTimeAsAnotherEntryOfTheState) {
  const ClassicalForm m = make_classical_form();
  for (std::size_t i = 0; i < Rodas5::kStages; ++i) {
    EXPECT_NEAR(m.alpha.row(static_cast<Eigen::Index>(i)).sum(), Rodas5::c[i], kRodasDigits) << i;
    EXPECT_NEAR(m.Gamma.row(static_cast<Eigen::Index>(i)).sum(), Rodas5::d[i], kRodasDigits) << i;
  }
}

// The last stages are formed from the one before.
TEST(Rodas5Stepper, ExtendsTheStageBefore) {
  for (std::size_t i = Rodas5::kFirstExtended; i < Rodas5::kStages; ++i)
    for (std::size_t j = 0; j + 1 < Rodas5::kStages; ++j)
      EXPECT_EQ(Rodas5::a[i][j], j + 1 == i ? 1.0 : Rodas5::a[i - 1][j]) << i << " " << j;
}

/// Dense linear algebra for a system given by f, J and df/dt.
struct System {
  std::function<Eigen::VectorXd(double, const Eigen::VectorXd&)> f;
  std::function<Eigen::MatrixXd(double, const Eigen::VectorXd&)> calc_J;
  std::function<Eigen::VectorXd(double, const Eigen::VectorXd&)> calc_f_t;
  int evaluations = 0;
  Eigen::MatrixXd J;
  Eigen::VectorXd f_t;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;

  void operator()(const Eigen::VectorXd& y, Eigen::VectorXd& dydt, double t) {
    ++evaluations;
    dydt = f(t, y);
  }
  void linearise(const Eigen::VectorXd& y, double t) {
    J = calc_J(t, y);
    f_t = calc_f_t(t, y);
  }
  [[nodiscard]] const Eigen::VectorXd& time_derivative() const { return f_t; }
  [[nodiscard]] bool factor(double shift) {
    lu.compute(shift * Eigen::MatrixXd::Identity(J.rows(), J.cols()) - J);
    return lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0;
  }
  void solve_in_place(Eigen::VectorXd& x) const { x = lu.solve(x); }
};

/// The solution that the system below is made for.
Eigen::VectorXd exact(double t) { return Eigen::Vector2d(std::exp(std::sin(t)), 1.0 / (2.0 + std::cos(t))); }

/// u' = cos(t) u + (u v)^2 - g^2, v' = sin(t) v^2 + sin(u v) - sin(g), with g(t) the exact u v.
System make_nonlinear_system() {
  System s;
  const auto g = [](double t) { return exact(t).prod(); };
  const auto g_t = [g](double t) { return g(t) * (std::cos(t) + std::sin(t) / (2.0 + std::cos(t))); };
  s.f = [g](double t, const Eigen::VectorXd& y) {
    const double p = y[0] * y[1];
    return Eigen::Vector2d(std::cos(t) * y[0] + p * p - g(t) * g(t), std::sin(t) * y[1] * y[1] + std::sin(p) - std::sin(g(t)));
  };
  s.calc_J = [](double t, const Eigen::VectorXd& y) {
    const double p = y[0] * y[1];
    Eigen::Matrix2d J;
    J << std::cos(t) + 2.0 * p * y[1], 2.0 * p * y[0], std::cos(p) * y[1], 2.0 * std::sin(t) * y[1] + std::cos(p) * y[0];
    return J;
  };
  s.calc_f_t = [g, g_t](double t, const Eigen::VectorXd& y) {
    return Eigen::Vector2d(-std::sin(t) * y[0] - 2.0 * g(t) * g_t(t), std::cos(t) * y[1] * y[1] - std::cos(g(t)) * g_t(t));
  };
  return s;
}

/// Error after [0, 1] in so many equal steps.
double calc_global_error(int steps) {
  System system = make_nonlinear_system();
  Rodas5Stepper stepper;
  Eigen::VectorXd y = exact(0.0);
  for (int k = 0; k < steps; ++k) stepper.do_step(std::ref(system), y, static_cast<double>(k) / steps, 1.0 / steps);
  return (y - exact(1.0)).norm();
}

TEST(Rodas5Stepper, IsOfItsOrder) {
  // The next term of the error is a part dt of it.
  const double order = std::log2(calc_global_error(32) / calc_global_error(64));
  EXPECT_NEAR(order, Rodas5::kOrder, 0.15);
}

/// Error estimate and error of one step from t = 0.3.
struct Local {
  double estimate, error;
};
Local calc_local(double dt) {
  System system = make_nonlinear_system();
  Rodas5Stepper stepper;
  Eigen::VectorXd end, estimate;
  stepper.do_step(std::ref(system), exact(0.3), 0.3, end, dt, estimate);
  return {estimate.norm(), (end - exact(0.3 + dt)).norm()};
}

TEST(Rodas5Stepper, EstimatesTheErrorOfAnEmbeddedMethodOfAnOrderLess) {
  const Local coarse = calc_local(0.04);
  const Local fine = calc_local(0.02);
  EXPECT_NEAR(std::log2(coarse.estimate / fine.estimate), Rodas5::kOrder, 0.15);
  EXPECT_NEAR(std::log2(coarse.error / fine.error), Rodas5::kOrder + 1, 0.25);
}

TEST(Rodas5Stepper, TakesNoEvaluationThatIsGiven) {
  System system = make_nonlinear_system();
  Rodas5Stepper stepper;
  const Eigen::VectorXd y = exact(0.0);
  Eigen::VectorXd dydt, end, error;
  system(y, dydt, 0.0);
  system.evaluations = 0;
  stepper.do_step(std::ref(system), y, dydt, 0.0, end, 0.1, error);
  EXPECT_EQ(system.evaluations, static_cast<int>(Rodas5::kStages) - 1);
  Eigen::VectorXd in_place = y;
  stepper.do_step(std::ref(system), in_place, 0.0, 0.1);
  EXPECT_EQ(in_place, end);
}

System make_linear_system(double lambda) {
  System s;
  s.f = [lambda](double, const Eigen::VectorXd& y) { return Eigen::VectorXd(lambda * y); };
  s.calc_J = [lambda](double, const Eigen::VectorXd& y) { return Eigen::MatrixXd(lambda * Eigen::MatrixXd::Identity(y.size(), y.size())); };
  s.calc_f_t = [](double, const Eigen::VectorXd& y) { return Eigen::VectorXd(Eigen::VectorXd::Zero(y.size())); };
  return s;
}

/// R(z) of a step of 1 of y' = z y, for complex z as a rotation.
double calc_growth(double re, double im) {
  Eigen::Matrix2d A;
  A << re, -im, im, re;
  System s = make_linear_system(0.0);
  s.f = [A](double, const Eigen::VectorXd& y) { return Eigen::VectorXd(A * y); };
  s.calc_J = [A](double, const Eigen::VectorXd&) { return A; };
  Rodas5Stepper stepper;
  Eigen::VectorXd y = Eigen::Vector2d(1.0, 0.0);
  stepper.do_step(std::ref(s), y, 0.0, 1.0);
  return y.norm();
}

TEST(Rodas5Stepper, IsLStable) {
  EXPECT_LT(calc_growth(-1e10, 0.0), 1e-8);
  EXPECT_LT(calc_growth(0.0, 1e8), 1e-6);
  // On the imaginary axis |R| <= 1: that and the poles on the right make the method A-stable.
  for (double w = 1e-2; w < 1e6; w *= 1.2) EXPECT_LE(calc_growth(0.0, w), 1.0 + 1e-12) << w;
}

TEST(Rodas5Stepper, FollowsASlowSolutionOfAStiffSystemInBigSteps) {
  static constexpr double kRate = -1e10;
  System s;
  s.f = [](double t, const Eigen::VectorXd& y) { return Eigen::VectorXd::Constant(1, kRate * (y[0] - std::cos(t))); };
  s.calc_J = [](double, const Eigen::VectorXd&) { return Eigen::MatrixXd::Constant(1, 1, kRate); };
  s.calc_f_t = [](double t, const Eigen::VectorXd&) { return Eigen::VectorXd::Constant(1, -kRate * std::sin(t)); };
  Rodas5Stepper stepper;
  Eigen::VectorXd y = Eigen::VectorXd::Constant(1, 2.0);  // far from the solution: one step forgets it
  for (int k = 0; k < 20; ++k) {
    stepper.do_step(std::ref(s), y, 0.1 * k, 0.1);
    EXPECT_NEAR(y[0], std::cos(0.1 * (k + 1)), 1e-6) << k;
  }
}

TEST(Rodas5Stepper, ReportsASingularMatrixAsNoNumber) {
  System s = make_linear_system(1.0 / Rodas5::gamma);  // equal to 1 / (gamma dt)
  Rodas5Stepper stepper;
  Eigen::VectorXd y = Eigen::VectorXd::Ones(1);
  Eigen::VectorXd error;
  stepper.do_step(std::ref(s), y, 0.0, 1.0, error);
  EXPECT_TRUE(std::isnan(y[0]));
  EXPECT_TRUE(std::isnan(error[0]));
}

TEST(Rodas5Stepper, IsDrivenByOdeintsLoopOfEqualSteps) {
  System system = make_nonlinear_system();
  Eigen::VectorXd ours = exact(0.0);
  Rodas5Stepper stepper;
  for (int k = 0; k < 16; ++k) stepper.do_step(std::ref(system), ours, 0.0625 * k, 0.0625);
  Eigen::VectorXd y = exact(0.0);
  std::vector<double> times;
  const std::size_t steps = odeint::integrate_const(Rodas5Stepper(), std::ref(system), y, 0.0, 1.0, 0.0625,
                                                    [&](const Eigen::VectorXd&, double t) { times.push_back(t); });
  EXPECT_EQ(steps, 16u);
  EXPECT_EQ(times.size(), 17u);
  EXPECT_EQ(y, ours);
}

// Odeint's controller wants to know that it may give f at the start of the step; it calls that an explicit error stepper.
TEST(Rodas5Stepper, IsDrivenByOdeintsErrorControl) {
  using Stepper = Rodas5Stepper;
  using Checker = odeint::default_error_checker<double, typename Stepper::algebra_type, typename Stepper::operations_type>;
  using Controlled = odeint::controlled_runge_kutta<Stepper, Checker, odeint::default_step_adjuster<double, double>,
                                                    typename Stepper::resizer_type, odeint::explicit_error_stepper_tag>;
  std::vector<double> errors;
  for (const double tolerance : {1e-6, 1e-9}) {
    System system = make_nonlinear_system();
    Eigen::VectorXd y = exact(0.0);
    const std::size_t steps = odeint::integrate_adaptive(Controlled(Checker(tolerance, tolerance)), std::ref(system), y, 0.0, 2.0, 1e-3);
    EXPECT_GT(steps, 3u);
    errors.push_back((y - exact(2.0)).norm());
    EXPECT_LT(errors.back(), 100.0 * tolerance);
  }
  EXPECT_LT(errors[1], 0.02 * errors[0]);
}

}  // namespace
}  // namespace engine
