// SPDX-License-Identifier: Apache-2.0
// Foundations of the study's chapters: parts computed on threads, look-up by case, requests that the service
// takes.

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "validation/studies/compute.h"
#include "validation/studies/study.h"

namespace validation::studies {
namespace {

Findings found(const char* what) { return {.checks = {validation::limit(what, "", 0.0, 0.0, "1", "")}}; }
Findings find_a() { return found("a"); }
Findings find_b() { return found("b"); }
Findings find_c() { return found("c"); }
Findings fail() { throw std::runtime_error("a part's own words"); }

const PartDone kIgnore = [](const Part&, const Findings&) {};

std::vector<Chapter> three_parts() {
  return {{.title = "one", .text = "", .parts = {{"a", find_a}, {"b", find_b, Cost::kHeavy}}},
          {.title = "two", .text = "", .parts = {{"c", find_c}}}};
}

TEST(ComputeChapters, KeepsTheOrderWhateverTheThreadsDo) {
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> done = 0;
    const auto computed =
        compute_chapters(three_parts(), Cost::kHeavy, 4, [&done](const Part&, const Findings&) { ++done; });
    ASSERT_EQ(computed.size(), 2u);
    EXPECT_EQ(computed[0].findings.at(0).checks.at(0).what, "a");
    EXPECT_EQ(computed[0].findings.at(1).checks.at(0).what, "b");
    EXPECT_EQ(computed[1].findings.at(0).checks.at(0).what, "c");
    EXPECT_EQ(done, 3);
  }
}

TEST(ComputeChapters, LeavesHeavyPartsOut) {
  EXPECT_EQ(count_parts(three_parts(), Cost::kLight), 2u);
  EXPECT_EQ(count_parts(three_parts(), Cost::kHeavy), 3u);
  const auto computed = compute_chapters(three_parts(), Cost::kLight, 2, kIgnore);
  EXPECT_TRUE(computed.at(0).findings.at(1).checks.empty());
  EXPECT_FALSE(computed.at(0).findings.at(0).checks.empty());
}

TEST(ComputeChapters, ThrowsWhatAPartHasThrown) {
  std::vector<Chapter> chapters = three_parts();
  chapters[0].parts.push_back({"fails", fail});
  try {
    (void)compute_chapters(chapters, Cost::kHeavy, 2, kIgnore);
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "a part's own words");
  }
}

StudyTable three_rows() {
  return StudyTable({.columns = {"job_id", "clearance_mm", "crank_velocity_rad_s", "coupler", "peak"},
                     .rows = {{"j1", 0.25, 5.0, "rigid", 7.5},
                              {"j2", 0.25, 5.0, "rigid", nullptr},
                              {"j3", 0.5, 5.0, "rigid", 9.0}}});
}

TEST(StudyTable, FindsTheRowsOfACase) {
  const StudyTable table = three_rows();
  EXPECT_EQ(table.find({0.25, 5.0, "rigid"}), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(table.find({0.5, 5.0, "rigid"}, "peak", 9.0), (std::vector<std::size_t>{2}));
  EXPECT_EQ(table.text(2, "job_id"), "j3");
  EXPECT_EQ(table.number(2, "peak"), 9.0);
}

TEST(StudyTable, SaysWhatItDoesNotHave) {
  const StudyTable table = three_rows();
  EXPECT_THROW((void)table.find({0.25, 10.0, "rigid"}), std::out_of_range);
  EXPECT_THROW((void)table.number(0, "no_such_column"), std::out_of_range);
  EXPECT_THROW((void)table.number(1, "peak"), std::out_of_range);
}

TEST(StudyRequests, AreSweepsThatTheServiceTakes) {
  std::size_t jobs = 0;
  const auto requests = study_requests();
  for (const auto& request : requests) jobs += plan_sweep(request, 1000).jobs.size();
  EXPECT_EQ(requests.size(), 3);
  // the ideal joint; with clearance 16 of 5 replicates; 12 that converge of as many
  EXPECT_EQ(jobs, 8 + 80 + 60);
}

}  // namespace
}  // namespace validation::studies
