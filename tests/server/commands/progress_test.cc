// SPDX-License-Identifier: Apache-2.0
#include "server/commands/progress.h"

#include <sstream>
#include <string>

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
  view.show(sweep(2, 2, 0, 0.5, 5000));
  view.show(sweep(0, 4, 0, 1.0, nullptr));
  view.finish();
  const std::string half = "\r[###############...............]  50 %  2 of 4 jobs, about 1 h 23 min left";
  const std::string full = "\r[##############################] 100 %  4 of 4 jobs";
  // The second text covers all of the first.
  EXPECT_EQ(out.str(), half + full + std::string(half.size() - full.size(), ' ') + "\n");
}

TEST(Duration, IsRoundedToWhatMatters) {
  using server::commands::format_duration;
  EXPECT_EQ(format_duration(0.2), "0 s");
  EXPECT_EQ(format_duration(59.4), "59 s");
  EXPECT_EQ(format_duration(59.6), "1 min 00 s");
  EXPECT_EQ(format_duration(3600), "1 h 00 min");
}

}  // namespace
