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

/// A placement whose zeros are known when the program is compiled.
template <bool is_shifted>
struct KnownPlacement {
  static constexpr bool turned = false, shifted = is_shifted, along_x = true;

  [[nodiscard]] static bool fit(const TreePlacement& placement) { return !placement.turned && placement.shifted == shifted && placement.along_x; }
  [[nodiscard]] RPSUP_INLINE const TreePlacement& numbers() const { return placement; }

  const TreePlacement& placement;
};

/// A cut joint between known bodies.
template <int bearing_on, int journal_on, bool clearance>
struct KnownCutJoint {
  static constexpr int bearing_joint = bearing_on, journal_joint = journal_on;
  static constexpr CutRows rows{.positions = 3, .axes = 2};  ///< if it is ideal
  using Bearing = KnownPlacement<true>;
  using Journal = KnownPlacement<false>;

  [[nodiscard]] static bool fit(const TreeCutJoint& joint) {
    return joint.bearing_joint == bearing_joint && joint.journal_joint == journal_joint && joint.has_clearance() == clearance &&
           (clearance || joint.rows == rows) && Bearing::fit(joint.bearing) && Journal::fit(joint.journal);
  }
  [[nodiscard]] static constexpr bool has_clearance() { return clearance; }
  [[nodiscard]] RPSUP_INLINE const TreeCutJoint& numbers() const { return joint; }

  const TreeCutJoint& joint;
  Bearing bearing{joint.bearing};
  Journal journal{joint.journal};
};

/// The joints of any tree: visit(index, joint) from the root to the tips and back.
struct AnyShapes {
  static constexpr bool have_springs = true;  ///< there may be some between two points
  static constexpr bool have_rows = true;     ///< there may be constraints
  static constexpr bool known = false;        ///< when the program is compiled: evaluations have room on the stack, and count rods from zero
  template <typename T>
  using JointRoom = Buffer<T>;
  template <typename T>
  using CoordinateRoom = Buffer<T>;
  using SineRoom = Buffer<double>;
  template <typename T>
  using DriveRoom = Buffer<T>;
  template <typename T>
  using CutRoom = Buffer<T>;
  template <typename T>
  using SpringRoom = Buffer<T>;
  template <typename T>
  using RowRoom = Buffer<T>;
  template <typename T>
  using RodRoom = FixedBuffer<T, 0>;

  using Looped = AnyShapes;

  [[nodiscard]] static bool fit(const TreeModel&) { return true; }

  template <typename Visit>
  RPSUP_INLINE static void outwards(const TreeModel& model, const Visit& visit) {
    const std::size_t count = model.joints.size();
    for (std::size_t i = 0; i < count; ++i) visit(i, model.joints[i]);
  }
  template <typename Visit>
  RPSUP_INLINE static void inwards(const TreeModel& model, const Visit& visit) {
    for (std::size_t i = model.joints.size(); i-- > 0;) visit(i, model.joints[i]);
  }
  template <typename Visit>
  RPSUP_INLINE static void cut_joints(const TreeModel& model, const Visit& visit) {
    const std::size_t count = model.cut_joints.size();
    for (std::size_t k = 0; k < count; ++k) visit(k, model.cut_joints[k]);
  }

  /// The coordinates whose sines are needed, side by side: visit(place, block). Those of slides among them: asking costs more.
  template <typename Visit>
  RPSUP_INLINE static void each_sine_block(const Buffer<double>& q, const Visit& visit) {
    for (std::size_t i = 0; i < q.size(); i += kSineBlock) visit(i, SineBlock::load(&q[i]));
  }
  /// Where the sines of a joint's coordinates are.
  [[nodiscard]] RPSUP_INLINE static std::size_t sine_place(const TreeJoint& joint) { return static_cast<std::size_t>(joint.first); }
};

