// SPDX-License-Identifier: Apache-2.0
// Linkages drawn at random: whatever they are, they end as a run that keeps its account of energy, or as a refusal or failure that says why.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/errors.h"
#include "engine/kinematics/frame_motion.h"
#include "engine/simulate_linkage.h"
#include "tests/engine/draw.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

/// Flat linkages, and joints whose axes meet, are as likely as others.
Eigen::Matrix3d draw_turn(Draw& draw, bool flat) {
  const double angle = draw.within(-2.0, 2.0);
  if (flat) return draw.happens(0.5) ? Eigen::Matrix3d::Identity() : Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return Eigen::AngleAxisd(angle, draw.point(1.0).normalized()).toRotationMatrix();
}

Placement draw_placement(Draw& draw, bool flat) {
  Placement placement{draw_turn(draw, flat), draw.point(0.3)};
  if (flat) placement.p.z() = 0.0;
  return placement;
}

DriveLaw draw_law(Draw& draw) {
  switch (draw.below(4)) {
    case 0: return RunUp{.omega = draw.within(-5.0, 5.0), .run_up = draw.within(0.01, 0.2)};
    case 1: return Harmonic{.mean = 0.1, .amplitude = draw.within(0.01, 0.2), .omega = draw.within(1.0, 20.0), .phase = draw.within(0.0, 6.0)};
    case 2: return CycloidalRise{.from = 0.1, .rise = draw.within(-0.3, 0.3), .begin = draw.within(0.0, 0.1), .time = draw.within(0.05, 0.2)};
    default: return Polynomial{{0.1, draw.within(-1.0, 1.0), draw.within(-1.0, 1.0)}};
  }
}

LinkageJoint draw_joint(Draw& draw, const std::string& name, const std::string& from, const std::string& to, bool flat) {
  constexpr std::array kKinds{JointKind::kRevolute, JointKind::kPrismatic, JointKind::kCylindrical, JointKind::kScrew,  JointKind::kUniversal,
                              JointKind::kSpherical, JointKind::kPlanar,    JointKind::kFree,        JointKind::kWeld};
  LinkageJoint joint{.name = name, .kind = flat ? JointKind::kRevolute : kKinds[draw.below(kKinds.size())], .from = from, .to = to,
                     .placement = draw_placement(draw, flat)};
  if (joint.kind == JointKind::kScrew) joint.lead = draw.within(1e-3, 1e-2);
  const std::size_t freedoms = freedoms_of(joint).size();
  for (std::size_t k = 0; k < freedoms; ++k) {
    LinkageFreedom freedom{.name = name + "_" + std::to_string(k), .guess = joint.kind == JointKind::kScrew ? 0.0 : draw.within(-0.5, 0.5)};
    if (draw.happens(0.3) && joint.kind != JointKind::kScrew)
      freedom.drive = draw_law(draw);
    else if (draw.happens(0.3))
      freedom.damping = draw.within(0.0, 0.1);
    joint.freedoms.push_back(freedom);
  }
  return joint;
}

/// Where the linkage's bodies are before its loops are closed.
std::vector<Placement> find_poses(const Linkage& linkage) {
  const BuiltLinkage built = build_linkage(linkage);
  const auto n = static_cast<Eigen::Index>(built.mechanism.coordinates.size());
  Eigen::VectorXd q(n);
  for (Eigen::Index i = 0; i < n; ++i) q[i] = built.mechanism.coordinates[static_cast<std::size_t>(i)].assembly_guess;
  for (const Drive& drive : built.mechanism.drives) q[drive.coordinate] = calc_driven_motion(drive.law, 0.0).q;
  std::vector<FrameMotion> frames(static_cast<std::size_t>(n));
  calc_frame_motions(built.mechanism, q, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), frames);
  std::vector<Placement> poses;
  for (const BodyFrames& body : built.bodies) {
    const BodyFrames::Part& part = body.parts.front();
    const FrameMotion frame = part.frame == kGround ? FrameMotion{} : frames[static_cast<std::size_t>(part.frame)];
    poses.push_back({frame.R * part.placement.R, frame.p + frame.R * part.placement.p});
  }
  return poses;
}

