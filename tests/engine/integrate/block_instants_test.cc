// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "engine/integrate/block_instants.h"

namespace engine {
namespace {

struct BlockCase {
  const char* name;
  double start_ms, step_ms, limit_ms;
  std::vector<double> expected_ms;
};
void PrintTo(const BlockCase& c, std::ostream* out) { *out << c.name; }

class BlockInstantsCase : public testing::TestWithParam<BlockCase> {};

TEST_P(BlockInstantsCase, LieOnTheGridOrLeadToIt) {
  const BlockCase& c = GetParam();
  const BlockInstants times =
      calc_block_instants(c.start_ms / 1e3, c.step_ms / 1e3, c.limit_ms / 1e3, 10.0);
  for (std::size_t k = 0; k <= kBlockSteps; ++k) EXPECT_NEAR(times[k], c.expected_ms[k] / 1e3, 1e-15) << k;
}

INSTANTIATE_TEST_SUITE_P(
    Blocks, BlockInstantsCase,
    testing::Values(BlockCase{"on_the_grid", 6.0, 2.5, 1e4, {6.0, 8.0, 10.0, 12.0, 14.0}},
                    BlockCase{"beside_the_grid", 5.3, 1.2, 1e4, {5.3, 5.475, 5.65, 5.825, 6.0}},
                    BlockCase{"sliver_before_a_corner", 6.0, 1.2, 8.05, {6.0, 6.5125, 7.025, 7.5375, 8.05}},
                    BlockCase{"halved_ticks", 6.0, 1.2, 8.5, {6.0, 6.5, 7.0, 7.5, 8.0}},
                    BlockCase{"corner_within_a_tick", 6.0, 1.2, 6.4, {6.0, 6.1, 6.2, 6.3, 6.4}},
                    BlockCase{"corner_on_the_grid", 6.0, 1.2, 10.0, {6.0, 7.0, 8.0, 9.0, 10.0}}),
    [](const auto& c) { return c.param.name; });

// Samples at 1 kHz are instants of steps to the last bit.
TEST(BlockInstants, AreThoseOfSamplesToTheLastBit) {
  const BlockInstants times = calc_block_instants(0.007, 1.1e-3, 10.0, 10.0);
  for (std::size_t k = 0; k <= kBlockSteps; ++k)
    EXPECT_EQ(times[k], static_cast<double>(7 + k) / 1000.0) << k;
}

// A run ends at its duration, not a rounding beside it.
TEST(BlockInstants, EndAtTheDurationToTheLastBit) {
  const double duration = 0.011 * (1.0 + 4e-13);
  EXPECT_EQ(calc_block_instants(0.007, 1.1e-3, duration, duration)[kBlockSteps], duration);
}

}  // namespace
}  // namespace engine
