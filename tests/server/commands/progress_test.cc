// SPDX-License-Identifier: Apache-2.0
#include "server/commands/progress.h"

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using nlohmann::json;
using server::commands::ProgressView;

json sweep(int queued, int succeeded, int failed, double progress, json eta) {
  return {{"counts",
           {{"queued", queued},
            {"running", 0},
            {"succeeded", succeeded},
            {"failed", failed},
            {"cancelled", 0},
            {"total", queued + succeeded + failed}}},
          {"progress", progress},
          {"eta_s", std::move(eta)}};
}

TEST(ProgressLines, SayOnlyWhatIsNew) {
  std::ostringstream out;
  ProgressView view(out, ProgressView::Form::kLines);
  view.show(sweep(4, 0, 0, 0.0, nullptr));
  view.show(sweep(4, 0, 0, 0.1, 100));
  view.show(sweep(2, 1, 1, 0.5, 61.4));
  view.show(sweep(0, 3, 1, 1.0, 0));
  view.finish();
  EXPECT_EQ(out.str(),
            "0 of 4 jobs\n"
            "2 of 4 jobs, 1 failed, about 1 min 01 s left\n"
            "4 of 4 jobs, 1 failed\n");
}

TEST(ProgressBar, IsDrawnOverItself) {
  std::ostringstream out;
  ProgressView view(out, ProgressView::Form::kBar);
  view.show(sweep(2, 2, 0, 0.5, 5000), {}, {});
  view.show(sweep(2, 2, 0, 0.5, 5000), {}, {});
  view.show(sweep(0, 4, 0, 1.0, nullptr), {}, {});
  view.finish();
  EXPECT_EQ(out.str(),
            "\r[###############...............]  50 %  2 of 4 jobs, about 1 h 23 min left\x1b[K\x1b[J"
            "\r[##############################] 100 %  4 of 4 jobs\x1b[K\x1b[J\n");
}

TEST(ProgressBar, IsFullOnlyIfEveryJobHasSucceeded) {
  for (const auto& [failed, cancelled] : {std::pair(1, 0), std::pair(0, 1)}) {
    json ended = sweep(0, 999, failed, 1.0, nullptr);
    ended["counts"]["cancelled"] = cancelled;
    ended["counts"]["total"] = 1000;
    std::ostringstream out;
    ProgressView(out, ProgressView::Form::kBar).show(ended, {}, {});
    EXPECT_NE(out.str().find("#.]  99 %  1000 of 1000 jobs, 1 " + std::string(failed > 0 ? "failed" : "cancelled")),
              std::string::npos)
        << out.str();
  }
}

TEST(ProgressBar, HasRunningJobsBelowAsFarAsThereIsRoom) {
  std::ostringstream out;
  ProgressView view(out, ProgressView::Form::kBar);
  const std::vector<std::string> running{"job_1  clearance_mm 0.25", "job_2", "job_3"};
  view.show(sweep(3, 1, 0, 0.25, nullptr), running, {.columns = 20, .rows = 4});
  EXPECT_EQ(out.str(), "\r[#######...........\x1b[K\n  job_1  clearan...\x1b[K\n  job_2\x1b[K\x1b[J");
  out.str("");
  view.finish();
  EXPECT_EQ(out.str(), "\r\x1b[2A[#######...........\x1b[K\x1b[J\n");
}

TEST(Terminal, CutsNoCharacter) {
  using server::commands::clipped;
  EXPECT_EQ(clipped("abcdef", 6), "abcdef");
  EXPECT_EQ(clipped("abcdefg", 6), "abc...");
  EXPECT_EQ(clipped("ab\u00e9cdefg", 6), "ab...");  // its second byte would be the fourth
  EXPECT_EQ(clipped("abc", 2), "..");
}

TEST(Duration, IsRoundedToWhatMatters) {
  using server::commands::format_duration;
  EXPECT_EQ(format_duration(0.2), "0 s");
  EXPECT_EQ(format_duration(59.4), "59 s");
  EXPECT_EQ(format_duration(59.6), "1 min 00 s");
  EXPECT_EQ(format_duration(3600), "1 h 00 min");
}

}  // namespace