/// Closes a loop where the bodies are, between two of them or one and the ground.
LinkageJoint draw_loop(Draw& draw, const Linkage& linkage, const std::vector<Placement>& poses, const std::string& name, bool flat) {
  constexpr std::array kKinds{JointKind::kRevolute, JointKind::kPrismatic, JointKind::kCylindrical,
                              JointKind::kUniversal, JointKind::kSpherical, JointKind::kWeld};
  const std::size_t to = draw.below(poses.size());
  const std::size_t from = (to + 1 + draw.below(poses.size())) % (poses.size() + 1);  // the last one stands for the ground
  const Placement base = from < poses.size() ? poses[from] : Placement{};
  LinkageJoint joint{.name = name, .kind = flat ? JointKind::kRevolute : kKinds[draw.below(kKinds.size())],
                     .from = from < poses.size() ? linkage.bodies[from].name : kGroundName, .to = linkage.bodies[to].name,
                     .placement = draw_placement(draw, flat), .cut = true};
  const Eigen::Matrix3d back = poses[to].R.transpose();
  joint.to_placement = {back * base.R * joint.placement.R, back * (base.p + base.R * joint.placement.p - poses[to].p)};
  if (joint.kind == JointKind::kRevolute && draw.happens(0.3)) joint.clearance = ClearanceParameters{};
  return joint;
}

/// Adds loads, sensors and springs to bodies, whether they move or not.
void draw_attachments(Draw& draw, Linkage& linkage) {
  for (const LinkageBody& body : linkage.bodies) {
    if (draw.happens(0.4))
      linkage.loads.push_back({.name = body.name + "_load",
                               .body = body.name,
                               .at = draw.point(0.2),
                               .force = draw.point(5.0),
                               .follows_body = draw.happens(0.5),
                               .law = Constant{1.0}});
    if (draw.happens(0.4))
      linkage.accelerometers.push_back({.name = body.name + "_sensor",
                                        .body = body.name,
                                        .at = draw.point(0.2),
                                        .direction = draw.point(1.0).normalized()});
    if (draw.happens(0.2))
      linkage.springs.push_back({.name = body.name + "_spring",
                                 .from = kGroundName,
                                 .to = body.name,
                                 .at = draw.point(0.5),
                                 .to_at = draw.point(0.2),
                                 .stiffness = 50.0,
                                 .damping = 0.1});
  }
}

Linkage draw_linkage(Draw& draw) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  const bool flat = draw.happens(0.4);
  const std::size_t bodies = 1 + draw.below(4);
  for (std::size_t i = 0; i < bodies; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    const Eigen::Vector3d sides = draw.point(0.2).cwiseProduct(draw.point(0.2)).cwiseAbs();
    linkage.bodies.push_back(make_body(name, draw.within(0.2, 3.0), draw.point(0.1), Eigen::Vector3d::Constant(sides.sum() + 1e-3) - sides));
    const std::size_t carrier = draw.below(i + 1);
    linkage.joints.push_back(draw_joint(draw, "j" + name, carrier == i ? kGroundName : linkage.bodies[carrier].name, name, flat));
  }
  const std::vector<Placement> poses = find_poses(linkage);
  const std::size_t loops = draw.below(3);
  for (std::size_t k = 0; k < loops; ++k) linkage.joints.push_back(draw_loop(draw, linkage, poses, "l" + std::to_string(k), flat));
  draw_attachments(draw, linkage);
  return linkage;
}

/// The same linkage, turned as a whole.
Linkage turn(Linkage linkage, const Eigen::Matrix3d& R) {
  linkage.gravity_W = R * linkage.gravity_W;
  for (LinkageJoint& joint : linkage.joints)
    if (joint.from == kGroundName) joint.placement = {R * joint.placement.R, R * joint.placement.p};
  for (LinkageLoad& load : linkage.loads)
    if (!load.follows_body) load.force = R * load.force;
  for (LinkageSpring& spring : linkage.springs) spring.at = R * spring.at;
  return linkage;
}

