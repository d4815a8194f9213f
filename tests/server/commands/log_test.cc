// SPDX-License-Identifier: Apache-2.0
#include "server/commands/log.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include <unistd.h>

#include <gtest/gtest.h>

namespace {

using server::commands::escape_for_log;
using server::commands::LineQueue;

TEST(Log, LeavesPlainTextAsItIs) {
  EXPECT_EQ(escape_for_log("GET /v1/sweeps 200 0.1 ms \\ \"~"), "GET /v1/sweeps 200 0.1 ms \\ \"~");
}

TEST(Log, KeepsTextOfUsersOnItsLine) {
  EXPECT_EQ(escape_for_log("a\r\n2026-01-01 info all is well"), "a\\x0d\\x0a2026-01-01 info all is well");
  EXPECT_EQ(escape_for_log("\x1b[2J\x7f\x9b\xc3\xa4"), "\\x1b[2J\\x7f\\x9b\\xc3\\xa4");
  EXPECT_EQ(escape_for_log(std::string(1, '\0')), "\\x00");
}

/// Pipe whose reader does not read until read_all().
class UnreadPipe {
 public:
  UnreadPipe() { EXPECT_EQ(::pipe(ends_.data()), 0); }
  ~UnreadPipe() {
    ::close(ends_[0]);
    if (ends_[1] >= 0) ::close(ends_[1]);
  }
  UnreadPipe(const UnreadPipe&) = delete;
  UnreadPipe& operator=(const UnreadPipe&) = delete;
  [[nodiscard]] int writing_end() const { return ends_[1]; }
  std::string read_until(const std::string& end) {
    std::string all;
    std::array<char, 65536> some;
    while (!all.ends_with(end)) {
      const ssize_t got = ::read(ends_[0], some.data(), some.size());
      if (got <= 0) break;
      all.append(some.data(), static_cast<std::size_t>(got));
    }
    return all;
  }

 private:
  std::array<int, 2> ends_{};
};

TEST(LineQueue, NeverWaitsForItsReaderAndKeepsTheOrder) {
  UnreadPipe pipe;
  auto lines = std::make_unique<LineQueue>(pipe.writing_end());
  const std::string line(1000, 'a');
  const auto start = std::chrono::steady_clock::now();
  int kept = 0;
  for (int i = 0; i < 10'000; ++i) kept += lines->add(std::to_string(i) + line + "\n") ? 1 : 0;
  // The pipe holds 64 KiB, the queue 1 MiB, and its thread as much again while it writes.
  EXPECT_GT(kept, 900);
  EXPECT_LT(kept, 2'300);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  std::thread reader([&] {
    const std::string all = pipe.read_until("last\n");
    EXPECT_EQ(std::ranges::count(all, '\n'), kept + 1);
    EXPECT_TRUE(all.starts_with("0" + line + "\n1" + line + "\n2a"));
  });
  while (!lines->add("last\n")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  reader.join();
}

TEST(LineQueue, EndsThoughNobodyReads) {
  UnreadPipe pipe;
  auto lines = std::make_unique<LineQueue>(pipe.writing_end());
  const std::string line(10'000, 'a');
  while (lines->add(line)) {
  }
  while (!lines->add("last\n")) {
  }
  const auto start = std::chrono::steady_clock::now();
  lines.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  // Lets the thread go, which would write to whatever has the number of the descriptor next.
  EXPECT_TRUE(pipe.read_until("last\n").ends_with("last\n"));
}

}  // namespace
