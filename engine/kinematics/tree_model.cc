// SPDX-License-Identifier: Apache-2.0
#include "engine/kinematics/tree_model.h"

#include <algorithm>
#include <cstddef>

#include "engine/model/spherical_rotations.h"

namespace engine {

namespace {

std::array<double, 9> columns_of(const Eigen::Matrix3d& m) {
  std::array<double, 9> columns{};
  Eigen::Map<Eigen::Matrix3d>(columns.data()) = m;
  return columns;
}

std::array<double, 3> array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

bool is_along_x(const Eigen::Vector3d& v) { return v.y() == 0.0 && v.z() == 0.0; }

TreePlacement make_placement(const Placement& placement) {
  return {!is_unrotated(placement), !placement.p.isZero(0.0), is_along_x(placement.p),
          columns_of(placement.R), array_of(placement.p)};
}

JointTraits::Inertia kind_of_inertia(const Coordinate& c) {
  if (c.mass == 0.0) return JointTraits::Inertia::kNone;
  const Eigen::Matrix3d& I = c.inertia;
  if (!I.isDiagonal(0.0)) return JointTraits::Inertia::kFull;
  return I(1, 1) == I(2, 2) ? JointTraits::Inertia::kAxisymmetric : JointTraits::Inertia::kDiagonal;
}

void set_placement(const Placement& placement, TreeJoint& joint) {
  joint.placement = make_placement(placement);
  joint.rotated = joint.placement.rotated;
  joint.shifted = joint.placement.shifted;
  joint.shifted_along_x = joint.placement.along_x;
}

void set_body(const Coordinate& c, TreeJoint& joint) {
  joint.inertia = kind_of_inertia(c);
  joint.mass = c.mass;
  joint.mc = array_of(c.mass * c.com);
  joint.com_at_origin = c.com.isZero(0.0);
  joint.com_along_x = is_along_x(c.com);
  joint.I = columns_of(c.inertia);
}

/// Finds the joints among a mechanism's coordinates.
class JointFinder {
 public:
  explicit JointFinder(const Mechanism& mechanism)
      : mechanism_(mechanism), joint_of_(mechanism.coordinates.size(), -1) {}

  std::vector<TreeJoint> find() {
    for (int i = 0; i < static_cast<int>(mechanism_.coordinates.size()); i += joints_.back().count())
      add_joint(i);
    complete_traits(joints_);
    return joints_;
  }

  [[nodiscard]] int joint_of(FrameIndex frame) const {
    return frame == kGround ? -1 : joint_of_[static_cast<std::size_t>(frame)];
  }

 private:
  [[nodiscard]] const Coordinate& coordinate(int i) const {
    return mechanism_.coordinates[static_cast<std::size_t>(i)];
  }

  void add_joint(int i) {
    const Coordinate& c = coordinate(i);
    TreeJoint joint;
    set_motion(i, joint);
    set_placement(c.placement, joint);
    joint.parent = joint_of(c.parent);
    set_springs(i, joint);
    joint.armature = c.armature;
    joint.has_armature = c.armature != 0.0;
    set_body(coordinate(i + joint.count() - 1), joint);
    for (int k = 0; k < joint.count(); ++k)
      joint_of_[static_cast<std::size_t>(i + k)] = static_cast<int>(joints_.size());
    joints_.push_back(joint);
  }

  void set_motion(int i, TreeJoint& joint) const {
    const Coordinate& c = coordinate(i);
    joint.kind = is_spherical(i)                 ? JointTraits::Kind::kSpherical
                 : c.motion == Motion::kRotation ? JointTraits::Kind::kRotation
                                                 : JointTraits::Kind::kTranslation;
    joint.axis = static_cast<int>(c.axis);
    joint.drive = eliminating_drive(i);
    joint.driven = joint.drive >= 0;
  }

  void set_springs(int i, TreeJoint& joint) const {
    for (int k = 0; k < joint.count(); ++k) {
      const Coordinate& c = coordinate(i + k);
      joint.stiffness[static_cast<std::size_t>(k)] = c.stiffness;
      joint.damping[static_cast<std::size_t>(k)] = c.damping;
      joint.sprung = joint.sprung || c.stiffness != 0.0 || c.damping != 0.0;
    }
  }

