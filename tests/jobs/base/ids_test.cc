// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <gtest/gtest.h>

#include "jobs/base/ids.h"
#include "jobs/base/time_text.h"

namespace jobs_tests {
namespace {

TEST(IdMaker, MakesIdsThatSortByTimeWhateverTheClockDoes) {
  jobs::IdMaker ids;
  const std::int64_t times[] = {1'700'000'000'000, 1'700'000'000'000, 1'700'000'000'001, 1'699'999'999'000,
                                1'700'000'000'002};
  std::string before;
  for (const std::int64_t time : times) {
    const std::string id = ids.make("job_", time);
    EXPECT_LT(before, id);
    EXPECT_TRUE(jobs::is_id(id, "job_"));
    before = id;
  }
}

TEST(IdMaker, FollowsTheIdsOfAFormerProcess) {
  jobs::IdMaker former;
  const std::string last = former.make("job_", 1'700'000'000'000);
  jobs::IdMaker ids;
  ids.follow(last);
  ids.follow("no id");
  ids.follow("");
  std::string before = last;
  for (const std::int64_t time : {1'600'000'000'000, 1'600'000'000'001, 1'700'000'000'000}) {
    const std::string id = ids.make("job_", time);
    EXPECT_LT(before, id);
    before = id;
  }
  EXPECT_LT(before, ids.make("job_", 1'700'000'000'002));
  EXPECT_TRUE(jobs::is_id(before, "job_"));
}

TEST(IdMaker, MakesNoIdTwice) {
  jobs::IdMaker a;
  jobs::IdMaker b;
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(seen.insert(a.make("job_", 1)).second);
    EXPECT_TRUE(seen.insert(b.make("job_", 1)).second);
  }
}

TEST(IsId, RefusesOtherTexts) {
  jobs::IdMaker ids;
  const std::string id = ids.make("job_", 5);
  EXPECT_FALSE(jobs::is_id(id, "swp_"));
  EXPECT_FALSE(jobs::is_id(id + "0", "job_"));
  EXPECT_FALSE(jobs::is_id(id.substr(0, id.size() - 1), "job_"));
  EXPECT_FALSE(jobs::is_id("job_'; DROP TABLE jobs; --0", "job_"));
}

TEST(TimeText, IsRfc3339InUtc) {
  // date -u -d @1709210096
  EXPECT_EQ(jobs::time_text(1'709'210'096'007), "2024-02-29T12:34:56.007Z");
  EXPECT_EQ(jobs::time_text(0), "1970-01-01T00:00:00.000Z");
}

}  // namespace
}  // namespace jobs_tests
