// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "engine/kinematics/joint_traits.h"
#include "engine/model/applied_force.h"
#include "engine/model/mechanism.h"

namespace engine {

/// A frame fixed to another one, with what is zero marked.
struct TreePlacement {
  bool rotated = false;                ///< R is no identity
  bool shifted = false;               ///< p is not zero
  bool along_x = false;               ///< p = (x, 0, 0)
  std::array<double, 9> R{};          ///< column after column
  std::array<double, 3> p{};          ///< [m]

  [[nodiscard]] const TreePlacement& data() const { return *this; }
};

/// A joint and the body that it carries, with their numbers.
struct TreeJoint : JointTraits {
  TreePlacement placement;            ///< in the parent's frame
  std::array<double, 3> stiffness{},
      damping{};                      ///< of its coordinates, [N/m] or [N m/rad], and the same times [s]
  double armature = 0.0;              ///< of a single coordinate: see Coordinate
  double mass = 0.0;                  ///< [kg]
  std::array<double, 3> mc{};         ///< mass times centre of mass, [kg m]
  std::array<double, 9> I{};          ///< about the frame's origin, [kg m^2]

  [[nodiscard]] const TreeJoint& data() const { return *this; }
};

/// The rows of an ideal cut joint: that the journal's centre stays at the bearing's, in W or, where it may
/// slide, across the bearing's z; then that pairs of axes of bearing and journal stay at right angles, the
/// first so many of (z, x), (z, y), (x, y).
struct CutRows {
  int positions = 3;  ///< 3, or 2: along the bearing's x and y
  int axes = 2;

  [[nodiscard]] constexpr int count() const { return positions + axes; }

  bool operator==(const CutRows&) const = default;
};

[[nodiscard]] CutRows rows_of(CutKind kind);

/// A joint at which a loop is cut. Its bearing and journal sit on the bodies of two joints of the tree, -1:
/// on the ground.
struct TreeCutJoint {
  int bearing_joint = -1, journal_joint = -1;
  TreePlacement bearing, journal;
  int clearance = -1;                 ///< index among the joints with clearance; -1: ideal
  int first_row = -1;                 ///< of its constraint rows; -1: it has clearance
  CutRows rows;

  [[nodiscard]] bool has_clearance() const { return clearance >= 0; }
  [[nodiscard]] const TreeCutJoint& data() const { return *this; }
};

/// A spring between points on the bodies of two joints, -1: on the ground.
struct TreeSpring {
  int from_joint = -1, to_joint = -1;
  TreePlacement from, to;
  double stiffness = 0.0;            ///< [N/m]
  double damping = 0.0, drag = 0.0;  ///< [N s/m]
  double free_length = 0.0;          ///< [m]
};

/// A load on the body of a joint, -1: on the ground.
struct TreeBodyLoad {
  int joint = -1;
  TreePlacement at;
  std::array<double, 3> force{}, moment{};  ///< by the value of the law, [N], [N m]
  bool follows_body = false;                ///< see BodyLoad
};

/// A mechanism made ready for evaluation.
struct TreeModel {
  explicit TreeModel(const Mechanism& mechanism);

  [[nodiscard]] bool is_eliminated(int coordinate) const;

  int coordinates = 0;
  std::vector<TreeJoint> joints;      ///< each behind the one that carries it
  std::vector<TreeCutJoint> cut_joints;
  std::vector<Coupling> couplings;
  std::vector<TreeSpring> springs;
  std::vector<AppliedForce> applied_forces;
  std::vector<TreeBodyLoad> body_loads;
  int force_works = 0;                ///< applied forces that have a work
  std::vector<int> free;              ///< free coordinates
  std::vector<int> drives;            ///< coordinate of each drive
  bool drive_rows = false;            ///< drives are constraint rows
  bool minimum_norm_multipliers = false;     ///< see Mechanism
  int rows = 0;                       ///< constraint rows
  int first_coupling_row = 0;
  int first_drive_row = 0;
  double alpha = 0.0, beta = 0.0;     ///< Baumgarte's, [1/s]
  std::array<double, 3> gravity{};    ///< [m/s^2]
};

/// The mechanism with the motion of every coordinate given: each is a joint by itself, with the same index.
[[nodiscard]] TreeModel make_given_model(Mechanism mechanism);

}  // namespace engine
