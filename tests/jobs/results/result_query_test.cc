// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/result_query.h"

#include <gtest/gtest.h>

#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using Strings = std::vector<std::string>;
using nlohmann::json;

jobs::ResultTable table() {
  return {.columns = {"job_id", "state", "coupler", "links.1,3.mass_kg", "peak"},
          .rows = {{"a", "succeeded", "rigid", 0.3, 7.0},
                   {"b", "succeeded", "flexible", 0.4, 9.0},
                   {"c", "failed", "flexible", 0.3, nullptr},
                   {"d", "succeeded", "rigid", 0.5, 8.0}}};
}

jobs::ResultTable applied(const jobs::ResultQuery& query) {
  auto result = table();
  jobs::apply(query, result, jobs::kSweepColumns);
  return result;
}

Strings ids(const jobs::ResultTable& result) {
  Strings found;
  for (const auto& row : result.rows) found.push_back(row.front().get<std::string>());
  return found;
}

struct FilterCase {
  const char* name;
  std::vector<jobs::ResultFilter> filters;
  Strings ids;
};
void PrintTo(const FilterCase& c, std::ostream* out) { *out << c.name; }

class Filter : public testing::TestWithParam<FilterCase> {};

TEST_P(Filter, KeepsTheRowsThatPass) {
  EXPECT_EQ(ids(applied({.fields = {}, .filters = GetParam().filters, .order_by = {}, .limit = {}})),
            GetParam().ids);
}

INSTANTIATE_TEST_SUITE_P(All, Filter,
                         testing::Values(FilterCase{"None", {}, {"a", "b", "c", "d"}},
                                         FilterCase{"Greater", {{"peak_gt", "8"}}, {"b"}},
                                         FilterCase{"GreaterOrEqual", {{"peak_ge", "8"}}, {"b", "d"}},
                                         FilterCase{"Less", {{"peak_lt", "8"}}, {"a"}},
                                         FilterCase{"LessOrEqual", {{"peak_le", "8.0"}}, {"a", "d"}},
                                         FilterCase{"Equal", {{"peak", "9"}}, {"b"}},
                                         FilterCase{"Word", {{"coupler", "flexible"}}, {"b", "c"}},
                                         FilterCase{"State", {{"state", "failed"}}, {"c"}},
                                         FilterCase{
                                             "PathOfALink", {{"links.1,3.mass_kg_ge", "0.4"}}, {"b", "d"}},
                                         FilterCase{"Both", {{"peak_gt", "7"}, {"peak_lt", "9"}}, {"d"}}),
                         [](const auto& tested) { return tested.param.name; });

Strings fault_pointers(const jobs::ResultQuery& query) {
  return pointers_of(faults_of([&] { (void)applied(query); }));
}

TEST(ResultQuery, NamesEveryFault) {
  EXPECT_EQ(
      fault_pointers(
          {.fields = "job_id,peek,job_id,",
           .filters = {{"nonsense_gt", "1"}, {"peak_lt", "x"}, {"coupler_gt", "rigid"}, {"coupler", "soft"}},
           .order_by = "-speed",
           .limit = {}}),
      (Strings{"/coupler", "/coupler_gt", "/fields/1", "/fields/2", "/fields/3", "/nonsense_gt",
               "/order_by/0", "/peak_lt"}));
  EXPECT_EQ(fault_pointers({.fields = {}, .filters = {{"peak", "nan"}}, .order_by = {}, .limit = {}}),
            (Strings{"/peak"}));
}

TEST(ResultQuery, OrdersByColumnsNullLast) {
  EXPECT_EQ(ids(applied({.fields = {}, .filters = {}, .order_by = "peak", .limit = {}})),
            (Strings{"a", "d", "b", "c"}));
  EXPECT_EQ(ids(applied({.fields = {}, .filters = {}, .order_by = "-peak", .limit = {}})),
            (Strings{"b", "d", "a", "c"}));
  EXPECT_EQ(
      ids(applied({.fields = {}, .filters = {}, .order_by = "coupler,-links.1,3.mass_kg", .limit = {}})),
      (Strings{"b", "c", "d", "a"}));
  EXPECT_EQ(ids(applied({.fields = {}, .filters = {}, .order_by = "-peak", .limit = 2})),
            (Strings{"b", "d"}));
}

