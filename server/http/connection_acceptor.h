// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <string>

namespace server {

/// Accepted connection whose request has no complete head yet.
struct PendingConnection {
  int socket = -1;
  std::string received{};  ///< bytes so far
  std::chrono::steady_clock::time_point accepted{std::chrono::steady_clock::now()};
};

/// Accepts connections and keeps each until the head of its request is complete, on one thread with epoll:
/// clients that send nothing, or a byte now and then, occupy no worker thread.
class ConnectionAcceptor {
 public:
  /// Bounds of the heads; see HttpLimits.
  struct Limits {
    std::size_t head_bytes;
    std::chrono::milliseconds head_time;
    std::chrono::milliseconds drain_time;
    std::size_t max_pending = 2000;  ///< connections; a further one takes the place of the oldest
  };

  /// @param on_head               takes over a connection whose head is complete or too large; must not throw
  /// @param make_timeout_answer   answer to a client whose head is late, from the bytes received so far
  ConnectionAcceptor(const Limits& limits, std::function<void(PendingConnection)> on_head,
                     std::function<std::string(const std::string&)> make_timeout_answer);
  ~ConnectionAcceptor();
  ConnectionAcceptor(const ConnectionAcceptor&) = delete;
  ConnectionAcceptor& operator=(const ConnectionAcceptor&) = delete;

  /// Accepts on a listening socket until stop(), then closes it. Connections that have begun to send then
  /// have the drain time left.
  /// @returns false if accepting failed for good
  bool run(int listening);

  /// From any thread, also before run().
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  /// Waits for events and handles them. False if accepting has failed for good.
  bool serve_events(int listening);
  bool accept_next(int listening);
  void read_ready(const PendingConnection* ready);
  /// True if the acceptor has no more to do with the connection.
  bool read_some(PendingConnection& connection);
  void stop_accepting(int listening);
  void close_timed_out();
  void close(std::list<PendingConnection>::iterator connection);
  [[nodiscard]] int poll_timeout_ms() const;

  const Limits limits_;
  const std::function<void(PendingConnection)> on_head_;
  const std::function<std::string(const std::string&)> make_timeout_answer_;
  std::atomic<bool> stopping_ = false;
  int epoll_fd_ = -1;
  int wakeup_fd_ = -1;                    ///< eventfd, written by stop()
  std::list<PendingConnection> pending_;  ///< oldest first
};

}  // namespace server
