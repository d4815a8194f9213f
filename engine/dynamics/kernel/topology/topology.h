// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "engine/dynamics/kernel/topology/joint_angles.h"
#include "engine/dynamics/kernel/topology/static_joint.h"
#include "engine/kinematics/joint_traits.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/instruction_set.h"
#include "engine/math/sine_cosine.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A placement of which the zeros are compile-time constants.
template <bool is_shifted>
struct StaticPlacement {
  static constexpr bool rotated = false, shifted = is_shifted, along_x = true;

  [[nodiscard]] static bool fit(const TreePlacement& placement) {
    return !placement.rotated && placement.shifted == shifted && placement.along_x;
  }
  [[nodiscard]] RPSUP_INLINE const TreePlacement& data() const { return placement; }

  const TreePlacement& placement;
};

/// A cut joint of which the two bodies are compile-time constants.
template <int bearing_on, int journal_on, bool clearance>
struct StaticCutJoint {
  static constexpr int bearing_joint = bearing_on, journal_joint = journal_on;
  static constexpr CutRows rows{.positions = 3, .axes = 2};  ///< if it is ideal
  using Bearing = StaticPlacement<true>;
  using Journal = StaticPlacement<false>;

  [[nodiscard]] static bool fit(const TreeCutJoint& joint) {
    return joint.bearing_joint == bearing_joint && joint.journal_joint == journal_joint &&
           joint.has_clearance() == clearance && (clearance || joint.rows == rows) &&
           Bearing::fit(joint.bearing) && Journal::fit(joint.journal);
  }
  [[nodiscard]] static constexpr bool has_clearance() { return clearance; }
  [[nodiscard]] RPSUP_INLINE const TreeCutJoint& data() const { return joint; }

  const TreeCutJoint& joint;
  Bearing bearing{joint.bearing};
  Journal journal{joint.journal};
};

/// The topology of any tree, known at run time: visit(index, joint) base to tip, or tip to base.
struct DynamicTopology {
  static constexpr bool has_point_springs = true;  ///< it may have some
  static constexpr bool has_constraints = true;    ///< it may have some
  static constexpr bool has_applied_forces = true; ///< it may have some
  static constexpr bool is_static = false;         ///< traits and sizes are compile-time constants
  template <typename T>
  using PerJoint = Buffer<T>;
  template <typename T>
  using PerCoordinate = Buffer<T>;
  using SineBuffer = Buffer<double>;
  template <typename T>
  using PerDrive = Buffer<T>;
  template <typename T>
  using PerCutJoint = Buffer<T>;
  template <typename T>
  using PerPointSpring = Buffer<T>;
  template <typename T>
  using PerBodyLoad = Buffer<T>;
  template <typename T>
  using PerRow = Buffer<T>;
  template <typename T>
  using PerSlenderBody = FixedBuffer<T, 0>;  ///< slender bodies move like all others: see SlenderBodyMotion

  using Rolled = DynamicTopology;

  [[nodiscard]] static bool fit(const TreeModel&) { return true; }

  template <typename Visit>
  RPSUP_INLINE static void base_to_tip(const TreeModel& model, const Visit& visit) {
    const std::size_t count = model.joints.size();
    for (std::size_t i = 0; i < count; ++i) visit(i, model.joints[i]);
  }
  template <typename Visit>
  RPSUP_INLINE static void tip_to_base(const TreeModel& model, const Visit& visit) {
    for (std::size_t i = model.joints.size(); i-- > 0;) visit(i, model.joints[i]);
  }
  template <typename Visit>
  RPSUP_INLINE static void for_each_joint(const TreeModel& model, const Visit& visit) {
    base_to_tip(model, visit);
  }
  template <typename Visit>
  RPSUP_INLINE static void for_each_auxiliary(const TreeModel&, const Visit&) {}
  template <typename Visit>
  RPSUP_INLINE static void for_each_cut_joint(const TreeModel& model, const Visit& visit) {
    const std::size_t count = model.cut_joints.size();
    for (std::size_t k = 0; k < count; ++k) visit(k, model.cut_joints[k]);
  }

  /// Visits blocks of coordinates whose sines are computed side by side: visit(index of the first sine,
  /// block). Coordinates of translations are among them: to leave them out costs more.
  template <typename Visit>
  RPSUP_INLINE static void for_each_sine_block(const Buffer<double>& q, const Visit& visit) {
    for (std::size_t i = 0; i < q.size(); i += kSineBlock) visit(i, SineBlock::load(&q[i]));
  }
  /// Index of the first sine of a joint.
  [[nodiscard]] RPSUP_INLINE static std::size_t sine_index(const TreeJoint& joint) {
    return static_cast<std::size_t>(joint.first);
  }
};

