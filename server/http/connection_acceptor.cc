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
  return accept_error == EBADF || accept_error == EINVAL || accept_error == ENOTSOCK || accept_error == EOPNOTSUPP || accept_error == EFAULT;
}

/// @param what  what epoll gives back when the socket has something to read; null: the listening socket
bool watch(int epoll, int socket, void* what) {
  epoll_event event{};
  event.events = EPOLLIN | EPOLLRDHUP;
  event.data.ptr = what;
  return ::epoll_ctl(epoll, EPOLL_CTL_ADD, socket, &event) == 0;
}

}  // namespace

ConnectionAcceptor::ConnectionAcceptor(const Limits& limits, std::function<void(PendingConnection)> on_head, std::function<std::string(const std::string&)> make_timeout_answer)
    : limits_(limits), on_head_(std::move(on_head)), make_timeout_answer_(std::move(make_timeout_answer)) {
  epoll_fd_ = ::epoll_create1(EPOLL_CLOEXEC);
  wakeup_fd_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (epoll_fd_ >= 0 && wakeup_fd_ >= 0 && watch(epoll_fd_, wakeup_fd_, this)) return;
  throw std::runtime_error("the system gives no files to wait for clients with (ulimit -n)");
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
  // A client that is gone before it is accepted is not to be waited for.
  bool good = ::fcntl(listening, F_SETFL, O_NONBLOCK) == 0 && watch(epoll_fd_, listening, nullptr);
  while (good && !stopping_) {
    good = serve_events(listening);
    drop_late();
  }
  stop_accepting(listening);
  for (const auto end = Clock::now() + limits_.drain_time; good && !waiting_.empty() && Clock::now() < end;) good = serve_events(listening);
  while (!waiting_.empty()) drop(waiting_.begin());
  return good;
}

bool ConnectionAcceptor::serve_events(int listening) {
  std::array<epoll_event, 64> events{};
  const int ready = ::epoll_wait(epoll_fd_, events.data(), static_cast<int>(events.size()), poll_timeout_ms());
  if (ready < 0) return errno == EINTR;
  bool new_one = false;
  for (int i = 0; i < ready; ++i) {
    void* const what = events[static_cast<std::size_t>(i)].data.ptr;
    if (what == nullptr) new_one = true;
    else if (what != this) read_ready(static_cast<PendingConnection*>(what));
  }
  // After the others, since it may take the place of one of them.
  return !new_one || accept_next(listening);
}

bool ConnectionAcceptor::accept_next(int listening) {
  const int socket = ::accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket < 0) {
    if (is_final(errno)) return false;
    if (errno == EINTR || errno == ECONNABORTED || errno == EAGAIN) return true;
    // No files or no memory: who has waited longest makes room.
    if (waiting_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    else drop(waiting_.begin());
    return true;
  }
  if (waiting_.size() >= limits_.max_pending) drop(waiting_.begin());
  try {
    waiting_.push_back({.socket = socket, .received = {}});
  } catch (const std::bad_alloc&) {
    ::close(socket);
    return true;
  }
  // Most have sent their head by now.
  if (read_some(waiting_.back()) || !watch(epoll_fd_, socket, &waiting_.back())) drop(std::prev(waiting_.end()));
  return true;
}

void ConnectionAcceptor::read_ready(const PendingConnection* ready) {
  const auto arrival = std::ranges::find_if(waiting_, [&](const PendingConnection& one) { return &one == ready; });
  if (read_some(*arrival)) drop(arrival);
}

bool ConnectionAcceptor::read_some(PendingConnection& arrival) {
  std::array<char, kBytesAtATime> bytes;
  const ssize_t got = ::recv(arrival.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got < 0) return errno != EAGAIN && errno != EINTR;
  if (got == 0) return true;  // closed, without a whole head
  try {
    // The empty line may straddle two reads.
    const std::size_t searched = arrival.received.size() < kEndOfHead.size() ? 0 : arrival.received.size() - kEndOfHead.size() + 1;
    arrival.received.append(bytes.data(), static_cast<std::size_t>(got));
    const bool complete = arrival.received.find(kEndOfHead, searched) != std::string::npos;
    if (!complete && arrival.received.size() <= limits_.head_bytes) return false;
  } catch (const std::bad_alloc&) {
    return true;
  }
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, arrival.socket, nullptr);
  on_head_({.socket = std::exchange(arrival.socket, -1), .received = std::move(arrival.received), .since = arrival.since});
  return true;
}

void ConnectionAcceptor::stop_accepting(int listening) {
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, listening, nullptr);
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, wakeup_fd_, nullptr);
  ::close(listening);
  for (auto arrival = waiting_.begin(); arrival != waiting_.end();) {
    const auto next = std::next(arrival);
    if (arrival->received.empty()) drop(arrival);
    arrival = next;
  }
}

/// Who has begun is told why, as far as it takes that without waiting; there is nothing to answer to the others.
void ConnectionAcceptor::drop_late() {
  while (!waiting_.empty() && waiting_.front().since + limits_.head_time <= Clock::now()) {
    const PendingConnection& late = waiting_.front();
    try {
      const std::string answer = late.received.empty() ? "" : make_timeout_answer_(late.received);
      static_cast<void>(::send(late.socket, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
      ::shutdown(late.socket, SHUT_WR);
    } catch (const std::bad_alloc&) {  // then without a word
    }
    drop(waiting_.begin());
  }
}

void ConnectionAcceptor::drop(std::list<PendingConnection>::iterator arrival) {
  // Closing it takes it from epoll, too.
  if (arrival->socket >= 0) ::close(arrival->socket);
  waiting_.erase(arrival);
}

int ConnectionAcceptor::poll_timeout_ms() const {
  constexpr int kAtMost = 100;
  if (waiting_.empty()) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(waiting_.front().since + limits_.head_time - Clock::now());
  return static_cast<int>(std::clamp<long>(left.count(), 0, kAtMost));
}

}  // namespace server
