// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>

#include "jobs/requests/parameters.h"
#include "jobs/service.h"
#include "server/messages/message.h"
#include "server/routes/routes.h"
#include "tests/server/exchange_log.h"

namespace server_tests {

/// A folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "rpsup-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// A run whose numbers a test can say in advance: metric i is 100 i + clearance in mm, the last one is
/// missing; sample k of channel c is k / 1000 for the time and 10 c + k for the rest, four samples.
inline engine::RunResult known_run(const jobs::JobSpec& spec, const engine::StopQuery&) {
  engine::RunResult result;
  const std::size_t metrics = engine::metric_table().size();
  for (std::size_t i = 0; i < metrics; ++i)
    result.metrics.push_back(100.0 * static_cast<double>(i) + 1e3 * spec.parameters.c_r);
  result.metrics.back() = std::numeric_limits<double>::quiet_NaN();
  result.t_end = 0.003;
  result.trajectory.channels = engine::channel_table(spec.parameters);
  for (std::size_t c = 0; c < result.trajectory.channels.size(); ++c) {
    std::vector<double> column;
    for (int k = 0; k < 4; ++k) column.push_back(c == 0 ? k / 1000.0 : 10.0 * static_cast<double>(c) + k);
    result.trajectory.columns.push_back(std::move(column));
  }
  return result;
}

/// A run that ends only when it is asked to.
inline engine::RunResult endless_run(const jobs::JobSpec&, const engine::StopQuery& stop_requested) {
  while (!stop_requested(0.0)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  engine::RunResult result;
  result.status = engine::RunStatus::kStopped;
  return result;
}

/// A service on a store of its own, and routes to it that are called without a socket.
class Bench {
 public:
  explicit Bench(jobs::Runner runner = known_run, const jobs::StoreQuota& quota = {})
      : service_(options(std::move(runner), quota)), routes_(service_) {}

  server::Response call(const std::string& method, const std::string& path, const std::string& body = "",
                        std::vector<std::pair<std::string, std::string>> query = {},
                        const std::string& accept = "") {
    return call({method, path, std::move(query), accept, body, "test-1"});
  }

  server::Response call(const server::Request& request) {
    server::Response response = routes_.answer(request);
    log_exchange(request.method, request.path, response);
    return response;
  }

  /// Submits a sweep that must be accepted, and gives its id.
  std::string submit(const std::string& body) {
    const auto response = call("POST", "/v1/sweeps", body);
    if (response.status != 201) throw std::runtime_error("not accepted: " + response.body);
    return nlohmann::json::parse(response.body).at("id");
  }

  /// Submits a sweep and waits for its end.
  std::string run(const std::string& body) {
    const std::string id = submit(body);
    if (!service_.wait_for_sweep(id, std::chrono::seconds(300)))
      throw std::runtime_error("the sweep does not end");
    return id;
  }

  jobs::Service& service() { return service_; }
  server::Routes& routes() { return routes_; }

 private:
  jobs::ServiceOptions options(jobs::Runner runner, const jobs::StoreQuota& quota) {
    jobs::ServiceOptions result;
    result.store_quota = quota;
    result.store = folder_ / "store.db";
    result.threads = 1;
    result.runner = std::move(runner);
    return result;
  }

  TemporaryFolder folder_;
  jobs::Service service_;
  server::Routes routes_;
};

/// The value of a header; empty if it is missing.
inline std::string header(const server::Response& response, const std::string& name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return "";
}

}  // namespace server_tests