/// The joints of a tree known when the program is compiled: the last one's body carries the journal, the third last one's the bearing.
/// @tparam shapes     an array of JointShape
/// @tparam clearance  whether the cut joint has any
/// @tparam looped     whether rods in series are visited in a loop: less code, but nothing of theirs stays in registers
template <const auto& shapes, bool clearance, bool looped = false>
struct KnownShapes {
  static constexpr std::size_t n = shapes.size();
  static constexpr bool have_series = find_series(shapes).end > 0;
  using Looped = KnownShapes<shapes, clearance, have_series>;
  static_assert(std::ranges::none_of(shapes, [](const JointShape& s) { return s.is_rod && (s.turned || s.driven); }), "RodMotion knows no such rods");
  static constexpr std::size_t n_q = static_cast<std::size_t>(shapes[n - 1].first + shapes[n - 1].count());
  static constexpr std::size_t n_drives = 2;
  static constexpr bool have_springs = false;
  static constexpr bool have_rows = !clearance;
  static constexpr bool known = true;
  template <typename T>
  using JointRoom = FixedBuffer<T, n>;
  template <typename T>
  using CoordinateRoom = FixedBuffer<T, n_q>;
  using SineRoom = FixedBuffer<double, 0>;    ///< elsewhere: see EquationsOfMotion
  template <typename T>
  using DriveRoom = FixedBuffer<T, n_drives>;
  template <typename T>
  using CutRoom = FixedBuffer<T, 1>;
  template <typename T>
  using SpringRoom = FixedBuffer<T, 0>;
  using CutJoint = KnownCutJoint<static_cast<int>(n) - 3, static_cast<int>(n) - 1, clearance>;
  static constexpr int row_count = clearance ? 0 : CutJoint::rows.count();
  template <typename T>
  using RowRoom = FixedBuffer<T, row_count>;
  template <typename T>
  using RodRoom = FixedBuffer<T, n>;

  [[nodiscard]] static bool fit(const TreeModel& model) {
    if (model.joints.size() != n || model.drives.size() != n_drives || !model.springs.empty() || !model.couplings.empty()) return false;
    if (model.least_multipliers) return false;  // see IndependentMatrix
    if (model.cut_joints.size() != 1 || !CutJoint::fit(model.cut_joints[0])) return false;
    for (std::size_t i = 0; i < n; ++i)
      if (!(static_cast<const JointShape&>(model.joints[i]) == shapes[i])) return false;
    return true;
  }

  template <typename Visit>
  RPSUP_INLINE static void outwards(const TreeModel& model, const Visit& visit) {
    outwards<0>(model, visit, std::make_index_sequence<series.first>());
    if constexpr (looped)
      for (std::size_t i = series.first; i < series.end; ++i) visit(i, Rod{model.joints[i], i - series.first});
    outwards<series.end>(model, visit, std::make_index_sequence<n - series.end>());
  }
  template <typename Visit>
  RPSUP_INLINE static void inwards(const TreeModel& model, const Visit& visit) {
    inwards<n>(model, visit, std::make_index_sequence<n - series.end>());
    if constexpr (looped)
      for (std::size_t i = series.end; i-- > series.first;) visit(i, Rod{model.joints[i], i - series.first});
    inwards<series.first>(model, visit, std::make_index_sequence<series.first>());
  }
  template <typename Visit>
  RPSUP_INLINE static void cut_joints(const TreeModel& model, const Visit& visit) {
    visit(std::integral_constant<std::size_t, 0>(), CutJoint{model.cut_joints[0]});
  }

  static constexpr std::size_t sine_room = in_sine_blocks(angles_of(shapes).count);
  template <typename Visit>
  RPSUP_INLINE static void each_sine_block(const CoordinateRoom<double>& q, const Visit& visit) {
    each_sine_block(q, visit, std::make_index_sequence<sine_room / kSineBlock>());
  }
  template <std::size_t index>
  [[nodiscard]] RPSUP_INLINE static constexpr std::size_t sine_place(const KnownJoint<shapes, index>&) {
    return angles_of(shapes).place[index];
  }
  template <std::size_t index>
  [[nodiscard]] RPSUP_INLINE static constexpr std::size_t sine_place(const RodInSeries<shapes, index>& joint) {
    return angles_of(shapes).place[index] + joint.from_first;
  }

