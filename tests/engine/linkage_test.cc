// SPDX-License-Identifier: Apache-2.0
// Linkages of data: loops cut at one joint or another, screws, welds, redundant joints, springs; what is refused.

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/errors.h"
#include "engine/simulate_linkage.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

double root_mean_square_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b.at(k)) * (a[k] - b.at(k));
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Linkage, MovesTheSameWhereverItsLoopIsCut) {
  const LinkageRun ball(make_spatial_slider_crank(JointKind::kSpherical), accurate(1.0));
  for (const JointKind cut : {JointKind::kUniversal, JointKind::kPrismatic}) {
    const LinkageRun other(make_spatial_slider_crank(cut), accurate(1.0));
    // The tolerance of 1e-10, grown by the motion's own sensitivity.
    EXPECT_NEAR(other.last("theta_rad"), ball.last("theta_rad"), 2e-8);
    EXPECT_EQ(other.metric("redundant_constraints"), 0.0);
    EXPECT_NEAR(other.last("pose_slider_x_m"), ball.last("x_m"), 1e-8);
    // The same joints exert the same forces, cut or not.
    for (const char* const axis : {"x", "y", "z"})
      EXPECT_NEAR(other.last(std::string("ball_force_") + axis + "_n"), ball.last(std::string("ball_force_") + axis + "_n"), 1e-5) << axis;
  }
}

TEST(Linkage, MovesTheSameWithAFlatLoopCutAnywhere) {
  const LinkageRun revolute(make_four_bar(JointKind::kRevolute), accurate(1.0));
  EXPECT_EQ(revolute.metric("redundant_constraints"), 3.0);
  const LinkageRun cylindrical(make_four_bar(JointKind::kCylindrical), accurate(1.0));
  EXPECT_EQ(cylindrical.metric("redundant_constraints"), 2.0);
  const LinkageRun weld(make_four_bar(JointKind::kWeld), accurate(1.0));
  EXPECT_EQ(weld.metric("redundant_constraints"), 3.0);
  for (const LinkageRun* other : {&cylindrical, &weld}) EXPECT_NEAR(other->last("crank_rad"), revolute.last("crank_rad"), 2e-8);
  EXPECT_LT(revolute.metric("energy_imbalance_j"), 1e-8);
}

// The journal of the slot is elsewhere than its bearing, and the bearing turns.
TEST(Linkage, MovesTheSameWithABlockOnALeverCutAtItsPinOrItsSlot) {
  const LinkageRun pin(make_quick_return(JointKind::kRevolute), accurate(1.0));
  const LinkageRun slot(make_quick_return(JointKind::kPrismatic), accurate(1.0));
  EXPECT_GT(pin.last("crank_rad"), 3.0);
  EXPECT_NEAR(slot.last("crank_rad"), pin.last("crank_rad"), 2e-8);
  EXPECT_NEAR(slot.last("lever_rad"), pin.last("lever_rad"), 2e-8);
  for (const char* const joint : {"crank", "lever", "pin", "slot"})
    for (const char* const axis : {"x", "y"}) {
      const std::string force = joint + std::string("_force_") + axis + "_n";
      EXPECT_NEAR(slot.last(force), pin.last(force), 1e-5) << force;
    }
  EXPECT_LT(slot.metric("energy_imbalance_j"), 1e-8);
}

// Turning the nut by phi lowers it by lead phi: (I + m lead^2) phi'' = m g lead - c phi'.
TEST(Linkage, AScrewTurnsUnderItsLoad) {
  const LinkageRun run(make_screw(), accurate(2.0));
  const double lead = 0.02 / (2.0 * std::numbers::pi);
  const double inertia = 1.5e-3 + 2.0 * lead * lead;
  const double rate = -2.0 * 9.81 * lead / 1e-3 * (1.0 - std::exp(-1e-3 * 2.0 / inertia));
  EXPECT_NEAR(run.last("turn_rad_s"), rate, 1e-7 * std::abs(rate));
  EXPECT_NEAR(run.last("slide_m"), lead * run.last("turn_rad"), 1e-12);
}

