// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "engine/dynamics/energies.h"
#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/dynamics/spring_motion.h"
#include "engine/errors.h"
#include "engine/integrate/kinematic_run.h"
#include "engine/integrate/spherical_charts.h"
#include "engine/simulate_linkage.h"

namespace engine {

namespace {

/// About the centre of mass no principal moment is below 0 or above the sum of the other two; those of a thin
/// beam are 0 and equal.
bool is_inertia_of_a_body(const LinkageBody& body) {
  const Eigen::Vector3d& c = body.com;
  const Eigen::Matrix3d central =
      body.inertia - body.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(central, Eigen::EigenvaluesOnly).eigenvalues();
  const double rounding = 1e-9 * body.inertia.trace();
  return moments.allFinite() && moments.minCoeff() >= -rounding &&
         moments.sum() - 2.0 * moments.maxCoeff() >= -rounding;
}

void check_body(const LinkageBody& body) {
  const std::string name = "bodies." + body.name;
  if (body.beam) {
    require(body.beam->mass > 0.0, name + ".mass", "above 0, as the body is a beam");
    return;
  }
  require(body.mass >= 0.0 && std::isfinite(body.mass), name + ".mass", "a finite number of at least 0");
  require(body.mass > 0.0 || body.inertia.isZero(0.0), name + ".inertia",
          "left out, as the body has no mass");
  require(is_inertia_of_a_body(body), name + ".inertia",
          "that of a body: about the centre of mass no principal moment is below 0 or larger than the sum of "
          "the other two");
}

/// Gives the springs of no given free length the one with which they are unloaded. A spring or damper that
/// pulls along the line between its ends must have such a line.
void settle_springs(const Linkage& linkage, BuiltLinkage& built, const Evaluation& assembled) {
  constexpr double kMeeting = 1e-9;  // [m]
  for (std::size_t k = 0; k < linkage.springs.size(); ++k) {
    PointSpring& spring = built.mechanism.springs[k];
    const double length = calc_spring_motion(spring, assembled.frames).length;
    if (!linkage.springs[k].free_length) spring.free_length = length < kMeeting ? 0.0 : length;
    if (length < kMeeting && (spring.free_length > 0.0 || spring.damping > 0.0))
      throw InvalidInput("springs." + linkage.springs[k].name,
                         "has its ends in one place at t = 0, where neither a free length nor a damper has a "
                         "direction to push in: "
                         "move one of them, or leave it a spring of free length 0 without damping");
  }
}

/// The joint that a coordinate is part of, or the body inside which it is.
std::string owner_of(const Linkage& linkage, const BuiltLinkage& built, FrameIndex coordinate) {
  for (std::size_t k = 0; k < built.joints.size(); ++k)
    if (coordinate >= built.joints[k].first && coordinate < built.joints[k].first + built.joints[k].count)
      return "joints." + linkage.joints[k].name;
  return "";
}

/// Kinetic energies of unit speeds of some coordinates: alone on the diagonal, by twos beside it.
/// @param alone  only the diagonal
Eigen::MatrixXd calc_unit_energies(const Mechanism& m, const Evaluation& assembled,
                                   const std::vector<FrameIndex>& coordinates, bool alone) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(assembled.q.size());
  std::vector<FrameMotion> frames(m.coordinates.size());
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd qd(none.size());
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = alone ? i : 0; k <= i; ++k) {
      qd.setZero();
      qd[coordinates[static_cast<std::size_t>(i)]] = 1.0;
      qd[coordinates[static_cast<std::size_t>(k)]] = 1.0;
      calc_frame_motions(m, assembled.q, qd, none, frames);
      T(i, k) = T(k, i) = calc_kinetic_energy(m, frames, qd);
    }
  return T;
}

/// Mass matrix of some coordinates. @param alone  only its diagonal
Eigen::MatrixXd calc_mass_matrix(const Mechanism& m, const Evaluation& assembled,
                                 const std::vector<FrameIndex>& coordinates, bool alone) {
  Eigen::MatrixXd M = calc_unit_energies(m, assembled, coordinates, alone);
  const Eigen::VectorXd energies = M.diagonal();
  M.colwise() -= energies;
  M.rowwise() -= energies.transpose();
  M.diagonal() = 2.0 * energies;
  return M;
}

/// @returns whether the mechanism has joints that close loops without clearance
bool closes_loops(const Mechanism& mechanism) {
  return std::ranges::any_of(mechanism.cut_joints, [](const CutJoint& joint) { return !joint.clearance; });
}

/// Mass that each coordinate carries, that of coordinates behind it included.
std::vector<double> calc_carried_masses(const std::vector<Coordinate>& coordinates) {
  std::vector<double> carried(coordinates.size());
  for (std::size_t i = coordinates.size(); i-- > 0;) {
    if (coordinates[i].role == CoordinateRole::kJoint) carried[i] += coordinates[i].mass;
    if (coordinates[i].parent != kGround)
      carried[static_cast<std::size_t>(coordinates[i].parent)] += carried[i];
  }
  return carried;
}

