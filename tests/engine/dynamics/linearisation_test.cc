// SPDX-License-Identifier: Apache-2.0
// The Jacobian of the equations of motion against differences of themselves, and the instruction sets against each other.

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "validation/support/across_rpsup.h"
#include "tests/engine/linkage_cases.h"

namespace engine {
namespace {

struct Case {
  std::string name;
  Mechanism mechanism;
  FrameIndex pressed;  ///< coordinate that stands off from where the loop closes, so that the journal is pressed into the bearing
  double offset;       ///< of it, [m] or [rad]
  double step;         ///< of the differences, [m] or [rad]: far below the penetration, or far above rounding where nothing touches
  double disturbance = 1.0;  ///< of the rates: those of dependent constraints must fit, or the least multipliers are another kind of solution
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> all_cases() {
  RpsupParameters rigid = validation::across_rpsup();
  rigid.v_s = 1.0;  // Stribeck's curve then bends over the whole range of the rates below
  RpsupParameters flexible = rigid;
  flexible.coupler = Coupler::kFlexible;
  RpsupParameters elements = rigid;
  elements.contact = ContactForm::kElements;
  RpsupParameters flexible_elements = flexible;
  flexible_elements.contact = ContactForm::kElements;
  RpsupParameters apart = rigid;
  apart.c_a = 1e-3;
  RpsupParameters rows = flexible;
  rows.drive = DriveEnforcement::kBaumgarte;
  RpsupParameters rigid_rows = rigid;  // an odd number of free coordinates that no code is specialised for
  rigid_rows.drive = DriveEnforcement::kBaumgarte;
  RpsupParameters ideal = flexible;
  ideal.c_r = 0.0;
  RpsupParameters ideal_rigid = rigid;
  ideal_rigid.c_r = 0.0;
  RpsupParameters plastic = rigid;  // Kelvin and Voigt's damper, a logarithmic stiffness, elasto-plastic bristles
  plastic.normal_law = NormalForceLaw::kKelvinVoigt;
  plastic.stiffness_law = StiffnessLaw::kRadzimovsky;
  plastic.friction = FrictionLaw::kElastoPlastic;
  plastic.break_away = 0.01;
  RpsupParameters no_bristles = flexible;
  no_bristles.stiffness_law = StiffnessLaw::kLiu;
  no_bristles.friction = FrictionLaw::kAmbrosio;
  no_bristles.v_1 = 10.0;
  RpsupParameters smooth = rigid;
  smooth.stiffness_law = StiffnessLaw::kJohnson;
  smooth.friction = FrictionLaw::kCoulomb;
  smooth.v_0 = 1.0;
  RpsupParameters links = flexible;  // each link but the slider
  links.crank.model = links.rod.model = links.cross.model = LinkModel::kFlexible;
  links.cross_length = 0.1;
  RpsupParameters links_rows = links;
  links_rows.drive = DriveEnforcement::kBaumgarte;
  links_rows.c_r = 0.0;
  RpsupParameters all_rows = rows;
  all_rows.c_r = 0.0;
  RpsupParameters worn = rigid;  // uneven, and different for the two rings; a spline's bend is continuous and no more, so small steps
  for (const double ring : {0.0, 1.0}) {
    worn.wear_depth.emplace_back();
    for (int s = 0; s < 24; ++s) worn.wear_depth.back().push_back(1e-5 * (1.0 + ring + std::sin(0.5 * s + ring)));
  }
  Linkage sprung = make_spatial_slider_crank(JointKind::kSpherical);  // from a body that turns to the ground, and to one that slides
  sprung.springs = {{.name = "to_ground", .from = kGroundName, .to = "rod", .at = {0.1, -0.2, 0.3}, .to_at = {-0.1, 0.02, 0.01}, .stiffness = 300.0,
                     .damping = 20.0, .free_length = 0.1},
                    {.name = "back", .from = "rod", .to = "crank", .at = {-0.2, 0.05, 0.01}, .to_at = {0.03, 0.01, 0.02}, .stiffness = 150.0,
                     .damping = 4.0, .drag = 7.0, .free_length = 0.1},
                    {.name = "across", .from = "crank", .to = "slider", .at = {0.0, 0.0, 0.06}, .to_at = {0.05, 0.0, 0.0}, .stiffness = 200.0,
                     .damping = 5.0}};
  Linkage sprung_on_drive = make_screw();  // to a coordinate that moves with time alone
  sprung_on_drive.joints[0].freedoms[1].drive = Harmonic{0.0, 0.3, 5.0, 0.4};
  sprung_on_drive.springs = {{.name = "pull", .from = kGroundName, .to = "nut", .at = {0.2, 0.1, -0.1}, .to_at = {0.05, 0.0, 0.02},
                              .stiffness = 100.0, .damping = 3.0, .drag = 2.0, .free_length = 0.05}};
  Linkage driven_screw = make_screw();
  driven_screw.joints[0].freedoms[1].drive = Harmonic{0.0, 0.3, 5.0, 0.4};
  Linkage actuated = make_spatial_slider_crank(JointKind::kSpherical);  // a motor with a controller on the crank, a table over the slide
  actuated.joints[0].freedoms[0].actuator =
      DcMotor{.voltage = Controller{.target = Harmonic{0.3, 2.0, 5.0, 0.4}, .controlled = Controller::Controlled::kPosition, .proportional = 30.0,
                                    .integral = 50.0, .derivative = 2.0},
              .torque_constant = 0.5, .resistance = 0.8, .inductance = 0.02, .gear_ratio = 3.0, .gear_efficiency = 0.8, .rotor_inertia = 1e-3,
              .viscous_friction = 0.01, .dry_friction = 0.3, .reversal_velocity = 30.0};
  actuated.joints[1].freedoms[0].friction = JointFriction{{.v_s = 1.0}, 50.0};
  actuated.joints[2].freedoms[0].friction = JointFriction{{.law = FrictionLaw::kCoulomb, .v_0 = 1.0}, 20.0, 0.03};
  actuated.joints[1].freedoms[0].load =
      ForceLaw{TableCurve({-2.0, 0.0, 1.0, 2.0}, {5.0, 0.0, -20.0, -90.0}, TableInterpolation::kMonotoneCubic), ForceLaw::Variable::kPosition};
  Linkage loaded = make_spatial_slider_crank(JointKind::kSpherical);
  loaded.loads = {{.name = "thrust", .body = "rod", .at = {0.1, 0.02, 0.03}, .force = {3.0, -5.0, 4.0}, .follows_body = true,
                   .law = Harmonic{1.0, 0.5, 6.0, 0.2}},
                  {.name = "twist", .body = "crank", .moment = {0.3, 0.2, -0.4}, .law = Harmonic{0.0, 2.0, 4.0, 0.3}}};
  loaded.ground_acceleration = {Signal(Harmonic{0.0, 3.0, 5.0, 0.1}), std::nullopt, Signal(Constant{2.0})};
  ClearanceParameters socket = *build_rpsup(rigid).mechanism.cut_joints[0].clearance;
  socket.geometry = ContactGeometry::kBallInSocket;
  socket.c_a = std::numeric_limits<double>::infinity();
  Linkage loose_ball = make_spatial_slider_crank(JointKind::kSpherical);
  loose_ball.joints.back().clearance = socket;
  ClearanceParameters slot = socket;
  slot.geometry = ContactGeometry::kBlockInSlot;
  slot.block_x = 0.01;
  slot.block_y = 0.02;
  slot.c_y = slot.c_r;
  Linkage loose_block = make_spatial_slider_crank(JointKind::kSpherical);  // its slide carries the block
  loose_block.joints[1].clearance = slot;
  for (const char* const name : {"slide_y", "slide_z", "turn_x", "turn_z", "turn_y"}) loose_block.joints[1].freedoms.push_back({.name = name});
  Linkage loose_cut_block = make_spatial_slider_crank(JointKind::kPrismatic);
  loose_cut_block.joints.back().clearance = slot;
  RpsupParameters guide;  // the yoke about the guide, three rings
  guide.v_s = 1.0;
  RpsupParameters flexible_guide = guide;
  flexible_guide.coupler = Coupler::kFlexible;
  RpsupParameters ideal_guide = flexible_guide;
  ideal_guide.c_r = 0.0;
  RpsupParameters turned_guide = guide;  // a tree that no code is specialised for; the acceleration of its drive jumps elsewhere
  turned_guide.guide_angle = 0.3;
  turned_guide.crank_start = 0.4;
  turned_guide.rod_law = StrokeLaw::kParabolic;
  RpsupParameters forced = guide, controlled = guide, motorised = guide;  // code is specialised for each
  const Controller controller{.target = Harmonic{0.3, 2.0, 5.0, 0.4}, .proportional = 30.0, .integral = 50.0};
  forced.crank_actuator = ForceLaw{Signal(Harmonic{1.0, 0.5, 6.0, 0.2})};
  controlled.crank_actuator = controller;
  motorised.crank_actuator = DcMotor{.voltage = controller, .torque_constant = 0.5, .resistance = 0.8, .inductance = 0.02, .gear_ratio = 3.0,
                                     .gear_efficiency = 0.8, .rotor_inertia = 1e-3};
  RpsupParameters dashpots = elements;
  dashpots.normal_law = NormalForceLaw::kKelvinVoigt;
  constexpr double kPressed = 3e-4, kFine = 2e-8, kCoarse = 1e-5;
  constexpr double kTilted = 2e-3;  // of the coupler's turn about z: presses the faces, too
  const auto of_rpsup = [](std::string name, const RpsupParameters& parameters, double offset, double step) {
    Rpsup rpsup = build_rpsup(parameters);
    return Case{std::move(name), std::move(rpsup.mechanism), rpsup.layout.slider, offset, step};
  };
  const auto of_tilted_coupler = [](std::string name, const RpsupParameters& parameters, double offset, double step) {
    Rpsup rpsup = build_rpsup(parameters);
    return Case{std::move(name), std::move(rpsup.mechanism), rpsup.layout.rod + 1, offset, step};
  };
  const auto of_linkage = [](std::string name, const Linkage& linkage, double offset, double disturbance) {
    Mechanism mechanism = build_linkage(linkage).mechanism;
    mechanism.minimum_norm_multipliers = disturbance == 0.0;
    return Case{std::move(name), std::move(mechanism), 0, offset, 1e-5, disturbance};
  };
  const Linkage loose = make_loose_loops(*build_rpsup(rigid).mechanism.cut_joints[0].clearance);
  const Linkage loose_elements = make_loose_loops(*build_rpsup(elements).mechanism.cut_joints[0].clearance);
  constexpr double kPressing = -1.0;  // journals that come nearer: the normal force of those that leave so fast is none
  const auto with_rings = [&](const std::vector<int>& rings) {  // each with a bristle pair: pairs are solved several at once, across joints
    Mechanism mechanism = build_linkage(loose).mechanism;
    std::size_t next = 0;
    for (CutJoint& joint : mechanism.cut_joints)
      if (joint.clearance) joint.clearance->n_r = rings.at(next++);
    return mechanism;
  };
  return {of_rpsup("rigid", rigid, kPressed, kFine), of_rpsup("flexible", flexible, kPressed, kFine), of_rpsup("apart", apart, 0.0, 0.1 * kCoarse),
          of_rpsup("elements", elements, kPressed, kFine), of_rpsup("flexible_elements", flexible_elements, kPressed, kFine),
          of_rpsup("elasto_plastic", plastic, kPressed, kFine),
          of_rpsup("ambrosio", no_bristles, kPressed, kFine), of_rpsup("coulomb", smooth, kPressed, kFine),
          of_rpsup("worn", worn, kPressed, 0.2 * kFine), of_rpsup("drive_rows", rows, kPressed, kFine),
          of_rpsup("rigid_drive_rows", rigid_rows, kPressed, kFine),
          of_rpsup("ideal_flexible", ideal, 1e-6, kCoarse), of_rpsup("ideal_rigid", ideal_rigid, 1e-6, kCoarse),
          of_rpsup("ideal_drive_rows", all_rows, 1e-6, kCoarse),
          of_tilted_coupler("guide", guide, kTilted, kFine), of_tilted_coupler("flexible_guide", flexible_guide, kTilted, kFine),
          of_tilted_coupler("ideal_guide", ideal_guide, 1e-6, kCoarse), of_tilted_coupler("turned_guide", turned_guide, kTilted, kFine),
          of_tilted_coupler("forced", forced, kTilted, kFine), of_tilted_coupler("controlled", controlled, kTilted, kFine),
          of_tilted_coupler("motorised", motorised, kTilted, kFine),
          of_rpsup("elements_with_dashpots", dashpots, kPressed, kFine),
          of_rpsup("flexible_links", links, kPressed, kFine), of_rpsup("flexible_links_rows", links_rows, 1e-6, kCoarse),
          {"loose_loops", build_linkage(loose).mechanism, 1, 3e-4, kFine}, {"loose_rocker", build_linkage(loose).mechanism, 3, 2e-3, kFine},
          {"loose_elements", build_linkage(loose_elements).mechanism, 3, 2e-3, kFine},
          {"odd_rings", with_rings({3, 2}), 3, 2e-3, kFine, kPressing}, {"odd_rings_apart", with_rings({3, 2}), 1, 3e-4, kFine, kPressing},
          {"odd_rings_both", with_rings({5, 3}), 3, 2e-3, kFine, kPressing},
          of_linkage("cut_ball", make_spatial_slider_crank(JointKind::kSpherical), 1e-5, 1.0),
          of_linkage("cut_cross", make_spatial_slider_crank(JointKind::kUniversal), 1e-5, 1.0),
          of_linkage("cut_slide", make_spatial_slider_crank(JointKind::kPrismatic), 1e-5, 1.0),
          of_linkage("screw", make_screw(), 1e-5, 1.0), of_linkage("sprung", sprung, 1e-5, 1.0),
          of_linkage("sprung_on_drive", sprung_on_drive, 1e-5, 1.0), of_linkage("driven_screw", driven_screw, 1e-5, 1.0), of_linkage("actuated", actuated, 1e-5, 1.0),
          of_linkage("loaded", loaded, 1e-5, 1.0),
          {"loose_ball", build_linkage(loose_ball).mechanism, 1, kPressed, kFine},
          {"loose_block", build_linkage(loose_block).mechanism, 2, kPressed, kFine},
          {"loose_block_across", build_linkage(loose_block).mechanism, 3, -kPressed, kFine, kPressing},
          {"loose_block_tilted", build_linkage(loose_block).mechanism, 5, 0.04, kFine},
          {"loose_cut_block", build_linkage(loose_cut_block).mechanism, 0, 3e-3, kFine},
          of_linkage("dependent_cylinder", make_four_bar(JointKind::kCylindrical), 0.0, 0.0),
          of_linkage("dependent_weld", make_four_bar(JointKind::kWeld), 0.0, 0.0),
          of_linkage("dependent_slot", make_quick_return(JointKind::kPrismatic), 0.0, 0.0)};
}

/// A mechanism in motion, its bristles bent.
class Moving {
 public:
  Moving(const Case& c, std::string_view instruction_set) : system_(c.mechanism, instruction_set) {
    Evaluation at = system_.make_evaluation();
    LoopClosure closure(c.mechanism);
    EXPECT_TRUE(closure.assemble(kTime, at));
    at.q[c.pressed] += c.offset;
    for (Eigen::Index i = 0; i < at.qd.size(); ++i) at.qd[i] += c.disturbance * (0.1 * static_cast<double>(i % 3 - 1) + 0.02);
    for (const FrameIndex i : system_.free_coordinates())
      if (c.mechanism.coordinates[static_cast<std::size_t>(i)].stiffness != 0.0) at.q[i] += 1e-3 * (i % 4 - 1.5);
    y = system_.make_state(at.q, at.qd);
    f = Eigen::VectorXd::Zero(y.size());
    (void)system_.calc_derivative(kTime, y, f, at);
    (void)system_.prepare_step(at, 0.0, y);
    while (system_.calc_derivative(kTime, y, f) == EvaluationStatus::kBristleMissing) {
      system_.widen_bristles(y);
      f.setZero(y.size());
    }
    for (Eigen::Index b = 2 * system_.free_count(); b < system_.controlled_size(); ++b)
      if (f[b] != 0.0) y[b] = std::copysign(1e-4 * static_cast<double>(1 + b % 3), f[b]);  // only what touches has one; bent by its sliding
    evaluate(kTime, y, f);
  }