// A drive of what is coupled and damped bears it all: M = (I + m lead^2) phi'' + c phi' + m g lead.
TEST(Linkage, ADriveBearsWhatItsCoordinateIsCoupledTo) {
  Linkage linkage = make_screw();
  constexpr double kAmplitude = 0.3, kOmega = 5.0, kPhase = 0.4, kEnd = 2.0;
  linkage.joints[0].freedoms[1].drive = Harmonic{.amplitude = kAmplitude, .omega = kOmega, .phase = kPhase};
  const LinkageRun run(linkage, accurate(kEnd));
  const double lead = 0.02 / (2.0 * std::numbers::pi);
  const double angle = kOmega * kEnd + kPhase;
  const double moment = -(1.5e-3 + 2.0 * lead * lead) * kAmplitude * kOmega * kOmega * std::sin(angle) +
                        1e-3 * kAmplitude * kOmega * std::cos(angle) + 2.0 * 9.81 * lead;
  // The slide's rate has errors of the tolerance, 1e-10, which Baumgarte's 2 alpha = 200/s makes an acceleration: times m lead.
  EXPECT_NEAR(run.last("turn_drive_n_m"), moment, 1e-10 * 200.0 * 2.0 * lead);
  EXPECT_LT(run.metric("energy_imbalance_j"), 1e-9);
}

// The work of turning drives balances the energy, also where only a slide is free: the masses lie beside the
// slide, on a driven crank, and under a driven eccentric.
TEST(Linkage, ADriveFeelsWhatSlidesBesideItsAxis) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("crank", 1.0, {0.1, 0.0, 0.0}, {0.02, 0.02, 0.02}), make_body("carriage", 2.0, {0.05, 0.2, 0.0}, {0.2, 0.2, 0.2}),
                    make_body("eccentric", 0.5, {0.03, 0.0, 0.1}, {0.02, 0.02, 0.02})};
  const DriveLaw turning = Harmonic{.amplitude = 0.8, .omega = 8.0};
  linkage.joints = {{.name = "turn", .from = kGroundName, .to = "crank", .placement = {}, .freedoms = {{.name = "turn", .drive = turning}}},
                    {.name = "slide", .kind = JointKind::kPrismatic, .from = "crank", .to = "carriage", .placement = {},
                     .axes = {Axis::kX, Axis::kY}, .freedoms = {{.name = "slide", .start = 0.1, .stiffness = 200.0}}},
                    {.name = "swing", .from = "carriage", .to = "eccentric", .placement = {}, .freedoms = {{.name = "swing", .drive = turning}}}};
  const LinkageRun run(linkage, accurate(2.0));
  EXPECT_GT(std::abs(run.last("slide_m") - 0.1), 1e-3);
  EXPECT_LT(run.metric("energy_imbalance_j"), 1e-7);
}

// A pendulum held twice at one point: the rows depend on each other, and the least reactions share its weight.
TEST(Linkage, RedundantJointsShareTheLoad) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("bar", 10.0, {0.4, 0.0, 0.0}, {1.0, 1.0, 1.0})};
  linkage.joints = {{.name = "float", .kind = JointKind::kPlanar, .from = kGroundName, .to = "bar", .placement = {},
                     .freedoms = {{.name = "x"}, {.name = "y"}, {.name = "angle", .start = 0.0}}},
                    {.name = "one", .from = kGroundName, .to = "bar", .placement = {}, .cut = true},
                    {.name = "two", .from = kGroundName, .to = "bar", .placement = {}, .cut = true}};
  const LinkageRun run(linkage, accurate(0.5));
  EXPECT_EQ(run.metric("redundant_constraints"), 8.0);
  // At the start I alpha = m g c: the pivot bears m g (1 - m c^2 / I), half of it in each joint.
  const double inertia = 1.0 + 10.0 * 0.16;
  // Rounding, over what is added to the matrix of dependent rows: 1e-16 / 1e-9 of about 100 N. At one instant
  // it is a draw, so it is measured over the run.
  constexpr double kShared = 1e-5;
  EXPECT_NEAR(run.column("one_force_y_n").front(), 0.5 * 98.1 * (1.0 - 1.6 / inertia), kShared);
  for (const char* const axis : {"x", "y", "z"}) {
    const std::string force = std::string("_force_") + axis + "_n";
    EXPECT_LT(root_mean_square_difference(run.column("one" + force), run.column("two" + force)), kShared) << axis;
    EXPECT_NEAR(run.last("float" + force), 0.0, 1e-6) << axis;  // lets the bar go where it will
  }
}

