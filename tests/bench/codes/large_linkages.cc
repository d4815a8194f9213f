// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/large_linkages.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace bench {

namespace {

using engine::Axis;
using engine::JointKind;
using engine::LinkageBody;
using engine::LinkageFreedom;
using engine::LinkageJoint;

const Eigen::Vector3d kGravity{5.0, 3.0, -8.0};  // [m/s^2]

/// A rod of so many kilograms that leads from its origin to the tip, with principal axes along the frame's.
LinkageBody make_rod(std::string name, double mass, const Eigen::Vector3d& axis, double length) {
  constexpr double kRadius = 0.01;  // [m]
  const double across = mass * length * length / 3.0, along = 0.5 * mass * kRadius * kRadius;
  const Eigen::Vector3d moments = across * Eigen::Vector3d::Ones() + (along - across) * axis.cwiseAbs();
  return {.name = std::move(name), .mass = mass, .com = 0.5 * length * axis, .inertia = moments.asDiagonal()};
}

LinkageJoint make_joint(JointKind kind, std::string from, std::string to, const Eigen::Vector3d& at,
                        std::array<Axis, 2> axes, double damping) {
  LinkageJoint joint{
      .name = to, .kind = kind, .from = std::move(from), .to = to, .placement = {.p = at}, .axes = axes};
  joint.freedoms.push_back({.name = to + "_angle", .damping = damping});
  if (kind == JointKind::kUniversal)
    joint.freedoms.push_back({.name = to + "_second_angle", .damping = damping});
  return joint;
}

}  // namespace

LargeLinkage make_tree(int bodies) {
  constexpr double kLength = 0.15, kAside = 0.05;  // [m]
  constexpr double kMass = 0.2, kDamping = 0.02;   // [kg], [N m s/rad]
  LargeLinkage made;
  const auto name = [](int i) { return "rod_" + std::to_string(i); };
  std::vector<int> depth(static_cast<std::size_t>(bodies));
  for (int i = 0; i < bodies; ++i) {
    const int parent = (i - 1) / 2;
    const auto k = static_cast<std::size_t>(i);
    depth[k] = i == 0 ? 0 : depth[static_cast<std::size_t>(parent)] + 1;
    const Eigen::Vector3d at(i % 2 == 0 ? kAside : -kAside, 0.0, -kLength);
    made.linkage.bodies.push_back(make_rod(name(i), kMass, -Eigen::Vector3d::UnitZ(), kLength));
    made.linkage.joints.push_back(make_joint(JointKind::kRevolute,
                                             i == 0 ? engine::kGroundName : name(parent), name(i),
                                             i == 0 ? Eigen::Vector3d::Zero().eval() : at,
                                             {depth[k] % 2 == 0 ? Axis::kY : Axis::kX, Axis::kY}, kDamping));
  }
  made.linkage.gravity_W = kGravity;
  made.measured = name(bodies - 1) + "_angle";
  return made;
}

LargeLinkage make_chain(int loops) {
  constexpr double kApart = 0.25, kAside = 0.05;  // [m]
  constexpr double kMass = 0.5;                   // [kg]
  LargeLinkage made;
  // Unequal bars, neighbours aside of each other: no loop is a planar parallelogram.
  const auto pivot = [](int i) { return Eigen::Vector3d(kApart * i, i % 2 == 0 ? 0.0 : kAside, 0.0); };
  const auto tip = [](int i) { return Eigen::Vector3d(0.0, 0.0, -0.3 - 0.01 * (i % 3)); };
  const auto bar = [](int i) { return "bar_" + std::to_string(i); };
  for (int i = 0; i <= loops; ++i) {
    made.linkage.bodies.push_back(make_rod(bar(i), kMass, -Eigen::Vector3d::UnitZ(), tip(i).norm()));
    made.linkage.joints.push_back(
        make_joint(JointKind::kRevolute, engine::kGroundName, bar(i), pivot(i), {Axis::kY, Axis::kZ}, 0.0));
  }
  for (int i = 0; i < loops; ++i) {
    const std::string coupler = "coupler_" + std::to_string(i);
    made.linkage.bodies.push_back(make_rod(coupler, kMass, Eigen::Vector3d::UnitX(), kApart));
    made.linkage.joints.push_back(
        make_joint(JointKind::kUniversal, bar(i), coupler, tip(i), {Axis::kY, Axis::kZ}, 0.0));
  }
  for (int i = 0; i < loops; ++i)
    made.linkage.joints.push_back({.name = "ball_" + std::to_string(i),
                                   .kind = JointKind::kSpherical,
                                   .from = "coupler_" + std::to_string(i),
                                   .to = bar(i + 1),
                                   .placement = {.p = pivot(i + 1) + tip(i + 1) - pivot(i) - tip(i)},
                                   .cut = true,
                                   .to_placement = {.p = tip(i + 1)}});
  made.linkage.gravity_W = kGravity;
  made.measured = bar(0) + "_angle";
  return made;
}

}  // namespace bench
