// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/service.h"

namespace jobs_tests {

/// A folder of its own for a test's store; gone with the test.
class TemporaryStore {
 public:
  TemporaryStore();
  ~TemporaryStore();
  TemporaryStore(const TemporaryStore&) = delete;
  TemporaryStore& operator=(const TemporaryStore&) = delete;

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "study.db"; }

 private:
  std::filesystem::path folder_;
};

/// Stands for the engine: its results are plain functions of the parameters, and it can be held up. What a
/// job does depends on its restitution: 0.5 fails as non_finite, 0.4 throws, anything else succeeds.
class FakeEngine {
 public:
  /// Safe to call from many threads. Must not outlive this.
  [[nodiscard]] jobs::Runner runner();

  void hold();     ///< runs that begin from now on wait
  void release();  ///< until this, or until they are asked to stop
  void await_running(int count);  ///< returns when so many runs are under way

  /// crank velocities of the runs so far, in order of their beginning
  [[nodiscard]] std::vector<double> begun_speeds();
  [[nodiscard]] int stopped();                       ///< how many runs ended because they were asked to

 private:
  engine::RunResult run(const jobs::JobSpec& spec, const engine::StopQuery& stop_requested);

  std::mutex mutex_;  // guards the rest
  std::condition_variable changed_;
  bool held_ = false;
  int running_ = 0;
  int stopped_ = 0;
  std::vector<double> speeds_;
};

/// A service on the engine.
[[nodiscard]] jobs::ServiceOptions options_of(const TemporaryStore& store, int threads);
/// A service on a fake engine.
[[nodiscard]] jobs::ServiceOptions options_of(const TemporaryStore& store, FakeEngine& engine, int threads);

/// Submits a sweep. @returns its id
[[nodiscard]] std::string submitted(jobs::Service& service, const char* request);
/// Waits until a sweep has ended. @returns its resource
nlohmann::json finished(const jobs::Service& service, const std::string& sweep);
/// Id of the first job of a sweep's table
[[nodiscard]] std::string first_job(const jobs::Service& service, const std::string& sweep);

/// Runs one statement on a store that nobody has open.
void execute_sql(const std::filesystem::path& file, const std::string& sql);
/// The first column of the first row, as text.
[[nodiscard]] std::string query_sql(const std::filesystem::path& file, const std::string& sql);

}  // namespace jobs_tests
