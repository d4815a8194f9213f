// SPDX-License-Identifier: Apache-2.0
// Stores of former programs are brought to the newest form.

#include <chrono>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "jobs/service.h"
#include "jobs/store/store.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::StudyKind;

/// A store as the last program wrote it that knew no newer form. Each has a sweep of two jobs that have
/// succeeded.
void make_store_of_form(int form, const std::filesystem::path& file) {
  { std::ofstream(file) << ""; }
  execute_sql(file, "PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = WAL");
  std::ifstream dump(std::string(STORE_FORMS) + "/form_" + std::to_string(form) + ".sql");
  const std::string text{std::istreambuf_iterator<char>(dump), {}};
  ASSERT_FALSE(text.empty());
  execute_sql(file,
              text + "PRAGMA application_id = 0x52505355; PRAGMA user_version = " + std::to_string(form));
}

TEST(StoreForm, TakesOverAStoreOfForm1) {
  const TemporaryStore temporary;
  make_store_of_form(1, temporary.file());
  execute_sql(temporary.file(), "UPDATE jobs SET ended_ms = ended_ms - 1000 WHERE seq = 2");
  const std::string id = query_sql(temporary.file(), "SELECT id FROM sweeps");
  {
    jobs::Store store(temporary.file());
    const auto changes = store.reader.find_changes(id, 0).value();
    EXPECT_EQ(changes.sweep.name, "of form 1");
    EXPECT_EQ(changes.sweep.priority, 0);
    ASSERT_EQ(changes.ended.size(), 2U);
    // In the order in which they ended, which is not that of their making: the second one was done first.
    EXPECT_EQ(changes.ended[0].change, 1);
    EXPECT_EQ(changes.ended[1].change, 2);
    const auto results = store.reader.find_results(id).value();
    ASSERT_EQ(results.rows.size(), 2U);
    EXPECT_EQ(changes.ended[0].id, results.rows[1].job_id);
    EXPECT_TRUE(results.rows[0].metrics.has_value());
    EXPECT_TRUE(store.reader.find_trajectory(results.rows[0].job_id).has_value());
    EXPECT_TRUE(store.reader.find_job(results.rows[0].job_id).has_value());
  }
  EXPECT_EQ(query_sql(temporary.file(), "PRAGMA user_version"), "6");
  EXPECT_EQ(query_sql(temporary.file(), "PRAGMA integrity_check"), "ok");
}

TEST(StoreForm, CountsOnFromTheChangesThatAStoreHas) {
  const TemporaryStore temporary;
  make_store_of_form(1, temporary.file());
  execute_sql(temporary.file(),
              "UPDATE jobs SET state = 'queued', result = NULL, ended_ms = NULL WHERE seq = 2");
  const std::string id = query_sql(temporary.file(), "SELECT id FROM sweeps");
  for (const std::int64_t change : {1, 2}) {
    jobs::Store store(temporary.file());
    EXPECT_EQ(store.reader.find_changes(id, 0).value().ended.back().change, change);
    static_cast<void>(store.queue.cancel_sweep(id));
  }
}

class FormerStore : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    make_store_of_form(GetParam(), store_.file());
    // Answers are kept for a week.
    if (GetParam() > 1) execute_sql(store_.file(), "UPDATE answers SET created_ms = 1000 * unixepoch()");
  }

  TemporaryStore store_;
  FakeEngine engine_;
};

TEST_P(FormerStore, GoesOn) {
  jobs::Service service(options_of(store_, engine_, 1));
  const std::string id = service.list_sweeps({}).at("items").back().at("id");
  const auto results = service.find_results(id).value();
  ASSERT_EQ(results.rows.size(), 2U);
  const std::string job = results.rows[0][0];
  EXPECT_EQ(service.find_job(job).value().at("state"), "succeeded");
  EXPECT_TRUE(service.find_trajectory(job, {}).has_value());

  ASSERT_TRUE(service.extend_sweep(id, {{"sweep", {{"clearance_mm", {0.2}}}}}).has_value());
  ASSERT_TRUE(service.wait_for_sweep(id, std::chrono::seconds(300)));
  EXPECT_EQ(service.find_sweep(id).value().at("counts").at("succeeded"), 3);
}

INSTANTIATE_TEST_SUITE_P(Forms, FormerStore, testing::Range(1, 6));

class FormerAnswers : public FormerStore {};

TEST_P(FormerAnswers, AreGivenAgain) {
  jobs::Service service(options_of(store_, engine_, 1));
  const std::string id = service.list_sweeps({}).at("items").back().at("id");
  const auto request = nlohmann::ordered_json::parse(
      R"({"name": "kept", "priority": 3, "parameters": {"duration_s": 0.01, "run_up_s": 0.005,
    "output_rate_hz": 100}, "sweep": {"clearance_mm": [0, 0.3]}})");
  EXPECT_EQ(service.submit_sweep(request, "sweep-key").at("id"), id);
  EXPECT_NE(service.submit_sweep(request, "another-key").at("id"), id);
}

INSTANTIATE_TEST_SUITE_P(Forms, FormerAnswers, testing::Values(2, 3, 4, 5));

TEST(StoreForm, TakesOverTheSearchesOfForm3) {
  const TemporaryStore temporary;
  FakeEngine engine;
  make_store_of_form(3, temporary.file());
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = service.list_studies(StudyKind::kSearch, {}).at("items").at(0).at("id");
  const auto search = service.find_study(StudyKind::kSearch, id).value();
  EXPECT_EQ(search.at("state"), "succeeded");
  EXPECT_EQ(search.at("limits").at(0).at("verdict"), "never_exceeded");
}

}  // namespace
}  // namespace jobs_tests