 private:
  static constexpr Series series = looped ? find_series(shapes) : Series{};
  using Rod = RodInSeries<shapes, series.first>;

  /// Put together from numbers: as the parts of a block in memory they would have to get there first.
  template <typename Visit, std::size_t... block>
  RPSUP_INLINE static void each_sine_block(const CoordinateRoom<double>& q, const Visit& visit, std::index_sequence<block...>) {
    (visit(block * kSineBlock, make_sine_block<block * kSineBlock>(q, std::make_index_sequence<kSineBlock>())), ...);
  }
  template <std::size_t first, std::size_t... lane>
  [[nodiscard]] RPSUP_INLINE static SineBlock make_sine_block(const CoordinateRoom<double>& q, std::index_sequence<lane...>) {
    SineBlock block;
    block.part[0] = SineBlock::Part{(first + lane < angles_of(shapes).count ? q[angles_of(shapes).coordinate[first + lane]] : 0.0)...};
    return block;
  }
  template <std::size_t from, typename Visit, std::size_t... i>
  RPSUP_INLINE static void outwards(const TreeModel& model, const Visit& visit, std::index_sequence<i...>) {
    const TreeJoint* joints = model.joints.data();
    (visit(std::integral_constant<std::size_t, from + i>(), KnownJoint<shapes, from + i>{joints[from + i]}), ...);
  }
  template <std::size_t end, typename Visit, std::size_t... i>
  RPSUP_INLINE static void inwards(const TreeModel& model, const Visit& visit, std::index_sequence<i...>) {
    const TreeJoint* joints = model.joints.data();
    (visit(std::integral_constant<std::size_t, end - 1 - i>(), KnownJoint<shapes, end - 1 - i>{joints[end - 1 - i]}), ...);
  }
};

/// The linkage with prescribed drives: crank, rod, coupler (in n_rfe parts), slider, cross link.
/// @tparam yoke_axis  about which the cross link turns: 0, the guide, or 1, across it
template <std::size_t n_rfe, int yoke_axis>
consteval std::array<JointShape, n_rfe + 4> make_rpsup_shapes() {
  using Kind = JointShape::Kind;
  using Inertia = JointShape::Inertia;
  std::array<JointShape, n_rfe + 4> shapes{};
  shapes[0] = {.kind = Kind::kRotation, .axis = 2, .driven = true, .drive = 0, .shifted_along_x = true,
               .inertia = Inertia::kAxisymmetric, .com_at_origin = false};
  shapes[1] = {.kind = Kind::kTranslation, .axis = 0, .parent = 0, .driven = true, .drive = 1, .shifted_along_x = true,
               .inertia = Inertia::kAxisymmetric, .com_at_origin = false};
  for (std::size_t i = 0; i < n_rfe; ++i)
    shapes[2 + i] = {.kind = Kind::kSpherical, .axis = 2, .parent = static_cast<int>(i) + 1, .shifted = true, .shifted_along_x = true,
                     .sprung = i > 0, .inertia = Inertia::kAxisymmetric, .com_at_origin = false};
  shapes[2 + n_rfe] = {.kind = Kind::kTranslation, .axis = 0, .shifted = true, .inertia = Inertia::kDiagonal};
  shapes[3 + n_rfe] = {.kind = Kind::kRotation, .axis = yoke_axis, .parent = static_cast<int>(n_rfe) + 2, .shifted_along_x = true,
                       .inertia = Inertia::kDiagonal};
  complete_shapes(shapes);
  return shapes;
}

inline constexpr auto kRigidRpsup = make_rpsup_shapes<1, 0>();
inline constexpr auto kFlexibleRpsup = make_rpsup_shapes<4, 0>();
inline constexpr auto kRigidRpsupAcross = make_rpsup_shapes<1, 1>();
inline constexpr auto kFlexibleRpsupAcross = make_rpsup_shapes<4, 1>();

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
