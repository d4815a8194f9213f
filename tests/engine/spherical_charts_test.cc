// SPDX-License-Identifier: Apache-2.0
// Angles of three pivots in a row near gimbal lock: charts begin anew where they are a ball joint, and only there.

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

// Three pivots about z, y and x are no ball joint where something holds the first ring.
TEST(GimbalOfRings, KeepsWhatItsRingsCarry) {
  const auto find_end = [](double mass) {
    Linkage linkage;
    linkage.bodies = {make_body("yaw", mass, {0.0, 0.0, 0.0}, mass * Eigen::Vector3d::Ones()),
                      make_body("pitch", mass, {0.0, 0.0, 0.0}, mass * Eigen::Vector3d::Ones()),
                      make_body("head", 1.0, {0.0, 0.0, 0.0}, {0.01, 0.02, 0.03})};
    const auto pivot = [](const char* name, const char* from, const char* to, Axis axis, LinkageFreedom freedom) {
      return LinkageJoint{.name = name, .from = from, .to = to, .placement = {}, .axes = {axis, Axis::kY}, .freedoms = {std::move(freedom)}};
    };
    linkage.joints = {pivot("a", kGroundName, "yaw", Axis::kZ, {.name = "psi", .start = 0.0}),
                      pivot("b", "yaw", "pitch", Axis::kY, {.name = "theta", .start = 1.25}),
                      pivot("c", "pitch", "head", Axis::kX, {.name = "phi", .start = 0.3, .start_rate = 2.0})};
    linkage.loads = {{.name = "push", .body = "yaw", .at = {0.1, 0.0, 0.0}, .force = {0.0, 1.0, 0.0}, .follows_body = true, .law = Constant{1.0}}};
    const LinkageRun run(linkage, accurate(0.2));
    return Eigen::Vector3d(run.last("psi_rad"), run.last("theta_rad"), run.last("phi_rad"));
  };
  EXPECT_LT((find_end(0.0) - find_end(1e-9)).norm(), 1e-5);
}

// Its chart is another one from the start, and a step turns it by five radians.
TEST(GimbalLock, LosesNoTurnsOfAFastSpin) {
  Linkage linkage;
  linkage.bodies = {make_body("top", 1.0, {0.0, 0.0, 0.0}, {2e-3, 1e-3, 1e-3})};
  linkage.joints = {{.name = "ball", .kind = JointKind::kSpherical, .from = kGroundName, .to = "top", .placement = {},
                     .freedoms = {{.name = "psi", .start = 0.0}, {.name = "theta", .start = 1.4},
                                  {.name = "phi", .start = 0.0, .start_rate = 1000.0}}}};
  const LinkageRun run(linkage, {.duration = 0.1, .output_rate = 300.0});
  const std::vector<double>& t = run.column("t_s");
  for (std::size_t k = 0; k < t.size(); ++k) EXPECT_NEAR(run.column("phi_rad")[k], 1000.0 * t[k], 1e-2);
}

}  // namespace
}  // namespace engine
