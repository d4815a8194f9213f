// SPDX-License-Identifier: Apache-2.0
// The extrapolation from two solved instants. The solved motion itself: the validation's chapter on kinematics.

#include "engine/dynamics/loop_closure.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "validation/support/across_rpsup.h"

namespace engine {
namespace {

class LoopClosureExtrapolation : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(closure_.assemble(0.0, first_)); }

  Evaluation solved(double t) {
    Evaluation at = first_;
    EXPECT_TRUE(closure_.solve(t, at));
    return at;
  }

  /// Largest difference of the coordinates that the loops decide, [m] or [rad].
  double largest_difference(const Evaluation& a, const Evaluation& b) const {
    double largest = 0.0;
    for (const FrameIndex i : closure_.unknown_coordinates()) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
    return largest;
  }

  Mechanism mechanism_ = build_ideal_rpsup(validation::across_rpsup()).mechanism;
  LoopClosure closure_{mechanism_};
  Evaluation first_ = MotionSystem(mechanism_).make_evaluation();
};

TEST_F(LoopClosureExtrapolation, IsOfSixthOrderInTheSpacing) {
  for (const double place : {0.3, 2.0}) {  // between the two and beyond them
    double errors[2];
    for (int i = 0; i < 2; ++i) {
      const double apart = i == 0 ? 8e-3 : 4e-3;
      const Evaluation before = solved(0.05);
      const Evaluation nearby = solved(0.05 + apart);
      const double t = 0.05 + place * apart;
      Evaluation at = first_;
      closure_.extrapolate(t, before, nearby, at);
      EXPECT_EQ(at.t, t);
      errors[i] = largest_difference(at, solved(t));
    }
    EXPECT_LT(errors[0], 1e-5) << place;
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 6.0, 0.5) << place << ": " << errors[0] << ", " << errors[1];
  }
}

TEST_F(LoopClosureExtrapolation, MayWriteOverEitherInstant) {
  const Evaluation before = solved(0.05);
  const Evaluation nearby = solved(0.055);
  Evaluation apart = first_;
  closure_.extrapolate(0.06, before, nearby, apart);
  Evaluation over_before = before;
  closure_.extrapolate(0.06, over_before, nearby, over_before);
  Evaluation over_nearby = nearby;
  closure_.extrapolate(0.06, before, over_nearby, over_nearby);
  for (const Evaluation* at : {&over_before, &over_nearby}) {
    EXPECT_EQ(at->t, apart.t);
    EXPECT_EQ(largest_difference(*at, apart), 0.0);
    EXPECT_EQ(at->qd, apart.qd);
    EXPECT_EQ(at->qdd, apart.qdd);
  }
}

TEST_F(LoopClosureExtrapolation, KeepsTheSecondInstantWhereTwoAreOfNoUse) {
  const Evaluation earlier = solved(0.05);
  const Evaluation later = solved(0.055);
  struct {
    const char* what;
    const Evaluation &before, &nearby;
    double t;
  } const cases[] = {{"one instant", later, later, 0.056},
                     {"the first is the later one", later, earlier, 0.056},
                     {"far ahead", earlier, later, 0.076},
                     {"far behind", earlier, later, 0.024}};
  for (const auto& c : cases) {
    Evaluation at = first_;
    closure_.extrapolate(c.t, c.before, c.nearby, at);
    EXPECT_EQ(at.t, c.nearby.t) << c.what;
    EXPECT_EQ(at.q, c.nearby.q) << c.what;
    EXPECT_EQ(at.qd, c.nearby.qd) << c.what;
    EXPECT_EQ(at.qdd, c.nearby.qdd) << c.what;
  }
}

TEST_F(LoopClosureExtrapolation, LeadsToTheSameMotionFromWherever) {
  const Evaluation before = solved(0.05);
  const Evaluation nearby = solved(0.055);
  const double t = 0.0605;
  Evaluation led = first_;
  closure_.extrapolate(t, before, nearby, led);
  ASSERT_TRUE(closure_.solve(t, led));
  const Evaluation alone = solved(t);
  EXPECT_LT((led.q - alone.q).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT((led.qd - alone.qd).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace engine