  void evaluate(double t, const Eigen::VectorXd& state, Eigen::VectorXd& rates) {
    EXPECT_EQ(system_.calc_derivative(t, state, rates), EvaluationStatus::kOk);
  }

  /// The state's derivative by one direction from four points, of order 4. @param direction  an entry of y, or -1 for time
  Eigen::VectorXd differ(Eigen::Index direction, double step) {
    const auto at = [&](double shift) {
      Eigen::VectorXd moved = y;
      if (direction >= 0) moved[direction] += shift;
      Eigen::VectorXd rates = f;
      evaluate(direction < 0 ? kTime + shift : kTime, moved, rates);
      return rates;
    };
    return (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
  }

  static constexpr double kTime = 0.7;
  MotionSystem system_;
  Eigen::VectorXd y, f;
};

class Linearisation : public testing::TestWithParam<Case> {};

/// The ways to solve an implicit step's systems that a mechanism takes.
std::vector<NewtonSolver> solvers_of(const MotionSystem& system) {
  if (!system.can_solve_recursively()) return {NewtonSolver::kDense};
  return {NewtonSolver::kDense, NewtonSolver::kRecursive};
}

TEST_P(Linearisation, IsTheDerivativeInEveryDirection) {
  Moving moving(GetParam(), {});
  MotionSystem& system = moving.system_;
  const Eigen::VectorXd by_time = moving.differ(-1, 10.0 * GetParam().step);
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index j = 0; j < moving.y.size(); ++j)
    columns.push_back(moving.differ(j, j < system.free_count() ? GetParam().step : j < 2 * system.free_count() ? 1e-5 : 1e-7));
  for (const NewtonSolver solver : solvers_of(system)) {
    ASSERT_EQ(system.linearise(Moving::kTime, moving.y, solver), EvaluationStatus::kOk);
    EXPECT_LE((system.time_derivative() - by_time).cwiseAbs().maxCoeff(), 2e-6 * by_time.cwiseAbs().maxCoeff());  // 0 without drives
    // (shift 1 - J) is known by its inverse only: what it makes of its own columns, taken by differences, is a unit vector.
    constexpr double kShift = 3e4;
    ASSERT_TRUE(system.factor(kShift));
    for (Eigen::Index j = 0; j < moving.y.size(); ++j) {
      Eigen::VectorXd x = -columns[static_cast<std::size_t>(j)];
      x[j] += kShift;
      const double scale = x.cwiseAbs().maxCoeff() / kShift;
      system.solve_in_place(x);
      x[j] -= 1.0;
      EXPECT_LT(x.cwiseAbs().maxCoeff(), 2e-6 * std::max(1.0, scale)) << "column " << j;
    }
  }
}

/// The same of a complex shift: (shift 1 - J) (x + i y) with x = 1 in one place and y = 1 in the next one.
TEST_P(Linearisation, IsTheDerivativeWithAComplexShift) {
  Moving moving(GetParam(), {});
  MotionSystem& system = moving.system_;
  const auto column = [&](Eigen::Index j) {
    return moving.differ(j, j < system.free_count() ? GetParam().step : j < 2 * system.free_count() ? 1e-5 : 1e-7);
  };
  constexpr std::complex<double> kShift(2e4, 3e4);
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index j = 0; j < moving.y.size(); ++j) columns.push_back(column(j));
  for (const NewtonSolver solver : solvers_of(system)) {
    ASSERT_EQ(system.linearise(Moving::kTime, moving.y, solver), EvaluationStatus::kOk);
    ASSERT_TRUE(system.factor(kShift));
    for (Eigen::Index j = 0; j + 1 < moving.y.size(); ++j) {
      Eigen::VectorXd real = -columns[static_cast<std::size_t>(j)], imag = -columns[static_cast<std::size_t>(j) + 1];
      real[j] += kShift.real();
      real[j + 1] -= kShift.imag();
      imag[j] += kShift.imag();
      imag[j + 1] += kShift.real();
      const double scale = std::max(real.cwiseAbs().maxCoeff(), imag.cwiseAbs().maxCoeff()) / std::abs(kShift);
      system.solve_in_place(real, imag);
      real[j] -= 1.0;
      imag[j + 1] -= 1.0;
      EXPECT_LT(real.cwiseAbs().maxCoeff() + imag.cwiseAbs().maxCoeff(), 4e-6 * std::max(1.0, scale)) << "column " << j;
    }
  }
}

// A load of nothing on a body has the same mechanism evaluated by the code for any tree.
TEST(SpecialisedTopology, GivesTheRatesOfAnyTree) {
  std::vector<Case> cases = all_cases();
  std::erase_if(cases, [](const Case& c) {
    return c.name.find("guide") == std::string::npos && c.name != "forced" && c.name != "controlled" && c.name != "motorised";
  });
  cases.push_back(*std::ranges::find(cases, "forced", &Case::name));  // with a wheel of its own, where a motor would have its winding
  cases.back().name = "flywheel";
  Coordinate& wheel = cases.back().mechanism.coordinates.emplace_back();
  wheel.name = "wheel";
  wheel.start = 0.3;
  wheel.start_rate = 2.0;
  wheel.stiffness = 7.0;
  wheel.mass = 3.0;
  wheel.inertia = Eigen::Vector3d(0.5, 0.2, 0.2).asDiagonal();
  for (const Case& c : cases) {
    Case general = c;
    general.mechanism.body_loads.push_back({.frame = 0, .law = Constant{0.0}});
    const Moving special(c, {}), any(general, {});
    const Eigen::Index size = special.system_.controlled_size();
    ASSERT_EQ(size, any.system_.controlled_size()) << c.name;
    EXPECT_EQ(special.y.head(size), any.y.head(size)) << c.name;
    const double scale = any.f.head(size).cwiseAbs().maxCoeff();
    EXPECT_LT((special.f.head(size) - any.f.head(size)).cwiseAbs().maxCoeff(), 1e-10 * scale) << c.name;
    EXPECT_GT(scale, 1.0) << c.name;
  }
}

TEST(LinearisationAfterAnother, LeavesNothingOfTheOneBeforeBehind) {
  std::vector<Case> odd_rings = all_cases();
  std::erase_if(odd_rings, [](const Case& c) { return c.name != "odd_rings" && c.name != "odd_rings_apart"; });
  ASSERT_EQ(odd_rings.size(), 2u);
  Moving many(odd_rings[0], {}), few(odd_rings[1], {});  // of one mechanism
  for (const Eigen::VectorXd* y : {&many.y, &few.y}) ASSERT_EQ(many.system_.linearise(Moving::kTime, *y), EvaluationStatus::kOk);
  ASSERT_EQ(few.system_.linearise(Moving::kTime, few.y), EvaluationStatus::kOk);
  ASSERT_TRUE(many.system_.factor(3e4) && few.system_.factor(3e4));
  Eigen::VectorXd after_another = few.f, alone = few.f;
  many.system_.solve_in_place(after_another);
  few.system_.solve_in_place(alone);
  EXPECT_EQ(after_another, alone);
}

class OpenChains : public testing::TestWithParam<Case> {};

TEST_P(OpenChains, BodyByBodyIsTheSameAsByTheMatrix) {
  Moving moving(GetParam(), {});
  MotionSystem& system = moving.system_;
  ASSERT_TRUE(system.can_solve_recursively());
  constexpr double kSame = 1e-7;  // a stiff contact is put on what moves without it, which costs digits: 1e-8 where a millimetre is pressed in
  for (const double shift : {3e2, 3e4, 3e6}) {
    Eigen::VectorXd right = moving.f;
    for (Eigen::Index i = 0; i < right.size(); ++i) right[i] += static_cast<double>(i % 5 - 2);
    Eigen::VectorXd solutions[2], times[2];
    for (const NewtonSolver solver : solvers_of(system)) {
      const bool bodies = solver == NewtonSolver::kRecursive;
      ASSERT_EQ(system.linearise(Moving::kTime, moving.y, solver), EvaluationStatus::kOk);
      ASSERT_TRUE(system.factor(shift));
      solutions[bodies] = right;
      system.solve_in_place(solutions[bodies]);
      times[bodies] = system.time_derivative();
    }
    EXPECT_EQ((times[1] - times[0]).cwiseAbs().maxCoeff(), 0.0);
    const Eigen::Index free = system.free_count();
    const auto expect_same = [&](Eigen::Index first, Eigen::Index count, const char* part) {
      const double scale = solutions[0].segment(first, count).cwiseAbs().maxCoeff();
      EXPECT_LE((solutions[1] - solutions[0]).segment(first, count).cwiseAbs().maxCoeff(), kSame * scale) << part << " at a shift of " << shift;
    };
    expect_same(0, free, "coordinates");
    expect_same(free, free, "rates");
    if (system.controlled_size() > 2 * free) expect_same(2 * free, system.controlled_size() - 2 * free, "bristles");
    expect_same(system.controlled_size(), right.size() - system.controlled_size(), "works");
  }
}

TEST_P(OpenChains, BodyByBodyIsTheSameAsByTheMatrixWithAComplexShift) {
  Moving moving(GetParam(), {});
  MotionSystem& system = moving.system_;
  ASSERT_TRUE(system.can_solve_recursively());
  constexpr double kSame = 1e-7;  // as above
  const Eigen::Index free = system.free_count(), controlled = system.controlled_size();
  for (const std::complex<double> shift : {std::complex<double>(3e2, 4e2), {3e4, -4e4}, {3e6, 4e6}}) {
    Eigen::VectorXcd solutions[2];
    for (const NewtonSolver solver : solvers_of(system)) {
      ASSERT_EQ(system.linearise(Moving::kTime, moving.y, solver), EvaluationStatus::kOk);
      ASSERT_TRUE(system.factor(shift));
      Eigen::VectorXd real = moving.f, imag = moving.f.reverse();
      for (Eigen::Index i = 0; i < real.size(); ++i) imag[i] += static_cast<double>(i % 5 - 2);
      system.solve_in_place(real, imag);
      Eigen::VectorXcd& x = solutions[solver == NewtonSolver::kRecursive];
      x.resize(real.size());
      x.real() = real;
      x.imag() = imag;
    }
    const auto expect_same = [&](Eigen::Index first, Eigen::Index count, const char* part) {
      if (count == 0) return;
      const double scale = solutions[0].segment(first, count).cwiseAbs().maxCoeff();
      EXPECT_LE((solutions[1] - solutions[0]).segment(first, count).cwiseAbs().maxCoeff(), kSame * scale) << part << " at a shift of " << shift;
    };
    expect_same(0, free, "coordinates");
    expect_same(free, free, "rates");
    expect_same(2 * free, controlled - 2 * free, "bristles");
    expect_same(controlled, solutions[0].size() - controlled, "works");
  }
}

// A step that is tried again is factored anew, after its stages have been evaluated elsewhere.
TEST_P(OpenChains, WhatIsHeldOutlivesOtherEvaluations) {
  Moving moving(GetParam(), {});
  MotionSystem& system = moving.system_;
  const auto solve = [&](double shift, const auto& between) {
    Eigen::VectorXd x = moving.f;
    EXPECT_TRUE(system.factor(shift));
    between();
    system.solve_in_place(x);
    return x;
  };
  const auto linearise = [&] { ASSERT_EQ(system.linearise(Moving::kTime, moving.y, NewtonSolver::kRecursive), EvaluationStatus::kOk); };
  linearise();
  const Eigen::VectorXd first = solve(1e5, [] {}), second = solve(3e4, [] {});
  const auto go_elsewhere = [&] {
    Eigen::VectorXd other = moving.y, rates = moving.f;
    other.head(system.free_count()).array() += 1e-9;
    moving.evaluate(Moving::kTime + 1e-7, other, rates);
  };
  linearise();
  EXPECT_EQ(solve(1e5, go_elsewhere), first);
  go_elsewhere();
  EXPECT_EQ(solve(3e4, go_elsewhere), second);
}

// As radau5 does: a real and a complex shift are factored, both serve for several steps.
TEST_P(OpenChains, ARealAndAComplexShiftAreHeldSideBySide) {
  Moving moving(GetParam(), {});
  MotionSystem& system = moving.system_;
  constexpr std::complex<double> kShift(2e4, 3e4);
  const auto linearise = [&] { ASSERT_EQ(system.linearise(Moving::kTime, moving.y, NewtonSolver::kRecursive), EvaluationStatus::kOk); };
  const auto solve_real = [&] {
    Eigen::VectorXd x = moving.f;
    system.solve_in_place(x);
    return x;
  };
  const auto solve_complex = [&] {
    Eigen::VectorXd real = moving.f, imag = moving.f.reverse();
    system.solve_in_place(real, imag);
    return Eigen::VectorXd(real + imag);
  };
  linearise();
  ASSERT_TRUE(system.factor(1e5));
  const Eigen::VectorXd real = solve_real();
  linearise();
  ASSERT_TRUE(system.factor(kShift));
  const Eigen::VectorXd complex = solve_complex();
  linearise();
  ASSERT_TRUE(system.factor(1e5) && system.factor(kShift));
  for (int step = 0; step < 2; ++step) {
    EXPECT_EQ(solve_real(), real);
    EXPECT_EQ(solve_complex(), complex);
    Eigen::VectorXd other = moving.y, rates = moving.f;
    other.head(system.free_count()).array() += 1e-9;
    moving.evaluate(Moving::kTime + 1e-7, other, rates);
  }
}

TEST_P(Linearisation, AndTheRatesAreTheSameBytesWithEveryInstructionSet) {
  if (instruction_sets().size() < 2) GTEST_SKIP() << "compiled for one instruction set alone";
  Moving first(GetParam(), instruction_sets().front());
  for (const std::string_view set : instruction_sets()) {
    Moving other(GetParam(), set);
    EXPECT_EQ((first.f - other.f).cwiseAbs().maxCoeff(), 0.0) << set;
    for (const NewtonSolver solver : solvers_of(first.system_)) {
      ASSERT_EQ(first.system_.linearise(Moving::kTime, first.y, solver), EvaluationStatus::kOk);
      ASSERT_EQ(other.system_.linearise(Moving::kTime, other.y, solver), EvaluationStatus::kOk);
      EXPECT_EQ((first.system_.time_derivative() - other.system_.time_derivative()).cwiseAbs().maxCoeff(), 0.0) << set;
      Eigen::VectorXd x = first.f;
      Eigen::VectorXd y = first.f;
      ASSERT_TRUE(first.system_.factor(1e5) && other.system_.factor(1e5));
      first.system_.solve_in_place(x);
      other.system_.solve_in_place(y);
      EXPECT_EQ((x - y).cwiseAbs().maxCoeff(), 0.0) << set;
      constexpr std::complex<double> kComplexShift(2e4, 3e4);
      Eigen::VectorXd x_imag = first.f.reverse(), y_imag = x_imag;
      ASSERT_TRUE(first.system_.factor(kComplexShift) && other.system_.factor(kComplexShift));
      first.system_.solve_in_place(x, x_imag);
      other.system_.solve_in_place(y, y_imag);
      EXPECT_EQ((x - y).cwiseAbs().maxCoeff() + (x_imag - y_imag).cwiseAbs().maxCoeff(), 0.0) << set;
    }
  }
}

TEST_P(Linearisation, TheRatesAreTheSameBytesWhetherAllIsKeptOrNot) {
  for (const std::string_view set : instruction_sets()) {
    Moving moving(GetParam(), set);
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(moving.f.size());
    Evaluation at = moving.system_.make_evaluation();
    ASSERT_EQ(moving.system_.calc_derivative(Moving::kTime, moving.y, rates, at), EvaluationStatus::kOk);
    EXPECT_EQ((moving.f - rates).cwiseAbs().maxCoeff(), 0.0) << set;
  }
}

/// The linkage without clearance that code is specialised for, and others that look like it.
std::vector<Case> ideal_linkages() {
  std::vector<Case> cases = all_cases();
  std::erase_if(cases, [](const Case& c) { return c.name != "ideal_flexible" && c.name != "ideal_rigid"; });
  for (const std::size_t k : {0u, 1u}) {
    Case universal = cases.at(k), dependent = cases.at(k);
    universal.name += "_universal";
    universal.mechanism.cut_joints[0].kind = CutKind::kUniversal;
    dependent.name += "_dependent";
    dependent.mechanism.minimum_norm_multipliers = true;
    cases.push_back(universal);
    cases.push_back(dependent);
  }
  return cases;
}

class Specialised : public testing::TestWithParam<Case> {};

// A spring without stiffness makes a linkage one that no code is specialised for.
TEST_P(Specialised, MovesAndVariesAsAnyLinkageDoes) {
  Case general = GetParam();
  general.mechanism.springs.push_back({.from_frame = 0, .from = {0.1, 0.2, 0.3}, .to = {5.0, 6.0, 7.0}});
  Moving special(GetParam(), {}), any(general, {});
  constexpr double kRounding = 1e-9;  // amplified by the least of the multipliers' pivots, and by thin elements' accelerations
  EXPECT_LE((special.f - any.f).cwiseAbs().maxCoeff(), kRounding * any.f.cwiseAbs().maxCoeff());
  for (Moving* moving : {&special, &any}) {
    ASSERT_EQ(moving->system_.linearise(Moving::kTime, special.y), EvaluationStatus::kOk);
    ASSERT_TRUE(moving->system_.factor(1e4));
  }
  Eigen::VectorXd x = any.f, y = any.f;
  special.system_.solve_in_place(x);
  any.system_.solve_in_place(y);
  EXPECT_LE((x - y).cwiseAbs().maxCoeff(), kRounding * y.cwiseAbs().maxCoeff());
  EXPECT_LE((special.system_.time_derivative() - any.system_.time_derivative()).cwiseAbs().maxCoeff(),
            kRounding * any.system_.time_derivative().cwiseAbs().maxCoeff());
}

/// Those without constraints, and without springs between points.
std::vector<Case> open_chains() {
  std::vector<Case> cases = all_cases();
  std::erase_if(cases, [](const Case& c) {
    const bool constrained = c.mechanism.drive_rows == DriveRows::kMultipliers || !c.mechanism.couplings.empty() ||
                             std::ranges::any_of(c.mechanism.cut_joints, [](const CutJoint& joint) { return !joint.clearance; });
    return constrained || !c.mechanism.springs.empty() || !c.mechanism.actuations.empty();
  });
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Cases, Specialised, testing::ValuesIn(ideal_linkages()), [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Cases, OpenChains, testing::ValuesIn(open_chains()), [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Cases, Linearisation, testing::ValuesIn(all_cases()), [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace engine