TEST(Linkage, ASpringOfTheUsersYieldsWhereTheLoopCloses) {
  Linkage linkage = make_four_bar(JointKind::kRevolute);
  linkage.joints[2].freedoms[0].stiffness = 5.0;
  const LinkageRun run(linkage, accurate(0.5));
  const double rocker = run.column("rocker_rad").front();
  EXPECT_GT(rocker, 1.0);
  // The spring's energy is in the account from the start.
  EXPECT_LT(run.metric("energy_imbalance_j"), 1e-8);
  EXPECT_GT(run.column("potential_energy_j").front(), 0.5 * 5.0 * rocker * rocker);
}

TEST(Linkage, AJournalMayMoveInItsClearanceFromTheStart) {
  Linkage linkage;
  linkage.bodies = {make_body("journal", 1.0, {0.0, 0.0, 0.0}, {0.01, 0.01, 0.01})};
  linkage.joints = {{.name = "float", .kind = JointKind::kPlanar, .from = kGroundName, .to = "journal", .placement = {},
                     .freedoms = {{.name = "x", .start_rate = 0.1}, {.name = "y"}, {.name = "angle"}}},
                    {.name = "bearing", .from = kGroundName, .to = "journal", .placement = {}, .cut = true, .clearance = ClearanceParameters{}}};
  const LinkageRun run(linkage, accurate(2e-3));
  EXPECT_NEAR(run.last("x_m"), 2e-4, 1e-12);  // of the 0.25 mm that it has
}

/// A journal that falls along its bearing's axis onto an elastic shoulder, and rebounds. With the force K_a delta, the
/// speed v = sqrt(2 g c_a) at contact and w = sqrt(K_a / m), a contact lasts 2 (pi - atan(v w / g)) / w and a flight
/// 2 v / g. The largest force is m g (1 + sqrt(1 + (v w / g)^2)).
TEST(Linkage, CountsAFaceThatHitsAShoulder) {
  constexpr double m = 2.0, g = 9.81;
  ClearanceParameters bearing;
  bearing.c_a = 1e-3;
  bearing.K_a = 1e6;
  bearing.chi = 0.0;
  Linkage linkage;
  linkage.gravity_W = {0.0, 0.0, -g};
  linkage.bodies = {make_body("journal", m, {0.0, 0.0, 0.0}, {0.01, 0.01, 0.01})};
  linkage.joints = {{.name = "fall", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "journal", .placement = {},
                     .freedoms = {{.name = "z"}}},
                    {.name = "bearing", .from = kGroundName, .to = "journal", .placement = {}, .cut = true, .clearance = bearing}};
  const double v = std::sqrt(2.0 * g * bearing.c_a), w = std::sqrt(bearing.K_a / m), fall = v / g;
  const double contact = 2.0 * (std::numbers::pi - std::atan(v * w / g)) / w;
  constexpr int kHits = 5;
  const double duration = kHits * (contact + 2.0 * fall);  // to the top of the last rebound
  const LinkageRun run(linkage, accurate(duration));
  EXPECT_EQ(run.metric("face_impact_count"), kHits);
  EXPECT_NEAR(run.metric("bearing_face_contact_time_ratio"), kHits * contact / duration, 1e-3 * contact / duration);
  const double peak = m * g * (1.0 + std::sqrt(1.0 + std::pow(v * w / g, 2)));
  EXPECT_NEAR(run.metric("peak_bearing_face_force_n"), peak, 1e-4 * peak);
}

TEST(Linkage, AWeldedBodyIsPartOfWhatCarriesIt) {
  Linkage whole;
  whole.gravity_W = {0.0, -9.81, 0.0};
  whole.bodies = {make_body("bar", 2.0, {0.5, 0.0, 0.0}, {0.0, 2.0 / 12.0, 2.0 / 12.0})};
  whole.joints = {{.name = "pivot", .from = kGroundName, .to = "bar", .placement = {}, .freedoms = {{.name = "angle"}}}};
  Linkage halves = whole;
  halves.bodies = {make_body("bar", 1.0, {0.25, 0.0, 0.0}, {0.0, 1.0 / 48.0, 1.0 / 48.0}),
                   make_body("tip", 1.0, {0.0, 0.25, 0.0}, {1.0 / 48.0, 0.0, 1.0 / 48.0})};
  const Eigen::Matrix3d quarter = (Eigen::Matrix3d() << 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0).finished();
  halves.joints.push_back({.name = "joint", .kind = JointKind::kWeld, .from = "bar", .to = "tip", .placement = {quarter, {0.5, 0.0, 0.0}}});
  EXPECT_NEAR(LinkageRun(halves, accurate(1.0)).last("angle_rad"), LinkageRun(whole, accurate(1.0)).last("angle_rad"), 1e-12);
}

