// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/size_text.h"

#include <gtest/gtest.h>

namespace jobs {
namespace {

TEST(SizeText, HasTwoDigitsOfFewMegabytes) {
  EXPECT_EQ(size_text(0.0), "0 MB");
  EXPECT_EQ(size_text(4096.0), "0.0041 MB");
  EXPECT_EQ(size_text(432'100.0), "0.43 MB");
  EXPECT_EQ(size_text(1e6), "1 MB");
  EXPECT_EQ(size_text(9'940'000.0), "9.9 MB");
}

TEST(SizeText, IsInWholeMegabytesFromTenOn) {
  EXPECT_EQ(size_text(9'960'000.0), "10 MB");
  EXPECT_EQ(size_text(12'600'000.0), "13 MB");
  EXPECT_EQ(size_text(999'999'999e6), "999999999 MB");
}

}  // namespace
}  // namespace jobs
