// SPDX-License-Identifier: Apache-2.0
// Acknowledged data is there after a loss of power at any moment.

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "jobs/store/store.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"
#include "tests/jobs/store/losing_disk.h"

namespace jobs_tests {
namespace {

constexpr int kSweeps = 40;

/// Content of the disk at a moment, and the sweeps of which clients had been told by then.
struct Loss {
  std::filesystem::path store;
  std::vector<std::string> acknowledged, cancelled, deleted;
};

/// Uses a store as a service does, and loses the power now and then.
class PowerLoss : public testing::TestWithParam<unsigned> {
 protected:
  void lose_power_sometimes() {
    if (disk_ == nullptr || dice_() % 4 != 0) return;
    losses_.push_back({.store = temporary_.file().string() + "." + std::to_string(losses_.size()),
                       .acknowledged = now_.acknowledged,
                       .cancelled = now_.cancelled,
                       .deleted = now_.deleted});
    disk_->leave(temporary_.file(), losses_.back().store, dice_);
  }

  void use_store() {
    LosingDisk disk([this] { lose_power_sometimes(); });
    disk_ = &disk;
    {
      jobs::Store store(temporary_.file());
      for (int i = 0; i < kSweeps; ++i) {
        do_something(store, i);
        lose_power_sometimes();
      }
    }
    disk_ = nullptr;
  }

  void do_something(jobs::Store& store, int number) {
    const std::string request =
        R"({"reuse": false, "sweep": {"crank_velocity_rad_s": [1, 2, )" + std::to_string(number + 3) + "]}}";
    const jobs::IdempotencyRecord<jobs::SweepRow> kept{
        .key = std::to_string(number), .fingerprint = request, .make_response = [](const auto& row) {
          return row.id;
        }};
    now_.acknowledged.push_back(
        store.queue.add_sweep(jobs::plan_sweep(request_of(request.c_str()), 10), request, 10'000, kept));
    if (number % 3 == 0) compute_a_job(store);
    if (number % 5 == 4) {
      const std::string id = now_.acknowledged[now_.acknowledged.size() - 2];
      static_cast<void>(store.queue.cancel_sweep(id));
      now_.cancelled.push_back(id);
    }
    if (number % 10 == 9) {
      const std::string id = now_.cancelled.front();
      now_.cancelled.erase(now_.cancelled.begin());
      std::erase(now_.acknowledged, id);  // from here on it may be there, and may not
      static_cast<void>(store.queue.delete_sweep(id));
      store.release_free_pages();
      now_.deleted.push_back(id);
    }
  }

  static void compute_a_job(jobs::Store& store) {
    const jobs::ClaimedJob job = store.queue.claim().value();
    jobs::RunRecord record;
    record.end = jobs::RunRecord::End::kFailed;
    record.error_reason = "internal";
    record.error_detail = std::string(20'000, 'x');
    EXPECT_TRUE(store.queue.record(job, record));
  }

  TemporaryStore temporary_;
  std::mt19937_64 dice_{GetParam()};
  LosingDisk* disk_ = nullptr;
  Loss now_;
  std::vector<Loss> losses_;
};

TEST_P(PowerLoss, LeavesWhatWasAcknowledged) {
  use_store();
  ASSERT_GT(losses_.size(), 20U);
  for (const Loss& loss : losses_) {
    {
      const jobs::Store store(loss.store);
      for (const std::string& id : loss.acknowledged)
        EXPECT_TRUE(store.reader.find_sweep(id).has_value()) << id << " in " << loss.store;
      for (const std::string& id : loss.cancelled) {
        const auto sweep = store.reader.find_sweep(id);
        EXPECT_TRUE(sweep && jobs::sweep_state(sweep->counts) == "cancelled") << id;
      }
      for (const std::string& id : loss.deleted) EXPECT_FALSE(store.reader.find_sweep(id).has_value()) << id;
    }
    for (const std::string& id : loss.acknowledged) {
      EXPECT_EQ(query_sql(loss.store, "SELECT count(*) FROM answers WHERE answer = '" + id + "'"), "1")
          << "the answer that a repeated request gets";
    }
    EXPECT_EQ(query_sql(loss.store, "PRAGMA integrity_check"), "ok");
    EXPECT_EQ(query_sql(loss.store, "SELECT count(*) FROM pragma_foreign_key_check()"), "0");
    EXPECT_EQ(
        query_sql(loss.store,
                  "SELECT count(*) FROM jobs WHERE state IN ('succeeded', 'failed') AND result IS NULL"),
        "0");
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PowerLoss, testing::Range(1U, 4U),
                         [](const auto& tested) { return std::to_string(tested.param); });

}  // namespace
}  // namespace jobs_tests