/// Where loops are solved with masses, no free coordinate may carry next to nothing beside the others:
/// rounding of the heavy bodies' motion would move the light ones.
void check_mass_ratios(const Linkage& linkage, const BuiltLinkage& built,
                       const std::vector<FrameIndex>& free) {
  constexpr double kLeast = 5e-9;  // below, steps shrink to nothing
  if (free.empty()) return;
  const std::vector<Coordinate>& coordinates = built.mechanism.coordinates;
  const std::vector<double> carried = calc_carried_masses(coordinates);
  const double most = *std::ranges::max_element(carried);
  for (const FrameIndex i : free)
    if (const double ratio = carried[static_cast<std::size_t>(i)] / most; ratio < kLeast) {
      std::ostringstream detail;
      detail << "carries, by its coordinate " << coordinates[static_cast<std::size_t>(i)].name << ", only "
             << ratio << " of the largest mass that a coordinate carries; in loops that the drives do not "
             << "determine, at least " << kLeast
             << " can be computed: give the bodies that it carries more, or drive the linkage";
      throw InvalidInput(owner_of(linkage, built, i), detail.str());
    }
}

/// No free coordinate may move nothing that has mass. @param moved  by each, [kg m^2] or [kg]
void check_moved_masses(const Linkage& linkage, const BuiltLinkage& built,
                        const std::vector<FrameIndex>& free, const Eigen::VectorXd& moved) {
  constexpr double kNothing = 1e-15;  // of what the heaviest freedom moves
  for (std::size_t k = 0; k < free.size(); ++k)
    if (!(moved[static_cast<Eigen::Index>(k)] > kNothing * moved.maxCoeff()))
      throw InvalidInput(
          owner_of(linkage, built, free[k]),
          "is free to move by its coordinate " +
              built.mechanism.coordinates[static_cast<std::size_t>(free[k])].name +
              ", and nothing that it moves has mass: give the bodies that it carries some, or drive it");
}

/// Several free coordinates together may not move nothing that has mass, either. @param M  of all of them
void check_mass_matrix(const Eigen::MatrixXd& M) {
  // Least eigenvalue of the matrix with its diagonal scaled to 1: rounding.
  constexpr double kNoneOfThem = 1e-13;
  const Eigen::VectorXd moved = M.diagonal();
  const Eigen::VectorXd scale = moved.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * M * scale.asDiagonal();
  if (!(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
            .eigenvalues()
            .minCoeff() > kNoneOfThem))
    throw InvalidInput("joints",
                       "are free to move together in a way in which nothing that they move has mass (one "
                       "behind the other about the same "
                       "axis, say): give the bodies that they carry some, or drive them");
}

void check_masses(const Linkage& linkage, const BuiltLinkage& built, const Evaluation& assembled,
                  const std::vector<FrameIndex>& free) {
  constexpr std::size_t kMany = 60;  // coordinates: the matrix of more takes long
  if (free.empty()) return;
  const bool alone = free.size() > kMany;
  Mechanism mechanism = built.mechanism;
  constexpr double kSingular = 1e-6;  // cosine
  if (const auto locked = find_gimbal_lock(mechanism, assembled.q, kSingular))
    throw InvalidInput(owner_of(linkage, built, *locked), describe_gimbal_lock(mechanism, *locked));
  Evaluation at = assembled;
  SphericalCharts(mechanism).update(mechanism, at.q, at.qd);
  const Eigen::MatrixXd M = calc_mass_matrix(mechanism, at, free, alone);
  check_moved_masses(linkage, built, free, M.diagonal());
  if (!alone) check_mass_matrix(M);
}

/// Checks of the masses that free coordinates of joints carry.
void check_free_coordinates(const Linkage& linkage, const BuiltLinkage& built, const Evaluation& assembled,
                            std::vector<FrameIndex> free) {
  std::erase_if(free, [&](FrameIndex i) {
    return built.mechanism.coordinates[static_cast<std::size_t>(i)].role != CoordinateRole::kJoint;
  });
  check_masses(linkage, built, assembled, free);
  if (closes_loops(built.mechanism)) check_mass_ratios(linkage, built, free);
}

/// The linkage's joint that is one of the mechanism's cut joints.
std::string name_of_cut(const Linkage& linkage, const BuiltLinkage& built, int cut) {
  const auto found =
      std::ranges::find_if(built.joints, [cut](const BuiltJoint& joint) { return joint.cut == cut; });
  return linkage.joints[static_cast<std::size_t>(found - built.joints.begin())].name;
}

