// SPDX-License-Identifier: Apache-2.0
// Joints with clearance whose contact at the start, or soon after, is where a body falls or rests by itself.

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "engine/errors.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

constexpr double kFall = 9.81;      // [m/s^2]
constexpr double kLooseMass = 1.0;  // [kg]

/// A body that a joint with clearance carries. @param starts  of slides along x, y and z, [m]
Linkage make_loose_body(JointKind kind, const ClearanceParameters& clearance, const Eigen::Vector3d& gravity,
                        const Eigen::Vector3d& starts) {
  Linkage linkage;
  linkage.gravity_W = gravity;
  linkage.bodies = {make_body("body", kLooseMass, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  linkage.joints = {{.name = "joint", .kind = kind, .from = kGroundName, .to = "body", .placement = {},
                     .freedoms = {{.name = "slide_x", .start = starts.x()}, {.name = "slide_y", .start = starts.y()},
                                  {.name = "slide_z", .start = starts.z()}, {.name = "turn_z"}, {.name = "turn_y"},
                                  {.name = "turn_x"}},
                     .clearance = clearance}};
  return linkage;
}

struct SocketCase {
  const char* name;
  double gravity;  ///< along z, [m/s^2]
  double start;    ///< along z, [m]
  bool friction;
};

class BallAlongTheAxis : public testing::TestWithParam<SocketCase> {};

// It meets the socket at a pole, to the last bit.
TEST_P(BallAlongTheAxis, ComesToRestInItsSocket) {
  const SocketCase& param = GetParam();
  ClearanceParameters socket;
  socket.geometry = ContactGeometry::kBallInSocket;
  socket.c_a = std::numeric_limits<double>::infinity();
  if (param.friction) socket.friction = FrictionParameters{};
  const Linkage linkage =
      make_loose_body(JointKind::kSpherical, socket, {0.0, 0.0, param.gravity}, {0.0, 0.0, param.start});
  const LinkageRun run(linkage, {.duration = 0.5, .output_rate = 1000.0});
  const double below = param.gravity > 0.0 ? 1.0 : -1.0;
  EXPECT_NEAR(run.last("slide_z_m"), below * socket.c_r, 0.05 * socket.c_r);
  EXPECT_NEAR(run.last("slide_x_m"), 0.0, 1e-12);
  EXPECT_NEAR(run.last("joint_contact_force_n"), kLooseMass * kFall, 0.5 * kLooseMass * kFall);
}

INSTANTIATE_TEST_SUITE_P(Cases, BallAlongTheAxis,
                         testing::Values(SocketCase{"falls_from_the_middle", -kFall, 0.0, true},
                                         SocketCase{"falls_without_friction", -kFall, 0.0, false},
                                         SocketCase{"falls_from_above", -kFall, 2e-4, true},
                                         SocketCase{"rests_below", -kFall, -2.5001e-4, true},
                                         SocketCase{"rises_from_the_middle", kFall, 0.0, true}),
                         [](const auto& one) { return std::string(one.param.name); });

// The journal rests on elements far from the first one, and on more of them than the state has bristles at first.
TEST(ContactElements, MayBePressedAtTheStart) {
  ClearanceParameters bore;
  bore.form = RadialForm::kElements;
  bore.friction = FrictionParameters{};
  for (const Eigen::Vector3d& down : {Eigen::Vector3d(0.0, -1.0, 0.0), Eigen::Vector3d(-1.0, 0.0, 0.0),
                                      Eigen::Vector3d(1.0, 0.0, 0.0)}) {
    const Linkage linkage =
        make_loose_body(JointKind::kRevolute, bore, kFall * down, (bore.c_r + 5e-7) * down);
    const LinkageRun run(linkage, {.duration = 0.02, .output_rate = 1000.0});
    const Eigen::Vector3d end(run.last("slide_x_m"), run.last("slide_y_m"), 0.0);
    EXPECT_NEAR(end.dot(down), bore.c_r, 0.2 * bore.c_r);
  }
}

// A depth that is little beside one clearance of a block is much beside a smaller one.
TEST(BlockInSlot, IsRefusedFarInsideAWall) {
  ClearanceParameters slot;
  slot.geometry = ContactGeometry::kBlockInSlot;
  slot.c_a = std::numeric_limits<double>::infinity();
  slot.block_x = 0.01;
  slot.block_y = 0.02;
  slot.c_r = 1e-3;
  slot.c_y = 1e-6;
  const auto block_at = [&](double x, double y) {
    return make_loose_body(JointKind::kPrismatic, slot, Eigen::Vector3d::Zero(), {x, y, 0.0});
  };
  EXPECT_NO_THROW(check_linkage(block_at(9e-4, 1.05e-6)));
  EXPECT_THROW(check_linkage(block_at(0.0, 1e-4)), InvalidInput);
}

}  // namespace
}  // namespace engine
