// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/clearance/clearance_parameters.h"
#include "engine/model/actuator.h"
#include "engine/model/drive_law.h"

namespace engine {

enum class Axis { kX, kY, kZ };
enum class Motion { kRotation, kTranslation };

/// A constant placement of one frame in another: x_A = R_AB x_B + p_AB.
struct Placement {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]
};

/// A rotation with ones on its diagonal is none.
[[nodiscard]] inline bool is_unrotated(const Placement& placement) {
  return placement.R(0, 0) == 1.0 && placement.R(1, 1) == 1.0 && placement.R(2, 2) == 1.0;
}

/// Index of a coordinate, and of the frame it moves; kGround is the fixed frame {0}, called W in names.
using FrameIndex = int;
inline constexpr FrameIndex kGround = -1;

/// The thing that a coordinate is of. Those that are none of a joint belong to a force element.
enum class CoordinateRole {
  kJoint,
  kCharge,    ///< that has passed a winding, [C]; its inertia is the inductance
  /// The rate is a controller's integral, or the deflection of a bristle times its stiffness sigma_0: of the
  /// order of a friction coefficient, so that tolerances resolve it. No energy.
  kMemory,
};

/// One joint coordinate and the frame it moves. Joints of several degrees of freedom are several of them in a
/// row. The frame's mass properties are those of the body fixed to it; a frame inside a joint has none.
struct Coordinate {
  std::string name;                   ///< the paper's symbol in ASCII, e.g. "psi_1_3_0"
  CoordinateRole role = CoordinateRole::kJoint;
  FrameIndex parent = kGround;        ///< smaller than this coordinate's index
  bool continues_joint = false;       ///< a further freedom of a described joint, of which its parent is one
  Placement placement;                ///< of the joint in the parent's frame
  Motion motion = Motion::kRotation;
  Axis axis = Axis::kZ;               ///< in the parent's frame after `placement`, and in its frame
  double stiffness = 0.0;             ///< spring on the coordinate, [N m/rad] or [N/m]
  double damping = 0.0;               ///< damper on the coordinate, [N m s/rad] or [N s/m]
  double armature = 0.0;              ///< of a rotor geared to the coordinate, n^2 J, [kg m^2] or [kg]
  double assembly_guess = 0.0;        ///< start of Newton's method, which closes the loops, [rad] or [m]
  std::optional<double> start =
      {};  ///< value at t = 0, whatever the loops ask of the other coordinates, [rad] or [m]
  std::optional<double> start_rate =
      {};  ///< its rate then; empty: what the loops ask, 0 if they leave it free, [rad/s] or [m/s]
  bool spring_yields =
      false;  ///< closing the loops may load its spring; those inside a flexible link are unloaded then

  double mass = 0.0;                                      ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();          ///< centre of mass in the frame, [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();      ///< about the frame's origin, [kg m^2]
};

/// True for a rotation about the parent frame's own origin, as between the axes of a spherical joint: nothing
/// to shift there.
[[nodiscard]] inline bool is_inside_joint(const Coordinate& c) {
  return c.motion == Motion::kRotation && c.placement.p.isZero(0.0);
}

/// Motion that a cut joint allows its journal in the bearing.
enum class CutKind {
  kRevolute,     ///< turn about z
  kSpherical,    ///< turn about any axis
  kUniversal,    ///< turn about the bearing's z and the journal's x, which stay at right angles
  kCylindrical,  ///< turn about z and slide along it
  kPrismatic,    ///< slide along z
  kWeld,         ///< nothing
};

/// A joint at which a loop is cut: a bearing on one frame, a journal on another. Without clearance it is a
/// constraint row for each freedom that it takes away; one with clearance is only the forces between the two
/// surfaces.
struct CutJoint {
  CutKind kind = CutKind::kRevolute;
  FrameIndex bearing_frame = kGround;
  FrameIndex journal_frame = kGround;
  Placement bearing;                                      ///< {b} in bearing_frame
  Placement journal;                                      ///< {j} in journal_frame
  /// Empty: the ideal joint; of revolute, prismatic, cylindrical and spherical joints only.
  std::optional<ClearanceParameters> clearance;
};

/// A spring with a damper between points of two bodies: at a distance L it pulls them together with k (L -
/// L_0) + d L'. Its drag c acts against their relative velocity v, whichever way that points: -c v on the
/// second one.
struct PointSpring {
  FrameIndex from_frame = kGround;
  FrameIndex to_frame = kGround;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< in from_frame, [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< in to_frame, [m]
  double stiffness = 0.0;                          ///< k, [N/m]
  double damping = 0.0;                            ///< d, [N s/m]
  double drag = 0.0;                               ///< c, [N s/m]
  double free_length = 0.0;                        ///< L_0, [m]
};

/// Two coordinates that move together: q_coordinate = ratio q_follows, a screw or a pair of gears.
struct Coupling {
  FrameIndex coordinate = 0;
  FrameIndex follows = 0;
  double ratio = 1.0;
};

/// A coordinate whose motion is given.
struct Drive {
  FrameIndex coordinate = 0;
  DriveLaw law;
};

/// A coordinate with the cause of a force on it.
struct Actuation {
  FrameIndex coordinate = 0;
  ForceElement element;
  FrameIndex winding = kGround;  ///< coordinate of a motor's charge; kGround: no motor
  FrameIndex memory = kGround;   ///< coordinate of a controller's integral or of a bristle; kGround: none
};

/// A force and a moment on a body at a point, both times a function of time.
struct BodyLoad {
  FrameIndex frame = 0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();      ///< in the frame, [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< by the value of the law, [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< the same, [N m]
  bool follows_body = false;                         ///< force and moment are in the frame, not in W
  Signal law;                                        ///< over time
};

enum class DriveRows {
  kEliminated,  ///< the driven coordinates are substituted: exact
  kMultipliers, ///< constraint rows with Baumgarte's stabilisation, as in the paper
};

/// A link made visible: the pose of one frame.
struct NamedFrame {
  std::string name;  ///< of the link, "1,3" say
  FrameIndex frame = 0;
  Placement placement = {};  ///< in that frame, of a link that is welded to what it carries
};

/// Open chains of bodies and joints, the joints that close them, the drives. Constant once a run has begun.
struct Mechanism {
  std::vector<Coordinate> coordinates;
  std::vector<CutJoint> cut_joints;
  std::vector<Coupling> couplings;
  std::vector<PointSpring> springs;
  /// The constraints depend on each other, here or somewhere on the way: of the multipliers that do, the
  /// least ones are taken.
  bool minimum_norm_multipliers = false;
  std::vector<Drive> drives;
  std::vector<Actuation> actuations;
  std::vector<BodyLoad> body_loads;
  DriveRows drive_rows = DriveRows::kEliminated;
  double baumgarte_alpha = 100.0;                         ///< [1/s]
  double baumgarte_beta = 100.0;                          ///< [1/s]
  Eigen::Vector3d gravity_W = Eigen::Vector3d::Zero();    ///< [m/s^2]
  std::vector<NamedFrame> links;
};

}  // namespace engine
