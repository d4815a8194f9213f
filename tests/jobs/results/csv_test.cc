// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "jobs/parameters/parameter_table.h"
#include "jobs/results/csv.h"
#include "jobs/results/result_table.h"

namespace jobs_tests {
namespace {

TEST(Csv, WritesNumbersThatReadBackAndEmptyCells) {
  const jobs::ResultTable table{{"job_id", "x", "n"},
                                {{"job_1", 0.1, 3}, {"job_2", 1.0 / 3.0, nullptr}, {"job_3", 1e300, -2}}};
  EXPECT_EQ(jobs::to_csv(table),
            "job_id,x,n\r\njob_1,0.1,3\r\njob_2,0.3333333333333333,\r\njob_3,1e+300,-2\r\n");
}

TEST(Csv, EndsWithTheStatisticsOfReplicates) {
  jobs::ResultTable table{{"job_id"}, {{"job_1"}, {"job_2"}}};
  table.replicates = {{.count = 3, .mean = 2.0, .spread = 0.5, .min = 1.5, .max = 2.5},
                      {.count = 1, .mean = 7.0, .spread = {}, .min = 7.0, .max = 7.0}};
  EXPECT_EQ(jobs::to_csv(table),
            "job_id,replicates_count,replicates_mean,replicates_spread,replicates_min,replicates_max\r\n"
            "job_1,3,2,0.5,1.5,2.5\r\njob_2,1,7,,7,7\r\n");
}

TEST(Csv, QuotesWhatWouldBreakTheTable) {
  const jobs::ResultTable table{{"links.1,3.mass_kg", "b\"c"}, {{"line\nbreak", "plain"}}};
  EXPECT_EQ(jobs::to_csv(table), "\"links.1,3.mass_kg\",\"b\"\"c\"\r\n\"line\nbreak\",plain\r\n");
}

TEST(Csv, DisarmsFormulasInTextButNotNumbers) {
  const jobs::ResultTable table{
      {"a"},
      {{"=1+1"}, {"+1"}, {"-1"}, {"@x"}, {"\tx"}, {"\rx"}, {"=HYPERLINK(\"u\",\"v\")"}, {-1.5}, {"a=b"}}};
  EXPECT_EQ(jobs::to_csv(table),
            "a\r\n'=1+1\r\n'+1\r\n'-1\r\n'@x\r\n'\tx\r\n\"'\rx\"\r\n\"'=HYPERLINK(\"\"u\"\",\"\"v\"\")\"\r\n-"
            "1.5\r\na=b\r\n");
}

TEST(Csv, WritesValuesOfParametersAsTheyAre) {
  std::size_t signed_words = 0;
  for (const jobs::ParameterInfo& info : jobs::parameter_table())
    for (const std::string_view word : info.choices) {
      EXPECT_EQ(jobs::to_csv({{"a"}, {{std::string(word)}}}), "a\r\n" + std::string(word) + "\r\n");
      signed_words += word.starts_with('-') ? 1 : 0;
    }
  EXPECT_GT(signed_words, 0U);
}

TEST(Csv, OfATrajectoryHasALineASample) {
  engine::Trajectory trajectory;
  trajectory.channels = {{.key = "t_s", .help = ""}, {.key = "slider_position_m", .help = ""}};
  trajectory.columns = {{0.0, 0.001}, {0.5, std::nan("")}};
  EXPECT_EQ(jobs::to_csv(trajectory), "t_s,slider_position_m\r\n0,0.5\r\n0.001,\r\n");
}

}  // namespace
}  // namespace jobs_tests