/// @returns field of the refusal; empty if there is none
std::string refused_field(const Linkage& linkage) {
  try {
    check_linkage(linkage);
  } catch (const InvalidInput& refused) {
    return refused.field();
  }
  return "";
}

TEST(LinkageRefusal, NamesWhatIsAtFault) {
  EXPECT_EQ(refused_field(make_four_bar(JointKind::kRevolute)), "");
  Linkage open = make_four_bar(JointKind::kRevolute);
  open.joints[2].placement.p.x() = 2.0;
  EXPECT_EQ(refused_field(open), "joints.end");
  Linkage torn = make_four_bar(JointKind::kRevolute);
  torn.joints[2].freedoms[0].start_rate = 50.0;
  torn.joints[1].freedoms[0].start_rate = 0.0;
  EXPECT_EQ(refused_field(torn), "joints.end");
  Linkage massless = make_four_bar(JointKind::kRevolute);
  massless.bodies.push_back({.name = "nothing"});
  massless.joints.push_back({.name = "loose", .from = "coupler", .to = "nothing", .placement = {}, .freedoms = {{.name = "loose"}}});
  EXPECT_EQ(refused_field(massless), "joints.loose");
  // Each of two turns about one axis moves what is behind it; turned against each other they move nothing.
  for (const double inertia : {0.01, 0.3, 0.47, 0.7}) {
    Linkage idle;
    idle.bodies = {{.name = "ring"}, make_body("bar", 1.0, {0.5, 0.0, 0.0}, {inertia, inertia, inertia})};
    idle.joints = {{.name = "outer", .from = kGroundName, .to = "ring", .placement = {.R = z_to_x()}, .freedoms = {{.name = "outer"}}},
                   {.name = "inner", .from = "ring", .to = "bar", .placement = {}, .freedoms = {{.name = "inner"}}}};
    EXPECT_EQ(refused_field(idle), "joints") << inertia;
  }
  // A second bearing across the axis about which the drive turns.
  Linkage wedged = make_screw();
  wedged.joints = {{.name = "along", .from = kGroundName, .to = "nut", .placement = {},
                    .freedoms = {{.name = "turn", .drive = RunUp{.omega = 1.0, .run_up = 1.0}}}},
                   {.name = "across", .from = kGroundName, .to = "nut", .placement = {.R = z_to_x()}, .cut = true, .to_placement = {.R = z_to_x()}}};
  EXPECT_EQ(refused_field(wedged), "joints");
  Linkage jammed = make_screw();
  jammed.joints[0].freedoms[0].drive = Polynomial{{0.0}};
  jammed.joints[0].freedoms[1].drive = Polynomial{{0.0, 0.0, 5.0}};
  EXPECT_EQ(refused_field(jammed), "joints");
  jammed.joints[0].freedoms[0].drive = Polynomial{{0.0, 0.0, 5.0 * jammed.joints[0].lead}};  // now both drives say the same
  EXPECT_EQ(refused_field(jammed), "");
  Linkage impossible = make_four_bar(JointKind::kRevolute);
  impossible.bodies[1].inertia(2, 2) *= 3.0;
  EXPECT_EQ(refused_field(impossible), "bodies.coupler.inertia");
}