/// @returns whether a joint has the traits of a static one. The joint may lack traits whose numbers may be
/// zero.
[[nodiscard]] inline bool fits_traits(JointTraits given, const JointTraits& wanted) {
  given.has_armature |= wanted.has_armature;
  given.sprung |= wanted.sprung;
  return given == wanted;
}

/// A topology of compile-time constants, with one cut joint: its journal is on the last joint's body, its
/// bearing on the third last one's, auxiliary joints not counted. Passes over the joints are unrolled, and
/// their branches vanish. They leave out the auxiliary joints, of which a tree may have fewer.
/// @tparam joints     std::array of JointTraits
/// @tparam clearance  whether the cut joint has clearance
/// @tparam rolled     whether a series of slender bodies is visited in a loop: less code, but nothing of the
/// series stays in registers
template <const auto& joints, bool clearance, bool rolled = false>
struct StaticTopology {
  static constexpr std::size_t most_auxiliaries = count_auxiliaries(joints);
  static constexpr std::size_t n = joints.size() - most_auxiliaries;
  static constexpr bool has_series = find_series(joints).end > 0;
  using Rolled = StaticTopology<joints, clearance, has_series>;
  static_assert(std::ranges::none_of(joints,
                                     [](const JointTraits& s) {
                                       return s.is_slender && (s.rotated || s.driven);
                                     }),
                "calc_slender_frame() leaves out rotated placements and drives");
  static constexpr std::size_t n_q = static_cast<std::size_t>(joints[n - 1].first + joints[n - 1].count());
  static constexpr std::size_t n_drives =
      static_cast<std::size_t>(std::ranges::count_if(joints, &JointTraits::driven));
  static constexpr bool has_point_springs = false;
  static constexpr bool has_constraints = !clearance;
  static constexpr bool has_applied_forces = n_drives < 2;  ///< crank or rod without a drive has an actuator
  static constexpr bool is_static = true;
  template <typename T>
  using PerJoint = FixedBuffer<T, n>;
  template <typename T>
  using PerCoordinate = FixedBuffer<T, n_q + most_auxiliaries>;
  using SineBuffer =
      FixedBuffer<double, 0>;  ///< ForwardDynamics::calc_frames() has sines on the stack instead
  template <typename T>
  using PerDrive = FixedBuffer<T, n_drives>;
  template <typename T>
  using PerCutJoint = FixedBuffer<T, 1>;
  template <typename T>
  using PerPointSpring = FixedBuffer<T, 0>;
  template <typename T>
  using PerBodyLoad = FixedBuffer<T, 0>;
  using CutJoint = StaticCutJoint<static_cast<int>(n) - 3, static_cast<int>(n) - 1, clearance>;
  static constexpr int row_count = clearance ? 0 : CutJoint::rows.count();
  template <typename T>
  using PerRow = FixedBuffer<T, row_count>;
  template <typename T>
  using PerSlenderBody = FixedBuffer<T, n>;  ///< indexed by joint

  [[nodiscard]] static bool fit(const TreeModel& model) {
    if (model.joints.size() < n || model.joints.size() > n + most_auxiliaries ||
        model.drives.size() != n_drives || !model.springs.empty() ||
        !model.couplings.empty() || (!has_applied_forces && !model.applied_forces.empty()) ||
        !model.body_loads.empty())
      return false;
    if (model.minimum_norm_multipliers) return false;  // FullRankDelassus cannot factor dependent rows
    if (model.cut_joints.size() != 1 || !CutJoint::fit(model.cut_joints[0])) return false;
    for (std::size_t i = 0; i < model.joints.size(); ++i)
      if (!fits_traits(model.joints[i], joints[i])) return false;
    return true;
  }

