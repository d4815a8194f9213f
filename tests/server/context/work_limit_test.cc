// SPDX-License-Identifier: Apache-2.0
#include "server/context/work_limit.h"

#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using server::WorkLimit;
using server::WorkPermit;

TEST(WorkLimit, LetsSoManyWaitAtAllLimitsTogether) {
  WorkLimit places(1, 0);
  WorkLimit one(1, 5, {}, &places);
  WorkLimit other(1, 5, {}, &places);
  auto permit = one.acquire();
  const auto other_permit = other.acquire();
  ASSERT_TRUE(permit && other_permit) << "nobody waits";
  std::shared_ptr<const void> waited_for;
  std::jthread waiting([&] {
    while (!(waited_for = one.acquire())) std::this_thread::sleep_for(1ms);  // the loop below had the place
  });
  while (places.acquire()) std::this_thread::sleep_for(20ms);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(other.acquire(), nullptr);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s) << "it has waited";
  permit.reset();
  waiting.join();
  EXPECT_NE(waited_for, nullptr);
  EXPECT_NE(places.acquire(), nullptr) << "nobody waits any more";
}

TEST(WorkPermit, IsGivenBackForATime) {
  WorkLimit limit(1, 0);
  WorkPermit permit(&limit);
  EXPECT_TRUE(permit.acquire());
  EXPECT_TRUE(permit.acquire()) << "it has one";
  EXPECT_EQ(limit.acquire(), nullptr);
  permit.give_back();
  auto of_another = limit.acquire();
  EXPECT_NE(of_another, nullptr);
  EXPECT_FALSE(permit.acquire());
  of_another.reset();
  EXPECT_TRUE(permit.acquire());
  EXPECT_TRUE(WorkPermit(nullptr).acquire());
}

}  // namespace
