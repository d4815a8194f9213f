// SPDX-License-Identifier: Apache-2.0
#include "server/http/reception.h"

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

Reception::Reception(const Limits& limits, std::function<void(Arrival)> hand_over, std::function<std::string(const std::string&)> late_answer)
    : limits_(limits), hand_over_(std::move(hand_over)), late_answer_(std::move(late_answer)) {
  epoll_ = ::epoll_create1(EPOLL_CLOEXEC);
  bell_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (epoll_ >= 0 && bell_ >= 0 && watch(epoll_, bell_, this)) return;
  throw std::runtime_error("the system gives no files to wait for clients with (ulimit -n)");
}

Reception::~Reception() {
  ::close(epoll_);
  ::close(bell_);
}

void Reception::stop() {
  stopping_ = true;
  const std::uint64_t one = 1;
  static_cast<void>(!::write(bell_, &one, sizeof one));
}

bool Reception::run(int listening) {
  // A client that is gone before it is accepted is not to be waited for.
  bool good = ::fcntl(listening, F_SETFL, O_NONBLOCK) == 0 && watch(epoll_, listening, nullptr);
  while (good && !stopping_) {
    good = serve_events(listening);
    drop_late();
  }
  stop_accepting(listening);
  for (const auto end = Clock::now() + limits_.drain_time; good && !waiting_.empty() && Clock::now() < end;) good = serve_events(listening);
  while (!waiting_.empty()) drop(waiting_.begin());
  return good;
}

bool Reception::serve_events(int listening) {
  std::array<epoll_event, 64> events{};
  const int ready = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), patience_ms());
  if (ready < 0) return errno == EINTR;
  bool new_one = false;
  for (int i = 0; i < ready; ++i) {
    void* const what = events[static_cast<std::size_t>(i)].data.ptr;
    if (what == nullptr) new_one = true;
    else if (what != this) read_ready(static_cast<Arrival*>(what));
  }
  // After the others, since it may take the place of one of them.
  return !new_one || accept_next(listening);
}

bool Reception::accept_next(int listening) {
  const int socket = ::accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket < 0) {
    if (is_final(errno)) return false;
    if (errno == EINTR || errno == ECONNABORTED || errno == EAGAIN) return true;
    // No files or no memory: who has waited longest makes room.
    if (waiting_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    else drop(waiting_.begin());
    return true;
  }
  if (waiting_.size() >= limits_.most_waiting) drop(waiting_.begin());
  try {
    waiting_.push_back({.socket = socket, .received = {}});
  } catch (const std::bad_alloc&) {
    ::close(socket);
    return true;
  }
  // Most have sent their head by now.
  if (read_some(waiting_.back()) || !watch(epoll_, socket, &waiting_.back())) drop(std::prev(waiting_.end()));
  return true;
}

void Reception::read_ready(const Arrival* ready) {
  const auto arrival = std::ranges::find_if(waiting_, [&](const Arrival& one) { return &one == ready; });
  if (read_some(*arrival)) drop(arrival);
}

bool Reception::read_some(Arrival& arrival) {
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
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, arrival.socket, nullptr);
  hand_over_({.socket = std::exchange(arrival.socket, -1), .received = std::move(arrival.received), .since = arrival.since});
  return true;
}

void Reception::stop_accepting(int listening) {
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, listening, nullptr);
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, bell_, nullptr);
  ::close(listening);
  for (auto arrival = waiting_.begin(); arrival != waiting_.end();) {
    const auto next = std::next(arrival);
    if (arrival->received.empty()) drop(arrival);
    arrival = next;
  }
}

/// Who has begun is told why, as far as it takes that without waiting; there is nothing to answer to the others.
void Reception::drop_late() {
  while (!waiting_.empty() && waiting_.front().since + limits_.head_time <= Clock::now()) {
    const Arrival& late = waiting_.front();
    try {
      const std::string answer = late.received.empty() ? "" : late_answer_(late.received);
      static_cast<void>(::send(late.socket, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
      ::shutdown(late.socket, SHUT_WR);
    } catch (const std::bad_alloc&) {  // then without a word
    }
    drop(waiting_.begin());
  }
}

void Reception::drop(std::list<Arrival>::iterator arrival) {
  // Closing it takes it from epoll, too.
  if (arrival->socket >= 0) ::close(arrival->socket);
  waiting_.erase(arrival);
}

int Reception::patience_ms() const {
  constexpr int kAtMost = 100;
  if (waiting_.empty()) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(waiting_.front().since + limits_.head_time - Clock::now());
  return static_cast<int>(std::clamp<long>(left.count(), 0, kAtMost));
}

}  // namespace server
