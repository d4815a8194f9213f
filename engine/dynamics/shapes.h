#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "engine/kinematics/joint_shape.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A joint whose shape is known when the program is compiled: what it leaves out costs not even a question.
template <const auto& shapes, std::size_t index>
struct KnownJoint {
  static constexpr JointShape shape = shapes[index];
  static constexpr JointShape::Kind kind = shape.kind;
  static constexpr int first = shape.first;
  static constexpr int axis = shape.axis;
  static constexpr int parent = shape.parent;
  static constexpr bool driven = shape.driven;
  static constexpr bool turned = shape.turned;
  static constexpr bool shifted = shape.shifted;
  static constexpr bool shifted_along_x = shape.shifted_along_x;
  static constexpr bool sprung = shape.sprung;
  static constexpr JointShape::Inertia inertia = shape.inertia;
  static constexpr bool com_at_origin = shape.com_at_origin;
  static constexpr bool com_along_x = shape.com_along_x;
  static constexpr bool parent_turns = shape.parent_turns;
  static constexpr bool turns = shape.turns;
  static constexpr bool moves = shape.moves;
  static constexpr bool parent_moves = shape.parent_moves;
  static constexpr bool parent_answers_turning = shape.parent_answers_turning;
  static constexpr bool answers_turning = shape.answers_turning;
  static constexpr bool carries_moving = shape.carries_moving;
  static constexpr bool last_child = shape.last_child;

  [[nodiscard]] static constexpr int count() { return shape.count(); }
  [[nodiscard]] static constexpr bool rotates() { return shape.rotates(); }
  [[nodiscard]] static constexpr bool is_bare_rod() { return shape.is_bare_rod(); }
  [[nodiscard]] RPSUP_INLINE const TreeJoint& numbers() const { return joint; }

  const TreeJoint& joint;
};

/// The joints of any tree: visit(index, joint) from the root to the tips and back.
struct AnyShapes {
  static constexpr bool have_springs = true;  ///< there may be some between two points
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
};

/// The joints of a tree known when the program is compiled. @tparam shapes  an array of JointShape
template <const auto& shapes>
struct KnownShapes {
  static constexpr std::size_t n = shapes.size();
  static constexpr bool have_springs = false;
  [[nodiscard]] static bool fit(const TreeModel& model) {
    if (model.joints.size() != n || !model.springs.empty()) return false;
    for (std::size_t i = 0; i < n; ++i)
      if (!(static_cast<const JointShape&>(model.joints[i]) == shapes[i])) return false;
    return true;
  }

  template <typename Visit>
  RPSUP_INLINE static void outwards(const TreeModel& model, const Visit& visit) {
    outwards(model, visit, std::make_index_sequence<n>());
  }
  template <typename Visit>
  RPSUP_INLINE static void inwards(const TreeModel& model, const Visit& visit) {
    inwards(model, visit, std::make_index_sequence<n>());
  }

 private:
  template <typename Visit, std::size_t... i>
  RPSUP_INLINE static void outwards(const TreeModel& model, const Visit& visit, std::index_sequence<i...>) {
    const TreeJoint* joints = model.joints.data();
    (visit(std::integral_constant<std::size_t, i>(), KnownJoint<shapes, i>{joints[i]}), ...);
  }
  template <typename Visit, std::size_t... i>
  RPSUP_INLINE static void inwards(const TreeModel& model, const Visit& visit, std::index_sequence<i...>) {
    const TreeJoint* joints = model.joints.data();
    (visit(std::integral_constant<std::size_t, n - 1 - i>(), KnownJoint<shapes, n - 1 - i>{joints[n - 1 - i]}), ...);
  }
};

/// The linkage with prescribed drives: crank, rod, coupler (in n_rfe parts), slider, cross link.
template <std::size_t n_rfe>
consteval std::array<JointShape, n_rfe + 4> make_rpsup_shapes() {
  using Kind = JointShape::Kind;
  using Inertia = JointShape::Inertia;
  std::array<JointShape, n_rfe + 4> shapes{};
  shapes[0] = {.kind = Kind::kRotation, .axis = 2, .driven = true, .shifted_along_x = true, .inertia = Inertia::kAxisymmetric, .com_at_origin = false};
  shapes[1] = {.kind = Kind::kTranslation, .axis = 0, .parent = 0, .driven = true, .shifted_along_x = true, .inertia = Inertia::kAxisymmetric,
               .com_at_origin = false};
  for (std::size_t i = 0; i < n_rfe; ++i)
    shapes[2 + i] = {.kind = Kind::kSpherical, .axis = 2, .parent = static_cast<int>(i) + 1, .shifted = true, .shifted_along_x = true,
                     .sprung = i > 0, .inertia = Inertia::kAxisymmetric, .com_at_origin = false};
  shapes[2 + n_rfe] = {.kind = Kind::kTranslation, .axis = 0, .shifted = true, .inertia = Inertia::kDiagonal};
  shapes[3 + n_rfe] = {.kind = Kind::kRotation, .axis = 1, .parent = static_cast<int>(n_rfe) + 2, .shifted_along_x = true, .inertia = Inertia::kDiagonal};
  complete_shapes(shapes);
  return shapes;
}

inline constexpr auto kRigidRpsup = make_rpsup_shapes<1>();
inline constexpr auto kFlexibleRpsup = make_rpsup_shapes<4>();

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
