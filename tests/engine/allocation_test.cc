// SPDX-License-Identifier: Apache-2.0
// The right-hand side allocates nothing, and a run that finds no memory says so: this program counts every
// allocation, and fails one of them. The linker sends malloc() to __wrap_malloc() (CMakeLists.txt).

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
#include "engine/simulate_linkage.h"
#include "engine/simulate_rpsup.h"
#include "tests/engine/linkage_cases.h"

namespace {
std::atomic<long> allocations{0};
std::atomic<long> failing{-1};  ///< number of the allocation that fails
}

extern "C" {
void* __real_malloc(std::size_t size);
void* __wrap_malloc(std::size_t size) {
  return allocations++ == failing ? nullptr : __real_malloc(size);
}
}

// Not inlined: the compiler would see malloc meet delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
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
  StepPoint start, end;
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

enum class FailFrom { kBeginning, kFirstStep };

/// Makes each allocation of a run fail once. Memory that is freed twice ends the program.
/// @returns how many runs ended for want of memory
/// @param simulate  makes the run
long fail_each_allocation(const std::function<void(const StopQuery&)>& simulate, FailFrom from) {
  long start = 0, first_step = 0;
  const auto run = [&] {
    start = allocations;
    first_step = 0;
    simulate([&](double) {
      if (first_step == 0) first_step = allocations - start;
      return false;
    });
  };
  run();  // fills tables that stay
  run();
  const long count = allocations - start;
  long ended = 0;
  for (long k = from == FailFrom::kBeginning ? 0 : first_step; k < count; ++k) {
    failing = allocations + k;
    try {
      run();
    } catch (const std::bad_alloc&) {
      ++ended;
    }
    failing = -1;
  }
  return ended;
}

long fail_each_allocation(const RpsupParameters& parameters, const RunOptions& options, FailFrom from) {
  return fail_each_allocation([&](const StopQuery& stop) { (void)simulate_rpsup(parameters, options, stop); }, from);
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

TEST(Run, EndsCleanlyWhereverMemoryRunsOut) {
  EXPECT_GT(fail_each_allocation({}, {.duration = 0.005, .output_rate = 100.0}, FailFrom::kBeginning), 500);
}

TEST(Run, OfALinkageEndsCleanlyWhereverMemoryRunsOut) {
  Linkage linkage = make_loose_loops(*build_rpsup({}).mechanism.cut_joints[0].clearance);
  linkage.springs = {{.name = "stay", .from = kGroundName, .to = linkage.bodies[0].name, .at = {0.3, 0.2, 0.1}, .stiffness = 10.0}};
  linkage.loads = {{.name = "thrust", .body = linkage.bodies[0].name, .force = {0.0, 0.1, 0.0}, .law = Constant{1.0}}};
  linkage.accelerometers = {{.name = "sensor", .body = linkage.bodies[0].name}};
  const RunOptions options{.duration = 1e-3, .output_rate = 1000.0};
  EXPECT_GT(fail_each_allocation([&](const StopQuery& stop) { (void)simulate_linkage(linkage, options, 0.0, stop); }, FailFrom::kBeginning),
            500);
}

TEST(Run, EndsCleanlyWhereTheCheckOfStabilityFindsNoMemory) {
  RpsupParameters rubbing;
  rubbing.run_up = 0.02;
  const RunOptions options{.duration = 0.03, .output_rate = 100.0};
  EXPECT_GT(fail_each_allocation(rubbing, options, FailFrom::kFirstStep), 100);
}

// The journal touches more elements than have bristles: the state gets another size.
TEST(Run, EndsCleanlyWhereBristlesFindNoMemory) {
  RpsupParameters elements =
      with(Coupler::kRigid, ContactForm::kElements, 0.25e-3, DriveEnforcement::kPrescribed);
  elements.radial_elements = 300;
  elements.run_up = 0.02;
  for (const Integrator integrator : {Integrator::kRadau5, Integrator::kRodas5, Integrator::kDopri5}) {
    const RunOptions options{.duration = 0.02, .output_rate = 100.0, .integrator = integrator};
    EXPECT_GT(fail_each_allocation(elements, options, FailFrom::kFirstStep), 100);
  }
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