TEST(ResultQuery, OrdersTheFirstRowsAsItOrdersAll) {
  jobs::ResultTable many = table();
  many.rows.clear();
  for (int k = 0; k < 300; ++k) {
    many.rows.push_back({std::to_string(k), "succeeded", k % 3 == 0 ? "rigid" : "flexible", 0.1 * (k * 7 % 5),
                         k % 11 == 0 ? json(nullptr) : json(k * 37 % 13)});
  }
  const auto ordered = [&](std::optional<std::size_t> limit) {
    auto result = many;
    jobs::apply({.fields = {}, .filters = {}, .order_by = "-peak,coupler", .limit = limit}, result,
                jobs::kSweepColumns);
    return ids(result);
  };
  const Strings all = ordered({});
  for (std::size_t k = 1; k < all.size(); ++k) {  // rows alike keep their order
    const auto& [before, row] = std::pair(many.rows[std::stoul(all[k - 1])], many.rows[std::stoul(all[k])]);
    if (before[4] == row[4] && before[2] == row[2]) {
      EXPECT_LT(std::stoi(all[k - 1]), std::stoi(all[k]));
    }
  }
  for (const std::size_t limit : {0, 1, 7, 150, 299, 300, 1000})
    EXPECT_EQ(ordered(limit), Strings(all.begin(), all.begin() + static_cast<int>(std::min(limit, all.size()))));
}

TEST(ResultQuery, TakesColumnsInTheOrderInWhichTheyAreWanted) {
  const auto result =
      applied({.fields = "peak,links.1,3.mass_kg,job_id", .filters = {}, .order_by = {}, .limit = {}});
  EXPECT_EQ(result.columns, (Strings{"peak", "links.1,3.mass_kg", "job_id"}));
  EXPECT_EQ(result.rows[1], (std::vector<json>{9.0, 0.4, "b"}));
}

TEST(ResultQuery, KeepsTheStatisticsOfTheRowsThatStay) {
  auto repeated = table();
  for (std::size_t k = 0; k < 4; ++k)
    repeated.replicates.push_back({.count = k, .mean = {}, .spread = {}, .min = {}, .max = {}});
  auto some = repeated;
  jobs::apply({.fields = "job_id,replicates", .filters = {{"peak_gt", "7"}}, .order_by = "peak", .limit = {}},
              some, jobs::kSweepColumns);
  ASSERT_EQ(some.replicates.size(), 2U);
  EXPECT_EQ(some.replicates[0].count, 3U);
  EXPECT_EQ(some.replicates[1].count, 1U);
  jobs::apply({.fields = "job_id", .filters = {}, .order_by = {}, .limit = {}}, repeated,
              jobs::kSweepColumns);
  EXPECT_TRUE(repeated.replicates.empty());
}

TEST(ResultQuery, FindsTheParametersThatTheSweepDoesNotVary) {
  const jobs::ResultQuery query{.fields = "job_id,links.1,3.mass_kg",
                                .filters = {{"restitution_gt", "0.5"}},
                                .order_by = "-clearance_mm,peak",
                                .limit = {}};
  EXPECT_EQ(jobs::find_other_columns(query, {"clearance_mm"}), (Strings{"restitution", "links.1,3.mass_kg"}));
}

TEST(ResultQuery, FindsTheColumnsOfErrorsIfTheyAreNamed) {
  const jobs::ResultQuery query{.fields = "job_id,error_detail",
                                .filters = {{"error_reason", "lock_up"}},
                                .order_by = "restitution",
                                .limit = {}};
  EXPECT_EQ(jobs::find_other_columns(query, {}), (Strings{"restitution", "error_reason", "error_detail"}));
  EXPECT_EQ(jobs::needed_parameters({"restitution", "error_reason"}), jobs::RowParameters::kAll);
  EXPECT_EQ(jobs::needed_parameters({"error_reason", "error_detail"}), jobs::RowParameters::kNone);
  EXPECT_EQ(jobs::find_other_columns({.fields = "job_id", .filters = {}, .order_by = {}, .limit = {}}, {}),
            Strings{});
}

TEST(ResultQuery, SaysWhereColumnsAreListed) {
  const auto faults = faults_of(
      [] { (void)applied({.fields = "stiffness_of_a_spring", .filters = {}, .order_by = {}, .limit = {}}); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults.front().detail.find("allowed: job_id, state, coupler"), std::string::npos)
      << faults.front().detail;
}

}  // namespace
}  // namespace jobs_tests