constexpr RunOptions kDrawnRun{.duration = 0.1,
                               .output_rate = 100.0,
                               .relative_tolerance = 1e-7,
                               .absolute_tolerance = 1e-7,
                               .step_limit = 20'000};

/// A run of a linkage, by what it must hold whatever the linkage is. @returns its status; empty if it was refused
std::optional<RunStatus> run_drawn(const Linkage& linkage) {
  try {
    const RunResult run = simulate_linkage(linkage, kDrawnRun, 0.0, {});
    if (run.status != RunStatus::kSucceeded) {
      EXPECT_FALSE(run.detail.empty());
      return run.status;
    }
    const std::vector<QuantityInfo> metrics = linkage_tables(linkage).metrics;
    const auto metric = [&](const char* key) {
      return run.metrics.at(static_cast<std::size_t>(std::ranges::find(metrics, key, &QuantityInfo::key) - metrics.begin()));
    };
    // A journal that begins deep in its bore is thrown out with up to 1e10 J: their roundings are more.
    constexpr double kRounding = 1e-13;
    EXPECT_TRUE(metric("energy_imbalance_j") < 1e-4 || metric("energy_residual") < kRounding) << metric("energy_imbalance_j");
    for (std::size_t k = 0; k < metrics.size(); ++k)
      EXPECT_TRUE(!metrics[k].key.ends_with("_accelerometer_m_s2") || std::isfinite(run.metrics[k]))
          << metrics[k].key;
    return run.status;
  } catch (const InvalidInput& refusal) {
    EXPECT_FALSE(refusal.field().empty());
    EXPECT_FALSE(refusal.detail().empty());
  }
  return std::nullopt;
}

TEST(DrawnLinkages, RunOrSayWhyNot) {
  int succeeded = 0, refused = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const std::optional<RunStatus> status = run_drawn(draw_linkage(draw));
    refused += status ? 0 : 1;
    succeeded += status == RunStatus::kSucceeded ? 1 : 0;
  }
  EXPECT_GE(succeeded, 280);
  EXPECT_LE(refused, 110);  // their drives contradict each other or the loops; the few that are left lock up on their way
}

/// Outcome of a linkage without clearance: a refusal, a status, or redundancy and energies at the end.
struct DrawnOutcome {
  bool is_refused = false;
  RunStatus status = RunStatus::kSucceeded;
  double redundant = 0.0, kinetic = 0.0, potential = 0.0;
};

DrawnOutcome find_drawn_outcome(const Linkage& linkage) {
  try {
    const RunResult run = simulate_linkage(linkage, kDrawnRun, 0.0, {});
    DrawnOutcome outcome{.status = run.status};
    if (run.status != RunStatus::kSucceeded) return outcome;
    const LinkageRun known(linkage, kDrawnRun);
    outcome.redundant = known.metric("redundant_constraints");
    outcome.kinetic = known.last("kinetic_energy_j");
    outcome.potential = known.last("potential_energy_j") - known.column("potential_energy_j")[0];
    return outcome;
  } catch (const InvalidInput&) {
    return {.is_refused = true};
  }
}

TEST(DrawnLinkages, AreTheSameTurnedAsAWhole) {
  int compared = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Linkage linkage = draw_linkage(draw);
    if (std::ranges::any_of(linkage.joints,
                            [](const LinkageJoint& joint) { return joint.clearance.has_value(); }))
      continue;
    const DrawnOutcome given = find_drawn_outcome(linkage),
                       turned = find_drawn_outcome(turn(linkage, draw_turn(draw, false)));
    EXPECT_EQ(given.is_refused, turned.is_refused);
    EXPECT_EQ(given.status, turned.status);
    EXPECT_EQ(given.redundant, turned.redundant);
    if (given.status != turned.status) continue;
    EXPECT_NEAR(given.kinetic, turned.kinetic, 1e-4 * (1.0 + given.kinetic));
    EXPECT_NEAR(given.potential, turned.potential, 1e-4 * (1.0 + std::abs(given.potential)));
    ++compared;
  }
  EXPECT_GE(compared, 100);
}

}  // namespace
}  // namespace engine
