// SPDX-License-Identifier: Apache-2.0
// Wear studies on a service whose journal slides steadily in the direction of 1 rad.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/requests/parameters.h"
#include "jobs/service.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::StudyKind;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr double kPower = 20.0;  // of each ring, [W]

/// A run whose rings slide with kPower each, 2 um deep; it fails where the bore is deeper than a limit.
class SlidingEngine {
 public:
  jobs::Runner runner() {
    return [this](const jobs::JobSpec& spec, const engine::StopQuery& stop) { return run(spec, stop); };
  }

  std::atomic<int> begun = 0;
  std::atomic<bool> held = false;
  std::atomic<double> fails_beyond_um = 1e9;

 private:
  engine::RunResult run(const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    ++begun;
    engine::RunResult result;
    while (held && !stop(0.0)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (held) result.status = engine::RunStatus::kStopped;
    double deepest = 0.0;
    for (const auto& ring : spec.parameters.wear_depth)
      deepest = std::max(deepest, *std::ranges::max_element(ring));
    if (1e6 * deepest > fails_beyond_um) result.status = engine::RunStatus::kNonFinite;
    if (result.status != engine::RunStatus::kSucceeded) return result;
    result.metrics.assign(engine::metric_table().size(), 1e6 * deepest);
    result.trajectory.channels = engine::channel_table(spec.parameters);
    for (const engine::QuantityInfo& channel : result.trajectory.channels) {
      std::vector<double> column;
      for (int k = 0; k <= 30; ++k) column.push_back(factor_of(channel.key) * 0.1 * k);
      result.trajectory.columns.push_back(std::move(column));
    }
    result.t_end = 3.0;
    return result;
  }

  static double factor_of(const std::string& key) {
    if (key == "t_s") return 1.0;
    if (!key.starts_with("ring_")) return 0.0;
    return kPower * (key.ends_with("_x_j")   ? std::cos(1.0)
                     : key.ends_with("_y_j") ? std::sin(1.0)
                     : key.ends_with("_m")   ? 2e-6
                                             : 1.0);
  }
};

jobs::ServiceOptions options_for(const TemporaryStore& store, SlidingEngine& engine) {
  jobs::ServiceOptions options = options_of(store, 1);
  options.runner = engine.runner();
  return options;
}

const ordered_json kRequest{{"name", "worn"},
                            {"parameters", {{"duration_s", 3}, {"output_rate_hz", 10}}},
                            {"wear_coefficient_m2_n", 1e-15},
                            {"hours", 2},
                            {"max_rate_change", 10}};

json wait_for_study_end(const jobs::Service& service, const std::string& id) {
  for (int tries = 0; tries < 4000; ++tries) {
    json study = service.find_study(StudyKind::kWear, id).value();
    if (study.at("state") != "running") return study;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the study does not end");
}

template <typename Condition>
void wait_until(const Condition& condition) {
  for (int tries = 0; tries < 4000 && !condition(); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(condition());
}

// Archard's volume: k W, W of the three rings over all the hours, whatever becomes of the bore.
TEST(WearStudy, WearsTheVolumeOfItsSlidingWork) {
  const TemporaryStore store;
  SlidingEngine engine;
  jobs::Service service(options_for(store, engine));
  const json begun = service.submit_study(StudyKind::kWear, kRequest);
  const json ended = wait_for_study_end(service, begun.at("id"));
  EXPECT_EQ(ended.at("state"), "succeeded");
  EXPECT_EQ(ended.at("verdict"), "hours_reached");
  EXPECT_EQ(ended.at("progress"), 1.0);
  const json& cycles = ended.at("cycles");
  ASSERT_GT(cycles.size(), 3U);
  EXPECT_EQ(cycles.size(), ended.at("counts").at("succeeded"));
  EXPECT_EQ(cycles.size(), static_cast<std::size_t>(engine.begun));
  EXPECT_EQ(cycles.at(0).at("deepest_um"), 0.0);
  EXPECT_TRUE(cycles.at(0).at("deepest_angle_rad").is_null());
  const json& last = cycles.back();
  EXPECT_DOUBLE_EQ(last.at("hours"), 2.0);
  // Channels keep seven digits.
  EXPECT_NEAR(last.at("worn_volume_mm3"), 1e9 * 1e-15 * 3.0 * kPower * 7200.0, 1e-6);
  EXPECT_NEAR(last.at("deepest_angle_rad"), 1.0, 2.0 * std::numbers::pi / 36.0);
  for (std::size_t k = 1; k < cycles.size(); ++k)
    EXPECT_LE(cycles[k].at("deepest_um").get<double>() - cycles[k - 1].at("deepest_um").get<double>(),
              1.0 + 1e-9);
  // The bore of a cycle is a parameter of its job, and its rings are worn alike.
  const json job = service.find_job(last.at("job_id")).value();
  EXPECT_EQ(job.at("parameters").at("wear_depth_um"), last.at("wear_depth_um"));
  ASSERT_EQ(last.at("wear_depth_um").size(), 3U);
  for (const json& ring : last.at("wear_depth_um")) EXPECT_EQ(ring, last.at("wear_depth_um").at(0));
  // Rows say the same, with the metrics of the jobs, here the depth.
  const auto table = service.find_study_table(StudyKind::kWear, ended.at("id")).value();
  ASSERT_EQ(table.rows.size(), cycles.size());
  EXPECT_EQ(table.columns.at(11), engine::metric_table()[0].key);
  EXPECT_NEAR(table.rows.back().at(11).get<double>(), last.at("deepest_um"), 1e-9);
  // The same study once more takes what has been computed.
  const json again = wait_for_study_end(service, service.submit_study(StudyKind::kWear, kRequest).at("id"));
  EXPECT_EQ(again.at("cycles").back().at("wear_depth_um"), last.at("wear_depth_um"));
  EXPECT_EQ(cycles.size(), static_cast<std::size_t>(engine.begun));
}

TEST(WearStudy, GoesOnAfterARestart) {
  const TemporaryStore store;
  SlidingEngine engine;
  std::string id;
  {
    jobs::Service service(options_for(store, engine));
    id = service.submit_study(StudyKind::kWear, kRequest).at("id");
    wait_until([&] { return engine.begun >= 2; });
    engine.held = true;
  }
  engine.held = false;
  jobs::Service service(options_for(store, engine));
  const json ended = wait_for_study_end(service, id);
  EXPECT_EQ(ended.at("verdict"), "hours_reached");
  EXPECT_EQ(ended.at("cycles").size(), ended.at("counts").at("succeeded"));
}

TEST(WearStudy, IsCancelledAndTakenUpAgain) {
  const TemporaryStore store;
  SlidingEngine engine;
  engine.held = true;
  jobs::Service service(options_for(store, engine));
  const std::string id = service.submit_study(StudyKind::kWear, kRequest).at("id");
  EXPECT_THROW((void)service.delete_study(StudyKind::kWear, id), jobs::WrongState);
  EXPECT_EQ(service.cancel_study(StudyKind::kWear, id).value().at("state"), "cancelled");
  wait_until(
      [&] { return service.find_study(StudyKind::kWear, id).value().at("counts").at("cancelled") == 1; });
  engine.held = false;
  EXPECT_EQ(service.retry_study(StudyKind::kWear, id).value().at("state"), "running");
  const json ended = wait_for_study_end(service, id);
  EXPECT_EQ(ended.at("verdict"), "hours_reached");
  EXPECT_THROW((void)service.delete_sweep(ended.at("sweep_id")), jobs::WrongState);
  EXPECT_THROW(
      (void)service.extend_sweep(ended.at("sweep_id"), {{"cases", {nlohmann::ordered_json::object()}}}),
      jobs::WrongState);
  EXPECT_EQ(service.find_sweep(ended.at("sweep_id")).value().at("links").at("study"), "/v1/wear-studies/" + id);
  EXPECT_TRUE(service.delete_study(StudyKind::kWear, id));
  EXPECT_FALSE(service.find_study(StudyKind::kWear, id));
}

// A deletion on a full disk may leave some of the first jobs.
TEST(WearStudy, GoesOnAfterAPartOfItsJobsWasDeleted) {
  const TemporaryStore store;
  SlidingEngine engine;
  json whole;
  {
    jobs::Service service(options_for(store, engine));
    whole = wait_for_study_end(service, service.submit_study(StudyKind::kWear, kRequest).at("id"));
  }
  execute_sql(store.file(), "DELETE FROM jobs WHERE seq > (SELECT min(seq) FROM jobs)");
  jobs::Service service(options_for(store, engine));
  EXPECT_EQ(service.find_study(StudyKind::kWear, whole.at("id")).value().at("verdict"), "open");
  (void)service.retry_study(StudyKind::kWear, whole.at("id"));
  const json again = wait_for_study_end(service, whole.at("id"));
  EXPECT_EQ(again.at("verdict"), "hours_reached");
  EXPECT_EQ(again.at("cycles").size(), whole.at("cycles").size());
}

TEST(WearStudy, IsStoredOnceUnderOneKey) {
  const TemporaryStore store;
  SlidingEngine engine;
  jobs::Service service(options_for(store, engine));
  (void)wait_for_study_end(service, service.submit_study(StudyKind::kWear, kRequest).at("id"));
  // The first job's result is known at once; the kept answer is of a study that begins all the same.
  const json first = service.submit_study(StudyKind::kWear, kRequest, "key");
  EXPECT_EQ(first.at("verdict"), "open");
  EXPECT_EQ(wait_for_study_end(service, first.at("id")).at("verdict"), "hours_reached");
  EXPECT_EQ(service.submit_study(StudyKind::kWear, kRequest, "key"), first);
  EXPECT_EQ(service.list_studies(StudyKind::kWear, {}).at("items").size(), 2U);
}

TEST(WearStudy, SaysThatAJobIsInItsWay) {
  const TemporaryStore store;
  SlidingEngine engine;
  engine.fails_beyond_um = 1.5;
  jobs::Service service(options_for(store, engine));
  const json ended = wait_for_study_end(service, service.submit_study(StudyKind::kWear, kRequest).at("id"));
  EXPECT_EQ(ended.at("state"), "failed");
  EXPECT_EQ(ended.at("verdict"), "lost");
  EXPECT_EQ(ended.at("cycles").size(), 2U);
  const auto rows = service.find_results(ended.at("sweep_id")).value().rows;
  EXPECT_EQ(ended.at("error"), rows.back().at(0).get<std::string>() + " has no result: non_finite");
}

std::set<std::string> wear_faults_of(jobs::Service& service, const ordered_json& request) {
  try {
    (void)service.submit_study(StudyKind::kWear, request);
  } catch (const jobs::InvalidRequest& invalid) {
    std::set<std::string> pointers;
    for (const jobs::Fault& fault : invalid.faults()) pointers.insert(fault.pointer);
    return pointers;
  }
  return {};
}

TEST(WearStudy, IsRefusedWithEveryFault) {
  using Pointers = std::set<std::string>;
  const TemporaryStore store;
  SlidingEngine engine;
  jobs::Service service(options_for(store, engine));
  EXPECT_EQ(wear_faults_of(service, ordered_json::array()), Pointers{""});
  EXPECT_EQ(wear_faults_of(service, {{"hour", 3}}), (Pointers{"/hour", "/hours"}));
  EXPECT_EQ(wear_faults_of(service, {{"hours", 0},
                                     {"sectors", 7},
                                     {"max_depth_step_um", "fine"},
                                     {"max_cycles", 1.5},
                                     {"wear_coefficient_m2_n", -1},
                                     {"max_rate_change", 0},
                                     {"worn_clearance_mm", 0.25}}),
            (Pointers{"/hours", "/sectors", "/max_depth_step_um", "/max_cycles", "/wear_coefficient_m2_n",
                      "/max_rate_change", "/worn_clearance_mm"}));
  EXPECT_EQ(
      wear_faults_of(service, {{"hours", 1}, {"parameters", {{"contact", "elements"}, {"duration_s", 2}}}}),
      (Pointers{"/parameters/contact", "/parameters/duration_s"}));
  EXPECT_EQ(wear_faults_of(service, {{"hours", 1}, {"parameters", {{"clearance_mm", 0}}}}),
            Pointers{"/parameters/clearance_mm"});
  EXPECT_EQ(
      wear_faults_of(service, {{"hours", 1},
                               {"parameters", {{"wear_depth_um", json::array({std::vector<double>(8)})}}}}),
      Pointers{"/parameters/wear_depth_um"});
  EXPECT_EQ(wear_faults_of(service, {{"hours", 1}, {"parameters", {{"clearance", 0.1}}}}),
            Pointers{"/parameters/clearance"});
  EXPECT_EQ(engine.begun, 0);
}

TEST(WearStudy, IsListedApartFromSearches) {
  const TemporaryStore store;
  SlidingEngine engine;
  jobs::Service service(options_for(store, engine));
  const std::string id = service.submit_study(StudyKind::kWear, kRequest).at("id");
  (void)wait_for_study_end(service, id);
  EXPECT_EQ(service.list_studies(StudyKind::kWear, {}).at("items").at(0).at("id"), id);
  EXPECT_TRUE(service.list_studies(StudyKind::kSearch, {}).at("items").empty());
  EXPECT_FALSE(service.find_study(StudyKind::kSearch, id));
  EXPECT_FALSE(service.cancel_study(StudyKind::kSearch, id));
}

}  // namespace
}  // namespace jobs_tests
