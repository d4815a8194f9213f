// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/point_contacts_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace engine {
namespace {

ClearanceParameters make_socket() {
  ClearanceParameters joint;
  joint.geometry = ContactGeometry::kBallInSocket;
  joint.friction = FrictionParameters{};
  return joint;
}

/// A ball that is pressed into its socket and rolls along it: nothing slides.
RelativeMotion<double, double> roll(const ClearanceParameters& joint, const Vec3<double>& n) {
  RelativeMotion<double, double> ball;
  ball.R = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  ball.p = (joint.c_r + 1e-6) * n;
  ball.v = cross(n, Vec3<double>{0.02, -0.01, 0.03});
  ball.w = (1.0 / joint.r_j()) * cross(ball.v, n);
  return ball;
}

/// The bristle of a ball in {b}, after so much time.
Vec3<double> find_bristle(const PointContacts& contacts, RelativeMotion<double, double> ball, double time,
                          const std::array<double, 2>& z) {
  ball.p += time * ball.v;
  const SurfacePoint<double> point = locate_ball(contacts, ball);
  return z[0] * point.t + z[1] * point.s;
}

// Where nothing slides a bristle only leans with the surface: its change is along the normal.
TEST(BallInSocket, KeepsItsBristleParallelToItself) {
  const ClearanceParameters joint = make_socket();
  const PointContacts contacts(joint);
  for (const Vec3<double>& n : {Vec3<double>{0.6, 0.0, 0.8}, Vec3<double>{-0.48, 0.64, 0.6}, Vec3<double>{0.8, 0.6, 0.0}}) {
    const RelativeMotion<double, double> ball = roll(joint, n);
    const std::array<double, 2> z{2e-4, -1e-4};
    std::array<double, 2> rates{};
    JointLoad<double> load;
    add_point_contacts(contacts, ball, z.data(), rates.data(), load);
    ASSERT_GT(load.radial_normal_sum, 0.0);
    const SurfacePoint<double> point = locate_ball(contacts, ball);
    constexpr double kStep = 1e-6;  // [s]
    const Vec3<double> turned = (0.5 / kStep) * (find_bristle(contacts, ball, kStep, z) - find_bristle(contacts, ball, -kStep, z));
    const Vec3<double> change = turned + rates[0] * point.t + rates[1] * point.s;
    const double scale = std::sqrt(dot(turned, turned));
    ASSERT_GT(scale, 0.0);
    EXPECT_NEAR(dot(change, point.t), 0.0, 1e-6 * scale);
    EXPECT_NEAR(dot(change, point.s), 0.0, 1e-6 * scale);
    EXPECT_GT(std::abs(rates[0]) + std::abs(rates[1]), 0.01 * scale) << "the tangents turn about the normal";
  }
}

// A ball that falls along the axis comes there before its pole follows.
TEST(BallInSocket, IsEvaluatedAtTheOtherPoleToo) {
  const ClearanceParameters joint = make_socket();
  for (const double across : {0.0, 1e-12, 1e-9, 1e-8}) {
    PointContacts contacts(joint);
    const RelativeMotion<double, double> ball = roll(joint, {across, 0.0, -1.0});
    std::array<double, 2> z{}, rates{};
    JointLoad<double> load;
    add_point_contacts(contacts, ball, z.data(), rates.data(), load);
    EXPECT_GT(load.radial_normal_sum, 0.0);
    EXPECT_TRUE(std::isfinite(rates[0]) && std::isfinite(rates[1])) << across;
    JournalMotion journal;
    journal.p_bj = {ball.p.x, ball.p.y, ball.p.z};
    EXPECT_TRUE(contacts.follow(journal, z.data()));
    EXPECT_EQ(z, (std::array<double, 2>{})) << across;
    EXPECT_EQ(contacts.pole(), -1.0);
  }
}

TEST(BlockInSlot, HasAClearanceOfItsOwnAlongItsHeight) {
  ClearanceParameters joint;
  joint.geometry = ContactGeometry::kBlockInSlot;
  joint.block_x = 0.01;
  joint.block_y = 0.02;
  joint.c_r = 1e-3;
  joint.c_y = 3e-3;
  const auto touching = [&](double x, double y) {
    JournalMotion journal;
    journal.p_bj = {x, y, 0.0};
    std::vector<Penetration> contacts;
    PointContacts(joint).add_penetrations(journal, contacts);
    return std::ranges::count_if(contacts, [](const Penetration& contact) { return contact.delta > 0.0; });
  };
  EXPECT_EQ(touching(0.0, 2.9e-3), 0);
  EXPECT_EQ(touching(0.0, 3.1e-3), 4);
  EXPECT_EQ(touching(0.9e-3, 0.0), 0);
  EXPECT_EQ(touching(-1.1e-3, 0.0), 4);
}

}  // namespace
}  // namespace engine
