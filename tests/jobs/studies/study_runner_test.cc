// SPDX-License-Identifier: Apache-2.0
#include "jobs/studies/study_runner.h"

#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/results/result_table.h"
#include "jobs/store/store.h"
#include "tests/jobs/service_support.h"
#include "tests/jobs/store/store_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Ends its study at once.
class EndingSampler final : public jobs::StudySampler {
 public:
  void tell(const jobs::ResultRow&) override {}
  [[nodiscard]] jobs::NextCases ask() override { return {.end_state = "succeeded", .error = {}}; }
  [[nodiscard]] double progress() const override { return 1.0; }
};

/// Studies without samplers if their name is "broken".
class EndingStudy final : public jobs::StudyType {
 public:
  [[nodiscard]] std::string_view id_prefix() const override { return jobs::kSearchPrefix; }
  [[nodiscard]] jobs::FirstSweep plan_first(const ordered_json& request, std::size_t) const override {
    return {.request = request, .plan = stored_plan_of(request.dump().c_str())};
  }
  [[nodiscard]] std::unique_ptr<jobs::StudySampler> make_sampler(const jobs::StudyRow& study,
                                                                 const jobs::SweepResults&) const override {
    if (study.name == "broken") throw jobs::StorageError("a study that is broken");
    return std::make_unique<EndingSampler>();
  }
  [[nodiscard]] json make_resource(const jobs::StudyRow& study, const jobs::SweepResults&,
                                   int) const override {
    return {{"id", study.id}};
  }
  [[nodiscard]] json make_summary(const jobs::StudyRow& study) const override { return {{"id", study.id}}; }
  [[nodiscard]] const std::vector<std::string>& listing_keys() const override { return keys_; }
  [[nodiscard]] jobs::ResultTable make_table(const jobs::StudyRow&,
                                             const jobs::SweepResults&) const override {
    return {};
  }

 private:
  std::vector<std::string> keys_{"id"};
};

class StudyRunnerTest : public testing::Test {
 protected:
  std::string submit(const char* request) {
    return runner_.submit(request_of(request), {.key = {}, .fingerprint = {}}).at("id");
  }

  TemporaryStore temporary_;
  jobs::Store store_{temporary_.file()};
  jobs::StudyRunner runner_{
      store_, {.max_sweep_jobs = 100, .max_queued_jobs = 100, .threads = 1}, std::make_unique<EndingStudy>()};
};

TEST_F(StudyRunnerTest, LetsOthersGoOnBesideAStudyThatFails) {
  const std::string older = submit(R"({"name": "sound"})");
  const std::string broken = submit(R"({"name": "broken"})");
  const std::string newer = submit(R"({"name": "sound, too"})");
  const jobs::StudyChanges changes = runner_.advance();
  EXPECT_TRUE(changes.any);
  EXPECT_EQ(runner_.find_row(older)->state, "succeeded");
  EXPECT_EQ(runner_.find_row(newer)->state, "succeeded");
  EXPECT_EQ(runner_.find_row(broken)->state, "running");
  ASSERT_TRUE(changes.failure);
  EXPECT_THROW(std::rethrow_exception(changes.failure), jobs::StorageError);
}

}  // namespace
}  // namespace jobs_tests
