// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "server/http/pending_connection.h"

namespace server {

/// Accepts connections, keeps each until the head of its request is complete, and closes each once its client
/// has, on one thread with epoll: clients that send nothing, a byte now and then, or stay when they have been
/// answered, occupy no worker thread.
class ConnectionAcceptor {
 public:
  /// Bounds of the heads; see HttpLimits.
  struct Limits {
    std::size_t head_bytes;
    std::chrono::milliseconds head_time;
    std::chrono::milliseconds linger_time;
    std::chrono::milliseconds drain_time;
    std::size_t max_pending = 2000;  ///< connections; a further one takes the place of the oldest of the peer
                                     ///< that has most of them
    std::size_t max_lingering = 1000;  ///< a further one takes the place of the oldest
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

  /// Lingering close (RFC 9112, section 9.6) of a connection that has been answered: reads and discards until
  /// the client has closed its end, so that it sees the whole answer; a plain close with unread bytes would
  /// reset the connection. From any thread.
  /// @returns false after run(), or without memory: the socket stays the caller's
  [[nodiscard]] bool linger(int socket) noexcept;

 private:
  using Clock = std::chrono::steady_clock;

  /// Connection that epoll watches.
  struct Watched {
    PendingConnection connection;
    bool lingering = false;
    std::list<Watched>::iterator self{};
  };
  using Place = std::list<Watched>::iterator;

  /// Waits for events and handles them. False if accepting has failed for good.
  bool serve_events(int listening);
  void serve_connection(Watched& watched);
  bool accept_next(int listening);
  /// Makes room where accepting has failed for want of it. False if it has failed for good.
  bool recover_from(int accept_error);
  void take_in(int socket, const sockaddr_storage& address);
  /// True if the acceptor has no more to do with the connection.
  bool read_some(PendingConnection& connection);
  bool discard_some(const PendingConnection& connection) const;
  void hand_over(PendingConnection& connection);
  [[nodiscard]] std::vector<int> take_sockets_to_linger();
  void watch_lingering();
  void stop_accepting(int listening);
  void close_timed_out();
  /// From now on no socket is taken over to linger.
  void close_all();
  void make_room(const std::string& peer);
  Place add(std::list<Watched>& to, PendingConnection connection);
  void close(Place connection);
  [[nodiscard]] int poll_timeout_ms() const;

  const Limits limits_;
  const std::function<void(PendingConnection)> on_head_;
  const std::function<std::string(const std::string&)> make_timeout_answer_;
  std::atomic<bool> stopping_ = false;
  int epoll_fd_ = -1;
  int wakeup_fd_ = -1;             ///< eventfd, written by stop() and linger()
  std::list<Watched> pending_;     ///< oldest first
  std::list<Watched> lingering_;   ///< oldest first; `accepted` is when it began to linger
  std::map<std::string, std::size_t> pending_of_peer_;
  std::mutex mutex_;               // guards the rest
  std::vector<int> to_linger_;     ///< sockets that the thread of run() has not taken yet
  bool running_ = true;            ///< whether there is, or may be, somebody who takes them
};

}  // namespace server
