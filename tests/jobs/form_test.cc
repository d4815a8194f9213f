// Stores of former programs are brought to the newest form.

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "jobs/store.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

/// A store of form 1, as the program wrote it that knew no other: a sweep of two jobs that have succeeded.
void make_store_of_form_1(const std::filesystem::path& file) {
  { std::ofstream(file) << ""; }
  execute_sql(file, "PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = WAL");
  std::ifstream dump(FORM_1_DUMP);
  const std::string text{std::istreambuf_iterator<char>(dump), {}};
  ASSERT_FALSE(text.empty());
  execute_sql(file, text + "PRAGMA application_id = 0x52505355; PRAGMA user_version = 1");
}

TEST(StoreForm, TakesOverAStoreOfForm1) {
  const TemporaryStore temporary;
  make_store_of_form_1(temporary.file());
  execute_sql(temporary.file(), "UPDATE jobs SET ended_ms = ended_ms - 1000 WHERE seq = 2");
  const std::string id = query_sql(temporary.file(), "SELECT id FROM sweeps");
  {
    jobs::Store store(temporary.file());
    const auto changes = store.find_changes(id, 0).value();
    EXPECT_EQ(changes.sweep.name, "of form 1");
    EXPECT_EQ(changes.sweep.priority, 0);
    ASSERT_EQ(changes.ended.size(), 2U);
    // In the order in which they ended, which is not that of their making: the second one was done first.
    EXPECT_EQ(changes.ended[0].change, 1);
    EXPECT_EQ(changes.ended[1].change, 2);
    const auto results = store.find_results(id, false).value();
    ASSERT_EQ(results.rows.size(), 2U);
    EXPECT_EQ(changes.ended[0].id, results.rows[1].job_id);
    EXPECT_TRUE(results.rows[0].metrics.has_value());
    EXPECT_TRUE(store.find_trajectory(results.rows[0].job_id).has_value());
    EXPECT_TRUE(store.find_job(results.rows[0].job_id).has_value());
  }
  EXPECT_EQ(query_sql(temporary.file(), "PRAGMA user_version"), "4");
  EXPECT_EQ(query_sql(temporary.file(), "PRAGMA integrity_check"), "ok");
}

TEST(StoreForm, CountsOnFromTheChangesThatAStoreHas) {
  const TemporaryStore temporary;
  make_store_of_form_1(temporary.file());
  execute_sql(temporary.file(), "UPDATE jobs SET state = 'queued', result = NULL, ended_ms = NULL WHERE seq = 2");
  const std::string id = query_sql(temporary.file(), "SELECT id FROM sweeps");
  for (const std::int64_t change : {1, 2}) {
    jobs::Store store(temporary.file());
    EXPECT_EQ(store.find_changes(id, 0).value().ended.back().change, change);
    static_cast<void>(store.cancel_sweep(id));
  }
}

}  // namespace
}  // namespace jobs_tests
