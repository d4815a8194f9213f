// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/dynamics/moving_mechanism.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "engine/dynamics/loop_closure.h"
#include "engine/model/rpsup.h"
#include "tests/engine/linkage_cases.h"
#include "validation/support/across_rpsup.h"

namespace engine {

std::vector<MechanismCase> make_mechanism_cases() {
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
  RpsupParameters plastic =
      rigid;  // Kelvin and Voigt's damper, a logarithmic stiffness, elasto-plastic bristles
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
  RpsupParameters worn = rigid;  // uneven, and different for the two rings; a spline's bend is continuous and
                                 // no more, so small steps
  for (const double ring : {0.0, 1.0}) {
    worn.wear_depth.emplace_back();
    for (int s = 0; s < 24; ++s)
      worn.wear_depth.back().push_back(1e-5 * (1.0 + ring + std::sin(0.5 * s + ring)));
  }
  Linkage sprung = make_spatial_slider_crank(
      JointKind::kSpherical);  // from a body that turns to the ground, and to one that slides
  sprung.springs = {{.name = "to_ground",
                     .from = kGroundName,
                     .to = "rod",
                     .at = {0.1, -0.2, 0.3},
                     .to_at = {-0.1, 0.02, 0.01},
                     .stiffness = 300.0,
                     .damping = 20.0,
                     .free_length = 0.1},
                    {.name = "back",
                     .from = "rod",
                     .to = "crank",
                     .at = {-0.2, 0.05, 0.01},
                     .to_at = {0.03, 0.01, 0.02},
                     .stiffness = 150.0,
                     .damping = 4.0,
                     .drag = 7.0,
                     .free_length = 0.1},
                    {.name = "across",
                     .from = "crank",
                     .to = "slider",
                     .at = {0.0, 0.0, 0.06},
                     .to_at = {0.05, 0.0, 0.0},
                     .stiffness = 200.0,
                     .damping = 5.0}};
  Linkage sprung_on_drive = make_screw();  // to a coordinate that moves with time alone
  sprung_on_drive.joints[0].freedoms[1].drive = Harmonic{0.0, 0.3, 5.0, 0.4};
  sprung_on_drive.springs = {{.name = "pull",
                              .from = kGroundName,
                              .to = "nut",
                              .at = {0.2, 0.1, -0.1},
                              .to_at = {0.05, 0.0, 0.02},
                              .stiffness = 100.0,
                              .damping = 3.0,
                              .drag = 2.0,
                              .free_length = 0.05}};
  Linkage driven_screw = make_screw();
  driven_screw.joints[0].freedoms[1].drive = Harmonic{0.0, 0.3, 5.0, 0.4};
  Linkage actuated = make_spatial_slider_crank(
      JointKind::kSpherical);  // a motor with a controller on the crank, a table over the slide
  actuated.joints[0].freedoms[0].actuator =
      DcMotor{.voltage = Controller{.target = Harmonic{0.3, 2.0, 5.0, 0.4},
                                    .controlled = Controller::Controlled::kPosition,
                                    .proportional = 30.0,
                                    .integral = 50.0,
                                    .derivative = 2.0},
              .torque_constant = 0.5,
              .resistance = 0.8,
              .inductance = 0.02,
              .gear_ratio = 3.0,
              .gear_efficiency = 0.8,
              .rotor_inertia = 1e-3,
              .viscous_friction = 0.01,
              .dry_friction = 0.3,
              .reversal_velocity = 30.0};
  actuated.joints[1].freedoms[0].friction = JointFriction{{.v_s = 1.0}, 50.0};
  actuated.joints[2].freedoms[0].friction =
      JointFriction{{.law = FrictionLaw::kCoulomb, .v_0 = 1.0}, 20.0, 0.03};
  actuated.joints[1].freedoms[0].load = ForceLaw{
      TableCurve({-2.0, 0.0, 1.0, 2.0}, {5.0, 0.0, -20.0, -90.0}, TableInterpolation::kMonotoneCubic),
      ForceLaw::Variable::kPosition};
  Linkage loaded = make_spatial_slider_crank(JointKind::kSpherical);
  loaded.loads = {
      {.name = "thrust",
       .body = "rod",
       .at = {0.1, 0.02, 0.03},
       .force = {3.0, -5.0, 4.0},
       .follows_body = true,
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
  for (const char* const name : {"slide_y", "slide_z", "turn_x", "turn_z", "turn_y"})
    loose_block.joints[1].freedoms.push_back({.name = name});
  Linkage loose_cut_block = make_spatial_slider_crank(JointKind::kPrismatic);
  loose_cut_block.joints.back().clearance = slot;
  RpsupParameters guide;  // the yoke about the guide, three rings
  guide.v_s = 1.0;
  RpsupParameters flexible_guide = guide;
  flexible_guide.coupler = Coupler::kFlexible;
  RpsupParameters ideal_guide = flexible_guide;
  ideal_guide.c_r = 0.0;
  RpsupParameters turned_guide =
      guide;  // a tree that no code is specialised for; the acceleration of its drive jumps elsewhere
  turned_guide.guide_angle = 0.3;
  turned_guide.crank_start = 0.4;
  turned_guide.rod_law = StrokeLaw::kParabolic;
  RpsupParameters forced = guide, controlled = guide, motorised = guide;  // code is specialised for each
  const Controller controller{.target = Harmonic{0.3, 2.0, 5.0, 0.4}, .proportional = 30.0, .integral = 50.0};
  forced.crank_actuator = ForceLaw{Signal(Harmonic{1.0, 0.5, 6.0, 0.2})};
  controlled.crank_actuator = controller;
  motorised.crank_actuator = DcMotor{.voltage = controller,
                                     .torque_constant = 0.5,
                                     .resistance = 0.8,
                                     .inductance = 0.02,
                                     .gear_ratio = 3.0,
                                     .gear_efficiency = 0.8,
                                     .rotor_inertia = 1e-3};
  RpsupParameters dashpots = elements;
  dashpots.normal_law = NormalForceLaw::kKelvinVoigt;
  constexpr double kPressed = 3e-4, kFine = 2e-8, kCoarse = 1e-5;
  constexpr double kTilted = 2e-3;  // of the coupler's turn about z: presses the faces, too
  const auto of_rpsup = [](std::string name, const RpsupParameters& parameters, double offset, double step) {
    Rpsup rpsup = build_rpsup(parameters);
    return MechanismCase{std::move(name), std::move(rpsup.mechanism), rpsup.layout.slider, offset, step};
  };
  const auto of_tilted_coupler = [](std::string name, const RpsupParameters& parameters, double offset,
                                    double step) {
    Rpsup rpsup = build_rpsup(parameters);
    return MechanismCase{std::move(name), std::move(rpsup.mechanism), rpsup.layout.rod + 1, offset, step};
  };
  const auto of_linkage = [](std::string name, const Linkage& linkage, double offset, double disturbance) {
    Mechanism mechanism = build_linkage(linkage).mechanism;
    mechanism.minimum_norm_multipliers = disturbance == 0.0;
    return MechanismCase{std::move(name), std::move(mechanism), 0, offset, 1e-5, disturbance};
  };
  const Linkage loose = make_loose_loops(*build_rpsup(rigid).mechanism.cut_joints[0].clearance);
  const Linkage loose_elements = make_loose_loops(*build_rpsup(elements).mechanism.cut_joints[0].clearance);
  constexpr double kPressing =
      -1.0;  // journals that come nearer: the normal force of those that leave so fast is none
  const auto with_rings = [&](const std::vector<int>& rings) {  // each with a bristle pair: pairs are solved
                                                                // several at once, across joints
    Mechanism mechanism = build_linkage(loose).mechanism;
    std::size_t next = 0;
    for (CutJoint& joint : mechanism.cut_joints)
      if (joint.clearance) joint.clearance->n_r = rings.at(next++);
    return mechanism;
  };
  return {of_rpsup("rigid", rigid, kPressed, kFine),
          of_rpsup("flexible", flexible, kPressed, kFine),
          of_rpsup("apart", apart, 0.0, 0.1 * kCoarse),
          of_rpsup("elements", elements, kPressed, kFine),
          of_rpsup("flexible_elements", flexible_elements, kPressed, kFine),
          of_rpsup("elasto_plastic", plastic, kPressed, kFine),
          of_rpsup("ambrosio", no_bristles, kPressed, kFine),
          of_rpsup("coulomb", smooth, kPressed, kFine),
          of_rpsup("worn", worn, kPressed, 0.2 * kFine),
          of_rpsup("drive_rows", rows, kPressed, kFine),
          of_rpsup("rigid_drive_rows", rigid_rows, kPressed, kFine),
          of_rpsup("ideal_flexible", ideal, 1e-6, kCoarse),
          of_rpsup("ideal_rigid", ideal_rigid, 1e-6, kCoarse),
          of_rpsup("ideal_drive_rows", all_rows, 1e-6, kCoarse),
          of_tilted_coupler("guide", guide, kTilted, kFine),
          of_tilted_coupler("flexible_guide", flexible_guide, kTilted, kFine),
          of_tilted_coupler("ideal_guide", ideal_guide, 1e-6, kCoarse),
          of_tilted_coupler("turned_guide", turned_guide, kTilted, kFine),
          of_tilted_coupler("forced", forced, kTilted, kFine),
          of_tilted_coupler("controlled", controlled, kTilted, kFine),
          of_tilted_coupler("motorised", motorised, kTilted, kFine),
          of_rpsup("elements_with_dashpots", dashpots, kPressed, kFine),
          of_rpsup("flexible_links", links, kPressed, kFine),
          of_rpsup("flexible_links_rows", links_rows, 1e-6, kCoarse),
          {"loose_loops", build_linkage(loose).mechanism, 1, 3e-4, kFine},
          {"loose_rocker", build_linkage(loose).mechanism, 3, 2e-3, kFine},
          {"loose_elements", build_linkage(loose_elements).mechanism, 3, 2e-3, kFine},
          {"odd_rings", with_rings({3, 2}), 3, 2e-3, kFine, kPressing},
          {"odd_rings_apart", with_rings({3, 2}), 1, 3e-4, kFine, kPressing},
          {"odd_rings_both", with_rings({5, 3}), 3, 2e-3, kFine, kPressing},
          of_linkage("cut_ball", make_spatial_slider_crank(JointKind::kSpherical), 1e-5, 1.0),
          of_linkage("cut_cross", make_spatial_slider_crank(JointKind::kUniversal), 1e-5, 1.0),
          of_linkage("cut_slide", make_spatial_slider_crank(JointKind::kPrismatic), 1e-5, 1.0),
          of_linkage("screw", make_screw(), 1e-5, 1.0),
          of_linkage("sprung", sprung, 1e-5, 1.0),
          of_linkage("sprung_on_drive", sprung_on_drive, 1e-5, 1.0),
          of_linkage("driven_screw", driven_screw, 1e-5, 1.0),
          of_linkage("actuated", actuated, 1e-5, 1.0),
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

MovingMechanism::MovingMechanism(const MechanismCase& c, std::string_view instruction_set)
    : system(c.mechanism, instruction_set) {
  Evaluation at = system.make_evaluation();
  LoopClosure closure(c.mechanism);
  EXPECT_TRUE(closure.assemble(kTime, at));
  at.q[c.pressed] += c.offset;
  for (Eigen::Index i = 0; i < at.qd.size(); ++i)
    at.qd[i] += c.disturbance * (0.1 * static_cast<double>(i % 3 - 1) + 0.02);
  for (const FrameIndex i : system.free_coordinates())
    if (c.mechanism.coordinates[static_cast<std::size_t>(i)].stiffness != 0.0)
      at.q[i] += 1e-3 * (i % 4 - 1.5);
  y = system.make_state(at.q, at.qd);
  f = Eigen::VectorXd::Zero(y.size());
  (void)system.calc_derivative(kTime, y, f, at);
  (void)system.prepare_step(at, 0.0, y);
  while (system.calc_derivative(kTime, y, f) == EvaluationStatus::kBristleMissing) {
    system.widen_bristles(y);
    f.setZero(y.size());
  }
  for (Eigen::Index b = 2 * system.free_count(); b < system.controlled_size(); ++b)
    if (f[b] != 0.0)
      y[b] = std::copysign(1e-4 * static_cast<double>(1 + b % 3),
                           f[b]);  // only what touches has one; bent by its sliding
  evaluate(kTime, y, f);
}

void MovingMechanism::evaluate(double t, const Eigen::VectorXd& state, Eigen::VectorXd& rates) {
  EXPECT_EQ(system.calc_derivative(t, state, rates), EvaluationStatus::kOk);
}

Eigen::VectorXd MovingMechanism::differ(Eigen::Index direction, double step) {
  const auto at = [&](double shift) {
    Eigen::VectorXd moved = y;
    if (direction >= 0) moved[direction] += shift;
    Eigen::VectorXd rates = f;
    evaluate(direction < 0 ? kTime + shift : kTime, moved, rates);
    return rates;
  };
  return (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
}

std::vector<NewtonSolver> solvers_of(const MotionSystem& system) {
  if (!system.can_solve_recursively()) return {NewtonSolver::kDense};
  return {NewtonSolver::kDense, NewtonSolver::kRecursive};
}

}  // namespace engine
