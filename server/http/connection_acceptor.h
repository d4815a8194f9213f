// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <string>

namespace server {

/// A connection whose client has begun to send.
struct PendingConnection {
  int socket = -1;
  std::string received{};  ///< so far
  std::chrono::steady_clock::time_point since{std::chrono::steady_clock::now()};  ///< when it was accepted
};

/// Accepts connections and keeps each until the head of its request has come, all on the thread that calls run(): clients that send nothing,
/// or a byte now and then, take no thread from those who serve.
class ConnectionAcceptor {
 public:
  /// How long, and how much, a head may take; see HttpLimits.
  struct Limits {
    std::size_t head_bytes;
    std::chrono::milliseconds head_time;
    std::chrono::milliseconds drain_time;
    std::size_t max_pending = 2000;  ///< connections; one more takes the place of the oldest
  };

  /// @param on_head    takes over a connection whose head has come or is too large; must not throw
  /// @param make_timeout_answer  to a client whose head has not come in time, from what it has sent
  ConnectionAcceptor(const Limits& limits, std::function<void(PendingConnection)> on_head, std::function<std::string(const std::string&)> make_timeout_answer);
  ~ConnectionAcceptor();
  ConnectionAcceptor(const ConnectionAcceptor&) = delete;
  ConnectionAcceptor& operator=(const ConnectionAcceptor&) = delete;

  /// Accepts on a listening socket, which it closes at the end, until stop(); then those that have begun to send have the drain time left.
  /// @returns false if accepting failed for good
  bool run(int listening);

  /// From any thread, also before run().
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  /// Waits for something to happen and sees to it. False if accepting has failed for good.
  bool serve_events(int listening);
  bool accept_next(int listening);
  void read_ready(const PendingConnection* ready);
  /// True if the connection is done with here.
  bool read_some(PendingConnection& arrival);
  void stop_accepting(int listening);
  void drop_late();
  void drop(std::list<PendingConnection>::iterator arrival);
  [[nodiscard]] int poll_timeout_ms() const;

  const Limits limits_;
  const std::function<void(PendingConnection)> on_head_;
  const std::function<std::string(const std::string&)> make_timeout_answer_;
  std::atomic<bool> stopping_ = false;
  int epoll_fd_ = -1;
  int wakeup_fd_ = -1;                ///< eventfd: rung by stop()
  std::list<PendingConnection> waiting_;   ///< oldest first
};

}  // namespace server
