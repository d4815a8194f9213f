// SPDX-License-Identifier: Apache-2.0
#include "server/http/connection_acceptor.h"

#include <fcntl.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

namespace server {

namespace {

constexpr std::size_t kBytesAtATime = 16 * 1024;
constexpr std::string_view kEndOfHead = "\r\n\r\n";

/// Whether accepting has failed for good, and not for this connection or for want of files or memory.
bool is_final(int accept_error) {
  return accept_error == EBADF || accept_error == EINVAL || accept_error == ENOTSOCK ||
         accept_error == EOPNOTSUPP || accept_error == EFAULT;
}

/// Adds a descriptor to those that epoll watches.
/// @param source  pointer that epoll returns with the descriptor's events; null: the listening socket
bool add_to_epoll(int epoll_fd, int descriptor, void* source) {
  epoll_event event{};
  event.events = EPOLLIN | EPOLLRDHUP;
  event.data.ptr = source;
  return ::epoll_ctl(epoll_fd, EPOLL_CTL_ADD, descriptor, &event) == 0;
}

}  // namespace

ConnectionAcceptor::ConnectionAcceptor(const Limits& limits, std::function<void(PendingConnection)> on_head,
                                       std::function<std::string(const std::string&)> make_timeout_answer)
    : limits_(limits), on_head_(std::move(on_head)), make_timeout_answer_(std::move(make_timeout_answer)) {
  epoll_fd_ = ::epoll_create1(EPOLL_CLOEXEC);
  wakeup_fd_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (epoll_fd_ >= 0 && wakeup_fd_ >= 0 && add_to_epoll(epoll_fd_, wakeup_fd_, this)) return;
  throw std::runtime_error(
      "the system has no file descriptors left to wait for clients with: raise its limit (ulimit -n)");
}

ConnectionAcceptor::~ConnectionAcceptor() {
  ::close(epoll_fd_);
  ::close(wakeup_fd_);
}

void ConnectionAcceptor::stop() {
  stopping_ = true;
  const std::uint64_t one = 1;
  static_cast<void>(!::write(wakeup_fd_, &one, sizeof one));
}

bool ConnectionAcceptor::run(int listening) {
  // Non-blocking: accept() would wait if the client has gone since epoll reported it.
  bool good = ::fcntl(listening, F_SETFL, O_NONBLOCK) == 0 && add_to_epoll(epoll_fd_, listening, nullptr);
  while (good && !stopping_) {
    good = serve_events(listening);
    close_timed_out();
  }
  stop_accepting(listening);
  const auto drain_deadline = Clock::now() + limits_.drain_time;
  while (good && !pending_.empty() && Clock::now() < drain_deadline) {
    good = serve_events(listening);
    close_timed_out();
  }
  while (!pending_.empty()) close(pending_.begin());
  return good;
}

bool ConnectionAcceptor::serve_events(int listening) {
  std::array<epoll_event, 64> events{};
  const int ready =
      ::epoll_wait(epoll_fd_, events.data(), static_cast<int>(events.size()), poll_timeout_ms());
  if (ready < 0) return errno == EINTR;
  bool new_connection = false;
  for (int i = 0; i < ready; ++i) {
    void* const source = events[static_cast<std::size_t>(i)].data.ptr;
    if (source == nullptr) new_connection = true;
    else if (source != this) read_ready(static_cast<PendingConnection*>(source));
  }
  // Last, since accepting may close one of the connections that have events.
  return !new_connection || accept_next(listening);
}

bool ConnectionAcceptor::accept_next(int listening) {
  const int socket = ::accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket < 0) {
    if (is_final(errno)) return false;
    if (errno == EINTR || errno == ECONNABORTED || errno == EAGAIN) return true;
    // No descriptors or no memory: the oldest pending connection is closed to free some.
    if (pending_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    else close(pending_.begin());
    return true;
  }
  if (pending_.size() >= limits_.max_pending) close(pending_.begin());
  try {
    pending_.push_back({.socket = socket, .received = {}});
  } catch (const std::bad_alloc&) {
    ::close(socket);
    return true;
  }
  // Most clients have sent their head by now.
  if (read_some(pending_.back()) || !add_to_epoll(epoll_fd_, socket, &pending_.back()))
    close(std::prev(pending_.end()));
  return true;
}

void ConnectionAcceptor::read_ready(const PendingConnection* ready) {
  const auto connection =
      std::ranges::find_if(pending_, [&](const PendingConnection& each) { return &each == ready; });
  if (read_some(*connection)) close(connection);
}

bool ConnectionAcceptor::read_some(PendingConnection& connection) {
  std::array<char, kBytesAtATime> bytes;
  const ssize_t got = ::recv(connection.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got < 0) return errno != EAGAIN && errno != EINTR;
  if (got == 0) return true;  // closed, without a whole head
  try {
    // The empty line may straddle two reads.
    std::string& received = connection.received;
    const std::size_t searched =
        received.size() < kEndOfHead.size() ? 0 : received.size() - kEndOfHead.size() + 1;
    received.append(bytes.data(), static_cast<std::size_t>(got));
    const bool complete = received.find(kEndOfHead, searched) != std::string::npos;
    if (!complete && received.size() <= limits_.head_bytes) return false;
  } catch (const std::bad_alloc&) {
    return true;
  }
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, connection.socket, nullptr);
  on_head_({.socket = std::exchange(connection.socket, -1),
            .received = std::move(connection.received),
            .accepted = connection.accepted});
  return true;
}

void ConnectionAcceptor::stop_accepting(int listening) {
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, listening, nullptr);
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, wakeup_fd_, nullptr);
  ::close(listening);
  for (auto connection = pending_.begin(); connection != pending_.end();) {
    const auto next = std::next(connection);
    if (connection->received.empty()) close(connection);
    connection = next;
  }
}

/// A client that has begun to send gets the timeout answer, as far as its socket takes it at once.
void ConnectionAcceptor::close_timed_out() {
  while (!pending_.empty() && pending_.front().accepted + limits_.head_time <= Clock::now()) {
    const PendingConnection& late = pending_.front();
    try {
      const std::string answer = late.received.empty() ? "" : make_timeout_answer_(late.received);
      static_cast<void>(::send(late.socket, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
      ::shutdown(late.socket, SHUT_WR);
    } catch (const std::bad_alloc&) {  // closed without an answer
    }
    close(pending_.begin());
  }
}

void ConnectionAcceptor::close(std::list<PendingConnection>::iterator connection) {
  // close() also removes the socket from epoll.
  if (connection->socket >= 0) ::close(connection->socket);
  pending_.erase(connection);
}

int ConnectionAcceptor::poll_timeout_ms() const {
  constexpr int kAtMost = 100;
  if (pending_.empty()) return -1;
  const auto deadline = pending_.front().accepted + limits_.head_time;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  return static_cast<int>(std::clamp<long>(left.count(), 0, kAtMost));
}

}  // namespace server
