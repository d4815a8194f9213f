// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/http/http.h"
#include "server/http/http_limits.h"
#include "tests/server/http/raw_client.h"
#include "tests/server/service_fixture.h"

namespace server_tests {

using Clock = std::chrono::steady_clock;

inline constexpr std::size_t kBodyBytes = 100'000;
inline constexpr std::size_t kMeasurementBodyBytes = 400'000;

/// Limits that a test can run into without waiting for long.
inline server::HttpLimits short_limits() {
  using namespace std::chrono_literals;
  server::HttpLimits limits;
  limits.body_bytes = kBodyBytes;
  limits.measurement_body_bytes = kMeasurementBodyBytes;
  limits.head_time = 400ms;
  limits.body_time = 900ms;
  limits.linger_time = 300ms;
  limits.drain_time = 200ms;
  return limits;
}

/// Server on a free port of loopback.
class Http : public testing::Test {
 protected:
  Http() : http_(bench_.routes(), {.address = "127.0.0.1", .port = 0}, short_limits()), port_(http_.bind()) {
    if (port_ == 0) throw std::runtime_error("no free port");
    listener_ = std::jthread([this] { http_.listen(); });
  }
  ~Http() override { http_.stop(); }

  /// The answer to these bytes.
  [[nodiscard]] std::string ask(const std::string& bytes) const {
    RawClient client(port_);
    client.send(bytes);
    return client.read_all();
  }

  [[nodiscard]] std::string get(const std::string& path, const std::string& headers = "") const {
    return ask("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
  }

  [[nodiscard]] std::string post(const std::string& path, const std::string& body,
                                 const std::string& headers = "") const {
    return ask("POST " + path + " HTTP/1.1\r\nHost: localhost\r\nContent-Length: " +
               std::to_string(body.size()) + "\r\n" + headers + "\r\n" + body);
  }

  [[nodiscard]] std::size_t sweep_count() {
    return nlohmann::json::parse(bench_.call("GET", "/v1/sweeps").body).at("items").size();
  }

  Bench bench_;
  server::HttpServer http_;
  int port_;
  std::jthread listener_;
};

}  // namespace server_tests