  template <typename Visit>
  RPSUP_INLINE static void base_to_tip(const TreeModel& model, const Visit& visit) {
    base_to_tip<0>(model, visit, std::make_index_sequence<series.first>());
    if constexpr (rolled)
      for (std::size_t i = series.first; i < series.end; ++i)
        visit(i, SlenderJoint{model.joints[i], i - series.first});
    base_to_tip<series.end>(model, visit, std::make_index_sequence<n - series.end>());
  }
  template <typename Visit>
  RPSUP_INLINE static void tip_to_base(const TreeModel& model, const Visit& visit) {
    tip_to_base<n>(model, visit, std::make_index_sequence<n - series.end>());
    if constexpr (rolled)
      for (std::size_t i = series.end; i-- > series.first;)
        visit(i, SlenderJoint{model.joints[i], i - series.first});
    tip_to_base<series.first>(model, visit, std::make_index_sequence<series.first>());
  }
  /// All joints, in any order.
  template <typename Visit>
  RPSUP_INLINE static void for_each_joint(const TreeModel& model, const Visit& visit) {
    base_to_tip(model, visit);
    for_each_auxiliary(model, visit);
  }
  template <typename Visit>
  RPSUP_INLINE static void for_each_auxiliary(const TreeModel& model, const Visit& visit) {
    for_each_auxiliary(model, visit, std::make_index_sequence<most_auxiliaries>());
  }
  template <typename Visit>
  RPSUP_INLINE static void for_each_cut_joint(const TreeModel& model, const Visit& visit) {
    visit(std::integral_constant<std::size_t, 0>(), CutJoint{model.cut_joints[0]});
  }

  static constexpr std::size_t padded_sine_count = in_sine_blocks(joint_angles(joints).count);
  template <typename Visit>
  RPSUP_INLINE static void for_each_sine_block(const PerCoordinate<double>& q, const Visit& visit) {
    for_each_sine_block(q, visit, std::make_index_sequence<padded_sine_count / kSineBlock>());
  }
  template <std::size_t index>
  [[nodiscard]] RPSUP_INLINE static constexpr std::size_t sine_index(const StaticJoint<joints, index>&) {
    return joint_angles(joints).first[index];
  }
  template <std::size_t index>
  [[nodiscard]] RPSUP_INLINE static constexpr std::size_t sine_index(
      const SlenderJointInSeries<joints, index>& joint) {
    return joint_angles(joints).first[index] + joint.from_first;
  }

 private:
  static constexpr JointSeries series = rolled ? find_series(joints) : JointSeries{};
  using SlenderJoint = SlenderJointInSeries<joints, series.first>;

  /// Blocks are made of numbers: a block loaded from memory would wait until the numbers just computed have
  /// got there.
  template <typename Visit, std::size_t... block>
  RPSUP_INLINE static void for_each_sine_block(const PerCoordinate<double>& q, const Visit& visit,
                                               std::index_sequence<block...>) {
    (visit(block * kSineBlock,
           make_sine_block<block * kSineBlock>(q, std::make_index_sequence<kSineBlock>())),
     ...);
  }
  template <std::size_t first, std::size_t... lane>
  [[nodiscard]] RPSUP_INLINE static SineBlock make_sine_block(const PerCoordinate<double>& q,
                                                              std::index_sequence<lane...>) {
    SineBlock block;
    block.part[0] = SineBlock::Part{(first + lane < joint_angles(joints).count
                                         ? q[joint_angles(joints).coordinate[first + lane]]
                                         : 0.0)...};
    return block;
  }
  template <typename Visit, std::size_t... i>
  RPSUP_INLINE static void for_each_auxiliary(const TreeModel& model, const Visit& visit,
                                              std::index_sequence<i...>) {
    (visit_if_present<n + i>(model, visit), ...);
  }
  template <std::size_t i, typename Visit>
  RPSUP_INLINE static void visit_if_present(const TreeModel& model, const Visit& visit) {
    if (i < model.joints.size())
      visit(std::integral_constant<std::size_t, i>(), StaticJoint<joints, i>{model.joints[i]});
  }
  template <std::size_t from, typename Visit, std::size_t... i>
  RPSUP_INLINE static void base_to_tip(const TreeModel& model, const Visit& visit,
                                       std::index_sequence<i...>) {
    const TreeJoint* data = model.joints.data();
    (visit(std::integral_constant<std::size_t, from + i>(), StaticJoint<joints, from + i>{data[from + i]}),
     ...);
  }
  template <std::size_t end, typename Visit, std::size_t... i>
  RPSUP_INLINE static void tip_to_base(const TreeModel& model, const Visit& visit,
                                       std::index_sequence<i...>) {
    const TreeJoint* data = model.joints.data();
    (visit(std::integral_constant<std::size_t, end - 1 - i>(),
           StaticJoint<joints, end - 1 - i>{data[end - 1 - i]}),
     ...);
  }
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
