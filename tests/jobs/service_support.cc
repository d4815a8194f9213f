// SPDX-License-Identifier: Apache-2.0
#include "tests/jobs/service_support.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "tests/jobs/request_support.h"

namespace jobs_tests {

TemporaryStore::TemporaryStore() {
  std::string pattern = (std::filesystem::temp_directory_path() / "rpsup-jobs-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  folder_ = pattern;
}

TemporaryStore::~TemporaryStore() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

jobs::Runner FakeEngine::runner() {
  return [this](const jobs::JobSpec& spec, const engine::StopQuery& stop_requested) {
    return run(spec, stop_requested);
  };
}

engine::RunResult FakeEngine::run(const jobs::JobSpec& spec, const engine::StopQuery& stop_requested) {
  engine::RunResult result;
  {
    std::unique_lock lock(mutex_);
    speeds_.push_back(spec.parameters.crank_velocity);
    ++running_;
    changed_.notify_all();
    while (held_ && !stop_requested(0.25)) changed_.wait_for(lock, std::chrono::milliseconds(2));
    if (held_) {
      ++stopped_;
      result.status = engine::RunStatus::kStopped;
    }
    --running_;
    changed_.notify_all();
  }
  const double x = spec.parameters.crank_velocity * 1e3 + spec.parameters.c_r;
  for (int k = 0; k <= 10; ++k) {
    if (k == 0) result.trajectory.columns.resize(2);
    result.trajectory.columns[0].push_back(k / 10.0);
    result.trajectory.columns[1].push_back(std::sqrt(x + k));
  }
  result.trajectory.channels = {{.key = "t_s", .help = "Time"},
                                {.key = "slider_position_m", .help = "Position"}};
  result.t_end = 1.0;
  if (result.status == engine::RunStatus::kStopped) return result;
  if (spec.parameters.restitution == 0.4) throw std::runtime_error("the fake engine broke");
  if (spec.parameters.restitution == 0.5) {
    result.status = engine::RunStatus::kNonFinite;
    result.detail = "the fake state is no number";
    return result;
  }
  for (std::size_t i = 0; i < engine::metric_table().size(); ++i)
    result.metrics.push_back(i == 1 ? std::nan("") : std::sqrt(x) * static_cast<double>(i + 1));
  return result;
}

void FakeEngine::hold() {
  const std::lock_guard lock(mutex_);
  held_ = true;
}

void FakeEngine::release() {
  const std::lock_guard lock(mutex_);
  held_ = false;
  changed_.notify_all();
}

void FakeEngine::await_running(int count) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait_for(lock, std::chrono::seconds(300), [&] { return running_ == count; }))
    throw std::runtime_error("no such number of runs began");
}

std::vector<double> FakeEngine::begun_speeds() {
  const std::lock_guard lock(mutex_);
  return speeds_;
}

int FakeEngine::stopped() {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

jobs::ServiceOptions options_of(const TemporaryStore& store, int threads) {
  jobs::ServiceOptions options;
  options.store = store.file();
  options.threads = threads;
  return options;
}

jobs::ServiceOptions options_of(const TemporaryStore& store, FakeEngine& engine, int threads) {
  jobs::ServiceOptions options = options_of(store, threads);
  options.runner = engine.runner();
  return options;
}

std::string submitted(jobs::Service& service, const char* request) {
  return service.submit_sweep(request_of(request)).at("id");
}

nlohmann::json finished(const jobs::Service& service, const std::string& sweep) {
  EXPECT_TRUE(service.wait_for_sweep(sweep, std::chrono::seconds(20)));
  return service.find_sweep(sweep).value();
}

std::string first_job(const jobs::Service& service, const std::string& sweep) {
  return service.find_results(sweep).value().rows.at(0).at(0);
}

void execute_sql(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec(sql);
}

std::string query_sql(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
  return database.execAndGet(sql).getString();
}

}  // namespace jobs_tests
