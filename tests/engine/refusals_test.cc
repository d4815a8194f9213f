// SPDX-License-Identifier: Apache-2.0
// Refusals of input that is no linkage, before the run, and reports of linkages that lock during the run.

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "engine/errors.h"
#include "engine/model/rpsup.h"
#include "engine/model/rpsup_geometry.h"
#include "engine/simulate.h"
#include "engine/simulate_rpsup.h"

namespace engine {
namespace {

struct Refusal {
  const char* name;
  const char* field;
  std::function<void(RpsupParameters&, RunOptions&)> spoil;
};
void PrintTo(const Refusal& c, std::ostream* out) { *out << c.name; }

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Refusals : public testing::TestWithParam<Refusal> {};

TEST_P(Refusals, NameTheField) {
  RpsupParameters parameters;
  RunOptions options;
  EXPECT_NO_THROW(check_parameters(parameters, options));
  GetParam().spoil(parameters, options);
  try {
    check_parameters(parameters, options);
    FAIL() << "accepted";
  } catch (const InvalidInput& refusal) {
    EXPECT_EQ(refusal.field(), GetParam().field);
    EXPECT_FALSE(refusal.detail().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Engine, Refusals,
    testing::Values(
        Refusal{"negative_clearance", "c_r", [](auto& p, auto&) { p.c_r = -1e-4; }},
        Refusal{"clearance_of_the_whole_bearing", "c_r", [](auto& p, auto&) { p.c_r = p.bearing_radius; }},
        Refusal{"not_a_number", "crank_velocity", [](auto& p, auto&) { p.crank_velocity = kNan; }},
        Refusal{"infinite_stroke", "rod_stroke", [](auto& p, auto&) { p.rod_stroke = 1.0 / 0.0; }},
        Refusal{"no_mass", "links.1,2.mass", [](auto& p, auto&) { p.links[1].mass = 0.0; }},
        // The paper's own printed row for link (2,1).
        Refusal{"triangle_inequality", "links.2,1.inertia", [](auto& p, auto&) { p.links[3].inertia = {8.126e-4, 1.885e-4, 1.885e-4}; }},
        Refusal{"steiner", "links.1,3.inertia", [](auto& p, auto&) { p.links[2].inertia = {3.829e-6, 0.01, 0.01}; }},
        Refusal{"one_element", "rigid_elements", [](auto& p, auto&) { p.rigid_elements = 1; }},
        Refusal{"tube_without_a_wall", "crank.inner_diameter", [](auto& p, auto&) { p.crank.inner_diameter = p.crank.diameter; }},
        Refusal{"one_element_of_the_rod", "rod.elements", [](auto& p, auto&) { p.rod.elements = 1; }},
        Refusal{"negative_damping", "cross.damping_ratio", [](auto& p, auto&) { p.cross.damping_ratio = -1.0; }},
        Refusal{"negative_arm", "cross_length", [](auto& p, auto&) { p.cross_length = -0.1; }},
        Refusal{"flexible_without_a_length", "cross_length", [](auto& p, auto&) { p.cross.model = LinkModel::kFlexible; }},
        Refusal{"steiner_along_z", "links.2,2.inertia", [](auto& p, auto&) { p.cross_length = 0.1; }},
        Refusal{"poisson", "shear_modulus", [](auto& p, auto&) { p.shear_modulus = 0.5e11; }},
        Refusal{"restitution", "restitution", [](auto& p, auto&) { p.restitution = 1.1; }},
        Refusal{"no_restitution_by_flores", "restitution", [](auto& p, auto&) { p.restitution = 0.0; p.normal_law = NormalForceLaw::kFlores; }},
        Refusal{"wear_of_an_ideal_joint", "wear_depth", [](auto& p, auto&) { p.wear_depth = {{0, 0, 0}, {0, 0, 0}}; p.c_r = 0.0; }},
        Refusal{"wear_of_elements", "wear_depth", [](auto& p, auto&) { p.wear_depth = {{0, 0, 0}, {0, 0, 0}}; p.contact = ContactForm::kElements; }},
        Refusal{"wear_of_another_ring", "wear_depth", [](auto& p, auto&) { p.wear_depth = {{0, 0, 0}}; }},
        Refusal{"wear_of_other_sectors", "wear_depth", [](auto& p, auto&) { p.wear_depth = {{0, 0, 0}, {0, 0, 0, 0}}; }},
        Refusal{"wear_of_two_sectors", "wear_depth", [](auto& p, auto&) { p.wear_depth = {{0, 0}, {0, 0}}; }},
        Refusal{"deep_wear", "wear_depth", [](auto& p, auto&) { p.wear_depth = {{0, 0, 0}, {0, 0, 6e-4}}; }},
        Refusal{"wear_that_is_no_number", "wear_depth", [](auto& p, auto&) { p.wear_depth = {{0, 0, 0}, {0, 0, kNan}}; }},
        Refusal{"guide_angle_that_is_no_number", "guide_angle", [](auto& p, auto&) { p.guide_angle = kNan; }},
        Refusal{"rod_start_that_is_no_number", "rod_start", [](auto& p, auto&) { p.rod_start = kNan; }},
        Refusal{"crank_start_that_is_no_number", "crank_start", [](auto& p, auto&) { p.crank_start = kNan; }},
        Refusal{"yoke_on_the_guide", "yoke", [](auto& p, auto&) { p.guide_offset_z = 0.0; }},
        Refusal{"cylinder_of_an_element", "stiffness_law",
                [](auto& p, auto&) { p.stiffness_law = StiffnessLaw::kLiu; p.contact = ContactForm::kElements; }},
        Refusal{"ramp_that_falls", "v_1", [](auto& p, auto&) { p.friction = FrictionLaw::kAmbrosio; p.v_1 = p.v_0; }},
        Refusal{"guide_out_of_reach", "reach", [](auto& p, auto&) { p.guide_offset_z = 0.6; }},
        Refusal{"locks_on_the_way", "reach", [](auto& p, auto&) { p.guide_offset_z = 0.48; }},
        Refusal{"no_time", "duration", [](auto&, auto& o) { o.duration = 0.0; }},
        Refusal{"no_tolerance", "relative_tolerance", [](auto&, auto& o) { o.relative_tolerance = -1.0; }}),
    [](const auto& c) { return c.param.name; });

class IgnoringObserver : public Observer {
 public:
  void on_step(const Evaluation&, const Evaluation& end) override { last_t = end.t; }
  void on_sample(const Evaluation&) override { ++samples; }
  void on_onsets(int, int) override {}
  bool stop_requested(double t) override { return t > stop_at; }
  double last_t = 0.0;
  int samples = 0;
  double stop_at = std::numeric_limits<double>::infinity();
};

TEST(Runs, AGuideOutOfReachCannotBeAssembled) {
  RpsupParameters parameters;
  parameters.guide_offset_z = 0.6;  // 0.1 m beyond the coupler
  IgnoringObserver observer;
  const RunOutcome end = simulate(build_rpsup(parameters).mechanism, {}, observer);
  EXPECT_EQ(end.status, RunStatus::kAssembly);
  EXPECT_EQ(end.t, 0.0);
  EXPECT_NE(end.detail.find("cannot be closed"), std::string::npos);
  EXPECT_EQ(observer.samples, 0);
}

/// Time at which r sin psi reaches the end of the coupler's reach, by bisection of the closed form.
double lock_time(const RpsupParameters& parameters) {
  double free = 0.0;
  double locked = 2.0;
  while (locked - free > 1e-12) {
    const double middle = 0.5 * (free + locked);
    (calc_coupler_projection_squared(parameters, middle) > 0.0 ? free : locked) = middle;
  }
  return free;
}

TEST(Runs, ALinkageThatLocksSaysWhen) {
  RpsupParameters parameters;
  parameters.guide_offset_z = 0.48;  // reach left for r sin psi: 0.14 m of 0.15 m and more
  const double expected = lock_time(parameters);
  ASSERT_GT(expected, 0.1);
  parameters.c_r = 0.0;
  IgnoringObserver observer;
  const RunOutcome end = simulate(build_rpsup(parameters).mechanism, {}, observer);
  EXPECT_EQ(end.status, RunStatus::kLockUp);
  EXPECT_LE(end.t, expected);
  EXPECT_NEAR(end.t, expected, 5e-4);  // two steps of the solution
  EXPECT_EQ(observer.samples, static_cast<int>(1000.0 * end.t) + 1);  // what came before is kept
}

TEST(Runs, StopWhenAsked) {
  IgnoringObserver observer;
  observer.stop_at = 0.02;
  const RunOutcome end = simulate(build_rpsup({}).mechanism, {}, observer);
  EXPECT_EQ(end.status, RunStatus::kStopped);
  EXPECT_GT(end.t, 0.02);
  EXPECT_LT(end.t, 0.1);
}

TEST(Runs, EndAtTheirStepLimit) {
  RunOptions options;
  options.step_limit = 100;
  IgnoringObserver observer;
  const RunOutcome end = simulate(build_rpsup({}).mechanism, options, observer);
  EXPECT_EQ(end.status, RunStatus::kStepLimit);
  EXPECT_EQ(end.steps, 100);
}

TEST(Runs, AStepTooLargeForTheContactIsAFailureNotAResult) {
  RunOptions options;
  options.integrator = Integrator::kRk4;
  options.step = 1e-3;  // ten times the duration of an impact
  IgnoringObserver observer;
  const RunOutcome end = simulate(build_rpsup({}).mechanism, options, observer);
  EXPECT_EQ(end.status, RunStatus::kNonFinite);
  EXPECT_LT(end.t, options.duration);
}

}  // namespace
}  // namespace engine
