// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_stream.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using server::HttpLimits;
using server::HttpStream;
using Clock = std::chrono::steady_clock;

const std::atomic<bool> kNotDraining = false;
const std::atomic<int> kNobodyWaits = 0;

/// Two ends of a connection with small buffers.
class Pair {
 public:
  Pair() {
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()) != 0) throw std::runtime_error("no socket pair");
    const int small = 4096;
    for (const int end : ends_) ::setsockopt(end, SOL_SOCKET, SO_SNDBUF, &small, sizeof small);
  }
  ~Pair() {
    for (const int end : ends_) ::close(end);
  }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;

  [[nodiscard]] int server() const { return ends_[0]; }
  [[nodiscard]] int client() const { return ends_[1]; }

 private:
  std::array<int, 2> ends_{};
};

HttpLimits limits_of(std::chrono::milliseconds stall_time, std::size_t least_bytes_per_s) {
  HttpLimits limits;
  limits.response_time = 20s;
  limits.stall_time = stall_time;
  limits.least_bytes_per_s = least_bytes_per_s;
  return limits;
}

/// Takes some bytes at a time with pauses between until the stream is closed, for as long as this lives.
std::jthread slow_reader(const Pair& pair, std::size_t bytes, std::chrono::milliseconds pause) {
  return std::jthread([end = pair.client(), bytes, pause](const std::stop_token& stop) {
    std::string taken(bytes, '\0');
    while (!stop.stop_requested()) {
      static_cast<void>(::recv(end, taken.data(), taken.size(), MSG_DONTWAIT));
      std::this_thread::sleep_for(pause);
    }
  });
}

TEST(HttpStream, GivesUpAClientThatTakesNothing) {
  const Pair pair;
  HttpStream stream({.socket = pair.server()}, limits_of(300ms, 1024 * 1024), kNotDraining, kNobodyWaits);
  const auto start = Clock::now();
  EXPECT_FALSE(stream.send_all(std::string(1'000'000, 'a')));
  const auto took = Clock::now() - start;
  EXPECT_GE(took, 290ms);
  EXPECT_LT(took, 5s) << "as long as the whole answer may take";
}

TEST(HttpStream, GivesUpAClientThatTakesALittleNowAndThen) {
  const Pair pair;
  // 20 bytes a second would keep the connection for hours; each wait alone is short.
  HttpStream stream({.socket = pair.server()}, limits_of(500ms, 100'000), kNotDraining, kNobodyWaits);
  const auto reader = slow_reader(pair, 1, 50ms);
  const auto start = Clock::now();
  EXPECT_FALSE(stream.send_all(std::string(1'000'000, 'a')));
  EXPECT_LT(Clock::now() - start, 8s);
}

TEST(HttpStream, ServesAClientThatIsSlowButSteady) {
  const Pair pair;
  // Some 400 kB/s, four times what is asked for: 300 kB take longer than a stall may.
  HttpStream stream({.socket = pair.server()}, limits_of(250ms, 100'000), kNotDraining, kNobodyWaits);
  const auto reader = slow_reader(pair, 4000, 10ms);
  const auto start = Clock::now();
  EXPECT_TRUE(stream.send_all(std::string(300'000, 'a')));
  EXPECT_GT(Clock::now() - start, 300ms) << "the client was not slow";
}

TEST(HttpStream, GivesALargeAnswerMoreTimeThanASmallOne) {
  HttpLimits limits = limits_of(20s, 1024);
  limits.response_time = 250ms;
  limits.response_bytes_per_s = 100'000;
  const Pair pair;
  HttpStream stream({.socket = pair.server()}, limits, kNotDraining, kNobodyWaits);
  const auto reader = slow_reader(pair, 4000, 10ms);  // some 400 kB/s
  const auto start = Clock::now();
  EXPECT_TRUE(stream.send_all(std::string(300'000, 'a')));
  EXPECT_GT(Clock::now() - start, 300ms) << "the client was not slow";
}

TEST(HttpStream, GivesUpAClientThatIsSteadyButTooSlow) {
  HttpLimits limits = limits_of(20s, 1024);
  limits.response_time = 250ms;
  limits.response_bytes_per_s = 1024 * 1024;
  const Pair pair;
  HttpStream stream({.socket = pair.server()}, limits, kNotDraining, kNobodyWaits);
  const auto reader = slow_reader(pair, 1000, 10ms);
  const auto start = Clock::now();
  EXPECT_FALSE(stream.send_all(std::string(1'000'000, 'a')));
  EXPECT_LT(Clock::now() - start, 5s);
}

TEST(HttpStream, HurriesAClientThatTakesNothingOnceOthersWait) {
  HttpLimits limits = limits_of(20s, 1024);
  limits.crowded_time = 200ms;
  const Pair pair;
  const std::atomic<int> waiting = 1;
  HttpStream stream({.socket = pair.server()}, limits, kNotDraining, waiting);
  const auto start = Clock::now();
  EXPECT_FALSE(stream.send_all(std::string(1'000'000, 'a')));
  EXPECT_GE(Clock::now() - start, 190ms);
  EXPECT_LT(Clock::now() - start, 5s);
}

TEST(HttpStream, HurriesAClientOnceOthersWait) {
  HttpLimits limits;
  limits.head_time = limits.linger_time = 20s;
  limits.crowded_time = 200ms;
  const Pair pair;
  ASSERT_EQ(::send(pair.client(), "GET", 3, 0), 3);
  std::atomic<int> waiting = 0;
  const auto start = Clock::now();
  HttpStream stream({.socket = pair.server()}, limits, kNotDraining, waiting);
  std::jthread others([&waiting] {
    std::this_thread::sleep_for(600ms);
    waiting = 1;
  });
  EXPECT_EQ(stream.read_head(), HttpStream::Head::kTooSlow);
  EXPECT_GE(Clock::now() - start, 590ms) << "hurried although nobody waited";
  EXPECT_LT(Clock::now() - start, 3s);
  const auto closing = Clock::now();
  stream.lingering_close();
  EXPECT_GE(Clock::now() - closing, 190ms);
  EXPECT_LT(Clock::now() - closing, 3s);
}

}  // namespace