/// Distance of the parts of a cut joint, [m]
double calc_gap(const CutJoint& joint, const Evaluation& at) {
  const auto point_of = [&](FrameIndex frame, const Placement& placement) -> Eigen::Vector3d {
    const FrameMotion body = motion_of(frame, at.frames);
    return body.p + body.R * placement.p;
  };
  return (point_of(joint.journal_frame, joint.journal) - point_of(joint.bearing_frame, joint.bearing)).norm();
}

/// The cut joint whose parts stand furthest apart.
std::string widest_gap(const Linkage& linkage, const BuiltLinkage& built, const Evaluation& at) {
  std::string widest;
  double most = -1.0;
  for (std::size_t k = 0; k < built.joints.size(); ++k) {
    if (built.joints[k].cut < 0) continue;
    const CutJoint& joint = built.mechanism.cut_joints[static_cast<std::size_t>(built.joints[k].cut)];
    const double gap = calc_gap(joint, at);
    if (gap > most) {
      most = gap;
      widest = linkage.joints[k].name;
    }
  }
  return widest.empty() ? "joints" : "joints." + widest;
}

/// @returns whether a joint, by its field, has clearance and carries its second body
bool is_loose(const Linkage& linkage, const std::string& field) {
  return std::ranges::any_of(linkage.joints, [&](const LinkageJoint& joint) {
    return "joints." + joint.name == field && joint.clearance && !joint.cut;
  });
}

/// Fault of loops that are left with a gap, as the rest of a sentence.
/// @param loose  whether is_loose() holds for the joint with the gap
std::string describe_open_loop(const LoopClosure& closure, bool loose) {
  if (!closure.rates_fit())
    return "would be torn apart by the start rates given: they and the drives contradict each other";
  if (loose)
    return "is not within its clearance at t = 0: a start of one of its coordinates, or of "
           "another joint's, is beyond the play (that along the axis is "
           "axial_clearance_mm), or the loops do not close";
  std::ostringstream text;
  text << "does not close at t = 0: the nearest position found leaves a gap of " << std::setprecision(3)
       << closure.residual()
       << " m (or between right angles); other lengths, a guess or start of a coordinate nearer to the "
          "closed position, or fewer starts, may help";
  return text.str();
}

[[noreturn]] void refuse_open_loops(const Linkage& linkage, const BuiltLinkage& built,
                                    const LoopClosure& closure, const Evaluation& assembled) {
  if (closure.turned_over_joint() >= 0)
    throw InvalidInput("joints." + name_of_cut(linkage, built, closure.turned_over_joint()),
                       "closes at t = 0 only with its second body turned over by a half turn; a guess or "
                       "start of a coordinate nearer to the right position, or other axes, may help");
  // Where positions fit, gaps are rounding: of several loops they do not tell the one whose rates do not.
  const bool is_known = closure.rates_fit() || built.mechanism.cut_joints.size() == 1;
  const std::string joint = is_known ? widest_gap(linkage, built, assembled) : "joints";
  throw InvalidInput(joint, describe_open_loop(closure, is_loose(linkage, joint)));
}

void check_start_of_drives(LoopClosure& closure, const Evaluation& assembled) {
  if (!closure.drives_can_start(assembled))
    throw InvalidInput("joints",
                       "cannot follow their drives: these move against each other, or against joints that "
                       "close loops; let one of the "
                       "drives go, or a joint that closes a loop allow the motion");
}

}  // namespace

BuiltLinkage check_linkage(const Linkage& linkage, Integrator integrator) {
  for (const LinkageBody& body : linkage.bodies) check_body(body);
  BuiltLinkage built = build_linkage(linkage);
  const MotionSystem system(built.mechanism);
  LoopClosure closure(built.mechanism);
  Evaluation assembled = system.make_evaluation();
  if (!closure.assemble(0.0, assembled)) refuse_open_loops(linkage, built, closure, assembled);
  check_start_of_drives(closure, assembled);
  // If the drives determine the motion, masses need not.
  if (!allows_kinematics(built.mechanism, integrator) ||
      closure.find_determinacy(assembled) == LoopClosure::Determinacy::kFree)
    check_free_coordinates(linkage, built, assembled, system.free_coordinates());
  settle_springs(linkage, built, assembled);
  return built;
}

int count_undriven_freedoms(const Linkage& linkage) {
  (void)check_linkage(linkage);
  Linkage rigid = linkage;  // no drive is to bend a beam
  for (LinkageBody& body : rigid.bodies) body.beam.reset();
  const BuiltLinkage built = build_linkage(rigid);
  LoopClosure closure(built.mechanism);
  Evaluation assembled = MotionSystem(built.mechanism).make_evaluation();
  require(closure.assemble(0.0, assembled), "joints", "closed at t = 0");
  const auto coordinates =
      std::ranges::count(built.mechanism.coordinates, CoordinateRole::kJoint, &Coordinate::role);
  const auto left = static_cast<int>(coordinates - closure.count_independent(assembled));
  return left - static_cast<int>(built.mechanism.drives.size());
}

}  // namespace engine
