// SPDX-License-Identifier: Apache-2.0
#include "server/http/event_hub.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "server/messages/message.h"

namespace {

using namespace std::chrono_literals;
using server::EventHub;

/// Events that a test hands out.
class ToldEvents final : public server::EventSource {
 public:
  explicit ToldEvents(std::string text = "") : text_(std::move(text)) {}
  void tell(const std::string& text) {
    const std::lock_guard lock(mutex_);
    text_ += text;
  }
  std::string next() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(text_, "");
  }
  [[nodiscard]] bool has_ended() const override { return false; }

 private:
  std::mutex mutex_;
  std::string text_;
};

/// TCP connection whose one end a hub takes over.
class Connection {
 public:
  Connection() : client_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const int listening = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const name = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(listening, name, size), 0);
    EXPECT_EQ(::listen(listening, 1), 0);
    EXPECT_EQ(::getsockname(listening, name, &size), 0);
    EXPECT_EQ(::connect(client_, name, size), 0);
    server_ = ::accept(listening, nullptr, nullptr);
    ::close(listening);
  }
  ~Connection() { ::close(client_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] int client() const { return client_; }
  [[nodiscard]] int server() const { return server_; }

  /// Text that comes up to another text, or up to the end of the connection.
  [[nodiscard]] std::string read_up_to(const std::string& end) const {
    std::string text;
    std::array<char, 4096> bytes{};
    pollfd entry{client(), POLLIN, 0};
    while (text.find(end) == std::string::npos && ::poll(&entry, 1, 10'000) > 0) {
      const ssize_t got = ::recv(client(), bytes.data(), bytes.size(), 0);
      if (got <= 0) return text + "[end]";
      text.append(bytes.data(), static_cast<std::size_t>(got));
    }
    return text;
  }

 private:
  int client_;
  int server_ = -1;
};

TEST(EventHub, LeavesAClientThatTakesNothing) {
  const Connection connection;
  EventHub hub(600ms);
  auto events = std::make_shared<ToldEvents>(std::string(12 << 20, 'a'));
  const std::weak_ptr<ToldEvents> kept = events;
  ASSERT_TRUE(hub.adopt(connection.server(), std::move(events)));
  for (int tries = 0; tries < 500 && !kept.expired(); ++tries) std::this_thread::sleep_for(20ms);
  EXPECT_TRUE(kept.expired()) << "its place is taken";
}

TEST(EventHub, StaysWithAClientThatTakesAllOrHasNothingToTake) {
  const Connection connection;
  EventHub hub(600ms);
  const auto events = std::make_shared<ToldEvents>("data: first\n\n");
  ASSERT_TRUE(hub.adopt(connection.server(), events));
  EXPECT_EQ(connection.read_up_to("first\n\n"), "data: first\n\n");
  std::this_thread::sleep_for(1500ms);
  events->tell("data: late\n\n");
  EXPECT_EQ(connection.read_up_to("late\n\n"), "data: late\n\n");
}

TEST(EventHub, GoesOnWithAClientThatSendsNoMore) {
  const Connection connection;
  EventHub hub(30s);
  const auto events = std::make_shared<ToldEvents>();
  ASSERT_TRUE(hub.adopt(connection.server(), events));
  ASSERT_EQ(::shutdown(connection.client(), SHUT_WR), 0);
  EXPECT_EQ(connection.read_up_to(":\n\n"), ":\n\n") << "a client that has closed would reset the connection";
  std::this_thread::sleep_for(500ms);
  events->tell("data: late\n\n");
  EXPECT_EQ(connection.read_up_to("late\n\n"), "data: late\n\n");
}

TEST(EventHub, LeavesAClientThatHasClosed) {
  const auto events = std::make_shared<ToldEvents>();
  EventHub hub(30s);
  {
    const Connection connection;
    ASSERT_TRUE(hub.adopt(connection.server(), events));
    events->tell("data: first\n\n");
    EXPECT_EQ(connection.read_up_to("first\n\n"), "data: first\n\n");
  }
  const auto start = std::chrono::steady_clock::now();
  while (events.use_count() > 1 && std::chrono::steady_clock::now() - start < 10s)
    std::this_thread::sleep_for(20ms);
  EXPECT_EQ(events.use_count(), 1) << "before it is told that nothing happens";
}

}  // namespace