/// A crank about z whose end, so far from the axis, carries a block that slides in a slot across x: x = radius cos(angle).
Linkage make_scotch_yoke(double radius, const LinkageFreedom& crank, const LinkageFreedom& slide) {
  Linkage linkage;
  linkage.bodies = {make_body("crank", 1.0, {0.0, 0.0, 0.0}, {0.01, 0.01, 0.01}), make_body("yoke", 1.0, {0.0, 0.0, 0.0}, {0.01, 0.01, 0.01}),
                    make_body("block", 0.1, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  linkage.joints = {{.name = "crank", .from = kGroundName, .to = "crank", .placement = {}, .freedoms = {crank}},
                    {.name = "slide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "yoke", .placement = {}, .axes = {Axis::kX, Axis::kY},
                     .freedoms = {slide}},
                    {.name = "slot", .kind = JointKind::kPrismatic, .from = "yoke", .to = "block", .placement = {}, .axes = {Axis::kY, Axis::kX},
                     .freedoms = {{.name = "y", .guess = 0.5 * radius}}},
                    {.name = "pin", .from = "crank", .to = "block", .placement = {.p = {radius, 0.0, 0.0}}, .cut = true}};
  return linkage;
}

TEST(LinkageRefusal, LetsDrivesBeginThatDoNotJam) {
  const LinkageFreedom turning{.name = "angle", .start = 0.0, .start_rate = 8.0};
  // At a dead centre that the crank passes.
  const LinkageFreedom led{.name = "x", .drive = Harmonic{.amplitude = 0.1, .omega = 8.0, .phase = 0.5 * std::numbers::pi}};
  EXPECT_EQ(refused_field(make_scotch_yoke(0.1, turning, led)), "");
  // From a dead centre, where the crank at rest may go either way; but not beyond its reach.
  const LinkageFreedom resting{.name = "angle", .guess = 0.0};
  const auto away = [](double rise) { return LinkageFreedom{.name = "x", .drive = CycloidalRise{.from = 0.1, .rise = rise, .time = 0.1}}; };
  EXPECT_EQ(refused_field(make_scotch_yoke(0.1, resting, away(-0.05))), "");
  EXPECT_EQ(refused_field(make_scotch_yoke(0.1, resting, away(0.05))), "joints");
  // A drive that jams after a later beginning is accepted: the run finds the jam.
  const LinkageFreedom later{.name = "x", .drive = CycloidalRise{.from = 0.1, .rise = 0.05, .begin = 1.0, .time = 0.1}};
  EXPECT_EQ(refused_field(make_scotch_yoke(0.1, resting, later)), "");
  // Two drives that go together round a small circle, of which a tenth of a millimetre is a good part.
  const DriveLaw swing = Polynomial{{0.7, 0.0, 2.0}};
  const DriveLaw along = Polynomial{{0.003 * std::cos(0.7), 0.0, -0.003 * 2.0 * std::sin(0.7)}};
  EXPECT_EQ(refused_field(make_scotch_yoke(0.003, {.name = "angle", .drive = swing}, {.name = "x", .drive = along})), "");
}

/// A law's derivatives are those of its position, here by differences.
TEST(DriveLaws, HaveTheirDerivatives) {
  const std::vector<DriveLaw> laws{CycloidalRise{0.1, 0.4, 0.2, 0.8}, Harmonic{0.1, 0.3, 5.0, 0.4}, Polynomial{{0.1, -0.2, 0.3, 0.4, -0.1}},
                                   Spline({0.0, 0.3, 0.5, 1.0}, {0.0, 0.2, 0.1, 0.4})};
  constexpr double h = 1e-4;
  for (const DriveLaw& law : laws)
    for (const double t : {0.1, 0.42, 0.77}) {
      const DrivenMotion before = calc_driven_motion(law, t - h), at = calc_driven_motion(law, t), after = calc_driven_motion(law, t + h);
      EXPECT_NEAR(at.qd, (after.q - before.q) / (2.0 * h), 1e-5) << law.index() << " at " << t;
      EXPECT_NEAR(at.qdd, (after.qd - before.qd) / (2.0 * h), 1e-4) << law.index() << " at " << t;
      EXPECT_NEAR(at.qddd, (after.qdd - before.qdd) / (2.0 * h), 1e-3) << law.index() << " at " << t;
    }
}

TEST(DriveLaws, ASplineGoesThroughItsPointsWithoutAKink) {
  const std::vector<double> t{0.0, 0.3, 0.5, 1.0}, q{0.0, 0.2, 0.1, 0.4};
  const Spline spline(t, q);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(spline.calc(t[k]).q, q[k], 1e-15);
    const DrivenMotion before = spline.calc(t[k] - 1e-12), after = spline.calc(t[k] + 1e-12);
    EXPECT_NEAR(before.qd, after.qd, 1e-9);
    EXPECT_NEAR(before.qdd, after.qdd, 1e-9);
  }
  EXPECT_EQ(spline.calc(2.0).qdd, 0.0);
  EXPECT_NEAR(spline.calc(2.0).q, 0.4 + spline.calc(1.0).qd, 1e-14);
  EXPECT_EQ(spline.next_knot(0.3), 0.5);
}

}  // namespace
}  // namespace engine
