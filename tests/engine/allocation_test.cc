// SPDX-License-Identifier: Apache-2.0
// The right-hand side allocates nothing: this program counts every operator new.

#include <atomic>
#include <cstdlib>
#include <functional>
#include <new>
#include <utility>

#include <gtest/gtest.h>

#include "engine/dynamics/loop_closure.h"
#include "engine/integrate/odeint_steppers.h"
#include "engine/integrate/radau.h"
#include "engine/model/rpsup.h"

namespace {
std::atomic<long> allocations{0};
}

// Not inlined: the compiler would see malloc meet delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace engine {
namespace {

struct AllocationCase {
  const char* name;
  RpsupParameters parameters;
};
void PrintTo(const AllocationCase& c, std::ostream* out) { *out << c.name; }

class RightHandSide : public testing::TestWithParam<AllocationCase> {};

TEST_P(RightHandSide, AllocatesNothing) {
  const Rpsup rpsup = build_rpsup(GetParam().parameters);
  const Mechanism& mechanism = rpsup.mechanism;
  MotionSystem system(mechanism);
  Evaluation assembled = system.make_evaluation();
  ASSERT_TRUE(LoopClosure(mechanism).assemble(0.0, assembled));
  assembled.q[rpsup.layout.slider] += 0.256e-3;  // along the guide, at right angles to the bearing's axis: 6 um into contact
  StepEnd start, end;
  start.y = system.make_state(assembled.q, assembled.qd);
  start.f = Eigen::VectorXd::Zero(start.y.size());
  start.at = system.make_evaluation();
  end = start;
  const Tolerance tolerance(1e-6, 1e-6);
  Dopri5 method(tolerance);
  (void)system.calc_derivative(0.0, start.y, start.f, start.at);
  (void)system.prepare_step(start.at, 1e-9, start.y);  // the elements' bristles go where the contact is
  ASSERT_EQ(system.calc_derivative(0.0, start.y, start.f, start.at), EvaluationStatus::kOk);
  EXPECT_EQ(start.at.joints[0].load.max_penetration > 0.0, GetParam().parameters.c_r > 0.0);
  for (const Shifts shifts : {Shifts::kReal, Shifts::kRealAndComplex})
    EXPECT_EQ(system.choose_newton_solver(shifts) == NewtonSolver::kRecursive, GetParam().parameters.rigid_elements > 4);
  Rodas5 rodas(tolerance);
  Radau5 radau(tolerance);
  ASSERT_EQ(method.try_step(system, start, 1e-9, end).status, EvaluationStatus::kOk);  // the methods' own vectors
  ASSERT_EQ(rodas.try_step(system, start, 1e-9, end).status, EvaluationStatus::kOk);
  for (int i = 0; i < 2; ++i) {  // the second one has a step before it
    ASSERT_EQ(radau.try_step(system, start, 1e-9, end).status, EvaluationStatus::kOk);
    radau.accept();
  }

  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(method.try_step(system, start, 1e-9, end).status, EvaluationStatus::kOk);
    rodas.accept();
    ASSERT_EQ(rodas.try_step(system, start, 1e-9, end).status, EvaluationStatus::kOk);
    if (i % 2 == 0) radau.invalidate();
    ASSERT_EQ(radau.try_step(system, start, 1e-9, end).error <= 1.0, true);
    radau.accept();
    system.calc_energies(end.at);
  }
  EXPECT_EQ(allocations - before, 0);
}

TEST(LoopClosure, AllocatesNothing) {
  const Mechanism mechanism = build_ideal_rpsup({}).mechanism;
  LoopClosure closure(mechanism);
  Evaluation at = MotionSystem(mechanism).make_evaluation();
  ASSERT_TRUE(closure.assemble(0.0, at));
  Evaluation earlier = at;
  ASSERT_TRUE(closure.solve(1e-3, at));
  const long before = allocations;
  for (int i = 2; i < 100; ++i) {
    closure.extrapolate(1e-3 * i, earlier, at, earlier);
    ASSERT_TRUE(closure.solve(1e-3 * i, earlier));
    std::swap(earlier, at);
  }
  EXPECT_EQ(allocations - before, 0);
}

RpsupParameters with(Coupler coupler, ContactForm contact, double c_r, DriveEnforcement drive) {
  RpsupParameters p;
  p.coupler = coupler;
  p.contact = contact;
  p.c_r = c_r;
  p.drive = drive;
  return p;
}

/// So many that an implicit step's systems are solved body by body.
RpsupParameters with_parts(int rigid_elements) {
  RpsupParameters parameters = with(Coupler::kFlexible, ContactForm::kElements, 0.25e-3, DriveEnforcement::kPrescribed);
  parameters.rigid_elements = rigid_elements;
  return parameters;
}

/// y' = -y, entry by entry.
struct DecaySystem {
  Eigen::VectorXd f_t;
  double shift = 0.0;
  void operator()(const Eigen::VectorXd& y, Eigen::VectorXd& dydt, double) { dydt = -y; }
  void linearise(const Eigen::VectorXd& y, double) { f_t.setZero(y.size()); }
  [[nodiscard]] const Eigen::VectorXd& time_derivative() const { return f_t; }
  [[nodiscard]] bool factor(double s) {
    shift = s;
    return true;
  }
  void solve_in_place(Eigen::VectorXd& x) const { x /= shift + 1.0; }
};

TEST(Rodas5Stepper, AllocatesNothingAfterItsFirstStep) {
  DecaySystem system;
  Rodas5Stepper stepper;
  Eigen::VectorXd y = Eigen::VectorXd::Ones(40);
  Eigen::VectorXd dydt = -y;
  Eigen::VectorXd end = y;
  Eigen::VectorXd error = y;
  stepper.do_step(std::ref(system), y, dydt, 0.0, end, 0.1, error);
  const long before = allocations;
  for (int i = 0; i < 100; ++i) stepper.do_step(std::ref(system), y, dydt, 0.0, end, 0.1, error);
  for (int i = 0; i < 100; ++i) stepper.do_step(std::ref(system), y, 0.0, 0.1);
  EXPECT_EQ(allocations - before, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, RightHandSide,
    testing::Values(
        AllocationCase{"rigid", with(Coupler::kRigid, ContactForm::kContinuum, 0.25e-3, DriveEnforcement::kPrescribed)},
        AllocationCase{"flexible", with(Coupler::kFlexible, ContactForm::kContinuum, 0.25e-3, DriveEnforcement::kPrescribed)},
        AllocationCase{"elements", with(Coupler::kFlexible, ContactForm::kElements, 0.25e-3, DriveEnforcement::kPrescribed)},
        AllocationCase{"body_by_body", with_parts(16)},
        AllocationCase{"ideal", with(Coupler::kFlexible, ContactForm::kContinuum, 0.0, DriveEnforcement::kPrescribed)},
        AllocationCase{"multipliers", with(Coupler::kRigid, ContactForm::kContinuum, 0.0, DriveEnforcement::kBaumgarte)}),
    [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace engine