  /// The drive that gives a coordinate's motion; -1: it is free, or a multiplier enforces the drive.
  [[nodiscard]] int eliminating_drive(int i) const {
    if (mechanism_.drive_rows != DriveRows::kEliminated) return -1;
    const auto drive = std::find_if(mechanism_.drives.begin(), mechanism_.drives.end(),
                                    [i](const Drive& d) { return d.coordinate == i; });
    return drive == mechanism_.drives.end() ? -1 : static_cast<int>(drive - mechanism_.drives.begin());
  }

  /// Rotations of one point that none but the joint itself moves.
  [[nodiscard]] bool is_spherical(int i) const {
    if (!are_spherical_rotations(mechanism_, i)) return false;
    for (const int k : {i, i + 1, i + 2})
      if (eliminating_drive(k) >= 0 || coordinate(k).armature != 0.0) return false;
    return true;
  }

  const Mechanism& mechanism_;
  std::vector<TreeJoint> joints_;
  std::vector<int> joint_of_;
};

/// A cut joint but for its rows, or its index among the joints with clearance.
TreeCutJoint make_cut_joint(const CutJoint& joint, const JointFinder& finder) {
  return {.bearing_joint = finder.joint_of(joint.bearing_frame),
          .journal_joint = finder.joint_of(joint.journal_frame),
          .bearing = make_placement(joint.bearing),
          .journal = make_placement(joint.journal),
          .rows = {}};
}

TreeSpring make_spring(const PointSpring& spring, const JointFinder& finder) {
  return {.from_joint = finder.joint_of(spring.from_frame),
          .to_joint = finder.joint_of(spring.to_frame),
          .from = make_placement({.p = spring.from}),
          .to = make_placement({.p = spring.to}),
          .stiffness = spring.stiffness,
          .damping = spring.damping,
          .drag = spring.drag,
          .free_length = spring.free_length};
}

}  // namespace

CutRows rows_of(CutKind kind) {
  switch (kind) {
    case CutKind::kRevolute: return {3, 2};
    case CutKind::kSpherical: return {3, 0};
    case CutKind::kUniversal: return {3, 1};
    case CutKind::kCylindrical: return {2, 2};
    case CutKind::kPrismatic: return {2, 3};
    case CutKind::kWeld: return {3, 3};
  }
  return {};
}

TreeModel::TreeModel(const Mechanism& mechanism)
    : coordinates(static_cast<int>(mechanism.coordinates.size())),
      couplings(mechanism.couplings),
      applied_forces(list_applied_forces(mechanism)),
      drive_rows(mechanism.drive_rows == DriveRows::kMultipliers),
      minimum_norm_multipliers(mechanism.minimum_norm_multipliers),
      alpha(mechanism.baumgarte_alpha),
      beta(mechanism.baumgarte_beta),
      gravity(array_of(mechanism.gravity_W)) {
  JointFinder finder(mechanism);
  joints = finder.find();
  for (const Drive& drive : mechanism.drives) drives.push_back(drive.coordinate);
  for (const TreeJoint& joint : joints)
    for (int k = 0; k < joint.count() && !joint.driven; ++k) free.push_back(joint.first + k);
  int clearances = 0;
  for (const CutJoint& joint : mechanism.cut_joints) {
    TreeCutJoint cut = make_cut_joint(joint, finder);
    if (joint.clearance) {
      cut.clearance = clearances++;
    } else {
      cut.first_row = rows;
      cut.rows = rows_of(joint.kind);
      rows += cut.rows.count();
    }
    cut_joints.push_back(cut);
  }
  for (const PointSpring& spring : mechanism.springs) springs.push_back(make_spring(spring, finder));
  for (const BodyLoad& load : mechanism.body_loads)
    body_loads.push_back({finder.joint_of(load.frame), make_placement({.p = load.at}), array_of(load.force),
                          array_of(load.moment), load.follows_body});
  for (const AppliedForce& force : applied_forces) force_works += force.work >= 0;
  first_coupling_row = rows;
  rows += static_cast<int>(couplings.size());
  first_drive_row = rows;
  if (drive_rows) rows += static_cast<int>(drives.size());
}

bool TreeModel::is_eliminated(int coordinate) const {
  return !drive_rows && std::find(drives.begin(), drives.end(), coordinate) != drives.end();
}

TreeModel make_given_model(Mechanism mechanism) {
  mechanism.drive_rows = DriveRows::kEliminated;
  mechanism.drives.clear();
  for (FrameIndex i = 0; i < static_cast<FrameIndex>(mechanism.coordinates.size()); ++i)
    mechanism.drives.push_back({.coordinate = i, .law = {}});
  return TreeModel(mechanism);
}

}  // namespace engine
