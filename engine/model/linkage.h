// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/clearance/clearance_parameters.h"
#include "engine/flexible/rfem.h"
#include "engine/model/drive_law.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Kind of a joint of a linkage: the freedoms of the body that it carries. Several freedoms come in the order
/// in which they stand here.
enum class JointKind {
  kRevolute,     ///< turn about the axis
  kPrismatic,    ///< slide along the axis
  kCylindrical,  ///< slide along the axis, turn about it
  kScrew,        ///< slide along the axis as far as the lead asks, turn about it
  kUniversal,    ///< turn about the first axis, then about the second
  kSpherical,    ///< turn about z, y, x
  kPlanar,       ///< slide along x and y, turn about z
  kFree,         ///< slide along x, y and z, turn about z, y, x
  kWeld,         ///< nothing
};

/// One freedom of a joint.
struct LinkageFreedom {
  std::string name;                     ///< of the coordinate
  double guess = 0.0;                   ///< see Coordinate, as the next three, [rad] or [m]
  std::optional<double> start = {};
  std::optional<double> start_rate = {};
  double stiffness = 0.0;
  double damping = 0.0;
  std::optional<DriveLaw> drive = {};   ///< its motion is given; empty: free, or moved by the actuator
  std::optional<Actuator> actuator = {};  ///< none of a driven freedom
  std::optional<ForceLaw> load = {};      ///< acts beside drive or actuator
  std::optional<JointFriction> friction = {};
};

/// A body. Unless the joint that carries it says otherwise, its frame is the joint's.
struct LinkageBody {
  std::string name;
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the frame's origin, [kg m^2]
  /// Given: the body is this straight beam from its frame's origin along x, divided into rigid elements; its
  /// mass properties are the beam's.
  std::optional<UniformBeam> beam = {};
  int elements = 0;                                   ///< n_rfe of the beam
};

/// A joint between two bodies. One that closes a loop is cut; the others carry their second body.
struct LinkageJoint {
  std::string name;
  JointKind kind = JointKind::kRevolute;
  std::string from, to;                 ///< names of bodies; from may be kGroundName
  Placement placement;                  ///< in the first body's frame
  std::array<Axis, 2> axes{Axis::kZ, Axis::kY};  ///< the axis, and the second one of a universal joint
  double lead = 0.0;                    ///< of a screw, per radian, [m/rad]
  std::vector<LinkageFreedom> freedoms = {};  ///< one for each of freedoms_of(); none of a cut joint
  bool cut = false;
  Placement to_placement = {};          ///< in the second body's frame
  /// Play of a revolute, prismatic, cylindrical or spherical joint. One that is not cut carries its second
  /// body with all freedoms, and its surfaces keep the body in place.
  std::optional<ClearanceParameters> clearance = {};
};

/// A spring with a damper between points of two bodies: see PointSpring.
struct LinkageSpring {
  std::string name;
  std::string from, to;                 ///< names of bodies; one of them may be kGroundName
  Eigen::Vector3d at = Eigen::Vector3d::Zero();     ///< in the first body's frame, [m]
  Eigen::Vector3d to_at = Eigen::Vector3d::Zero();  ///< in the second body's, [m]
  double stiffness = 0.0;               ///< [N/m]
  double damping = 0.0;                 ///< along the spring, [N s/m]
  double drag = 0.0;                    ///< in any direction, [N s/m]
  std::optional<double> free_length =
      {};  ///< [m]; empty: the distance of the ends in the assembled position, see check_linkage()
};

/// A force or a moment on a body: see BodyLoad.
struct LinkageLoad {
  std::string name;
  std::string body;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();      ///< in the body's frame, [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< by the value of the law, [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< the same, [N m]
  bool follows_body = false;
  Signal law;
};

/// An accelerometer on a body: the acceleration of a point, less that of gravity, along a direction.
struct LinkageAccelerometer {
  std::string name;
  std::string body;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();           ///< in the body's frame, [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();   ///< of unit length
  bool follows_body = true;     ///< whether the direction is one of the body's frame; else of the ground's
  bool shows_gravity = true;    ///< false: the acceleration of the point itself
};

inline constexpr const char* kGroundName = "ground";

/// A linkage as data: any number of bodies in chains or trees from the ground, closed by any number of cut
/// joints.
struct Linkage {
  std::vector<LinkageBody> bodies;
  std::vector<LinkageJoint>
      joints;  ///< in the order in which bodies are placed, each behind the one that carries its first body
  std::vector<LinkageSpring> springs = {};
  std::vector<LinkageLoad> loads = {};
  std::vector<LinkageAccelerometer> accelerometers = {};
  /// Acceleration of the ground along x, y and z, [m/s^2]. Its frame moves with it: each body gets the
  /// inertial force -m a.
  std::array<std::optional<Signal>, 3> ground_acceleration = {};
  Eigen::Vector3d gravity_W = Eigen::Vector3d::Zero();
  DriveRows drive_rows = DriveRows::kEliminated;
  double baumgarte_alpha = 100.0;       ///< [1/s]
  double baumgarte_beta = 100.0;        ///< [1/s]
};

/// Cyclic permutation of the axes that brings one where another one is.
[[nodiscard]] Eigen::Matrix3d rotation_between(Axis from, Axis to);

/// Motion that a joint that is not cut lets its second body have. A screw has two, which its lead couples. A
/// joint with clearance has all: slides along x, y and z, then turns, about the joint's own axis first.
struct FreedomKind {
  Motion motion;
  Axis axis;
};
[[nodiscard]] std::vector<FreedomKind> freedoms_of(const LinkageJoint& joint);

/// Frames of a body: its own, or those of a divided body's elements, the first at the body's origin.
struct BodyFrames {
  struct Part {
    FrameIndex frame = kGround;
    Placement placement;  ///< of the part's frame in `frame`: not the identity for a welded body
    double begin = 0.0;   ///< along the beam, [m]
  };
  std::vector<Part> parts;
};

/// A joint as built: its coordinates, or which of the mechanism's cut joints it is; with clearance it may
/// have both.
struct BuiltJoint {
  FrameIndex first = kGround;           ///< coordinate; kGround: it has none
  int count = 0;
  int cut = -1;
};

/// Place and direction of an accelerometer.
struct BuiltAccelerometer {
  FrameIndex frame = kGround;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();         ///< in `frame`, [m]
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< in `frame`; in W if it does not follow the body
};

struct BuiltLinkage {
  Mechanism mechanism;                  ///< its springs in the order of Linkage::springs
  std::vector<BodyFrames> bodies;       ///< in the order of Linkage::bodies
  std::vector<BuiltJoint> joints;       ///< in the order of Linkage::joints
  std::vector<BuiltAccelerometer> accelerometers = {};  ///< in the order of Linkage::accelerometers
};

/// Builds the mechanism. Bodies and joints must fit together: every body but the ground is the second one of
/// exactly one joint that is not cut, which stands behind the joint that carries its first body.
[[nodiscard]] BuiltLinkage build_linkage(const Linkage& linkage);

}  // namespace engine
