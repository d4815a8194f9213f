// SPDX-License-Identifier: Apache-2.0
#include "server/http/connection_acceptor.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <new>
#include <span>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

namespace server {

namespace {

constexpr std::size_t kBytesAtATime = 16 * 1024;
constexpr std::string_view kEndOfHead = "\r\n\r\n";

/// @returns whether accepting has failed for good, and not for this connection or for want of files or memory
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

/// See PendingConnection::peer.
std::string peer_of(const sockaddr_storage& address) {
  std::array<char, sizeof(sockaddr_in6)> bytes{};
  if (address.ss_family == AF_INET) {
    std::memcpy(bytes.data(), &reinterpret_cast<const sockaddr_in&>(address).sin_addr, 4);
    return {bytes.data(), 4};
  }
  std::memcpy(bytes.data(), &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, 8);
  return {bytes.data(), 8};
}

/// @param source  as add_to_epoll() has it
bool has_event_of(std::span<const epoll_event> events, const void* source) {
  return std::ranges::any_of(events, [&](const epoll_event& event) { return event.data.ptr == source; });
}

/// Appends bytes of a head to those that came before. True if the head is complete.
bool append_to_head(std::string& received, std::string_view bytes) {
  // The empty line may straddle two reads.
  const std::size_t searched =
      received.size() < kEndOfHead.size() ? 0 : received.size() - kEndOfHead.size() + 1;
  received.append(bytes);
  // Line ends before the request line are skipped (RFC 9112, section 2.2).
  if (searched == 0) {
    while (received.starts_with("\r\n")) received.erase(0, 2);
  }
  return received.find(kEndOfHead, searched) != std::string::npos;
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
  for (const int socket : to_linger_) ::close(socket);
  ::close(epoll_fd_);
  ::close(wakeup_fd_);
}

void ConnectionAcceptor::stop() {
  stopping_ = true;
  const std::uint64_t one = 1;
  static_cast<void>(!::write(wakeup_fd_, &one, sizeof one));
}

bool ConnectionAcceptor::linger(int socket) noexcept {
  ::shutdown(socket, SHUT_WR);
  try {
    const std::lock_guard lock(mutex_);
    if (!running_) return false;
    to_linger_.push_back(socket);
  } catch (const std::bad_alloc&) {
    return false;
  }
  const std::uint64_t one = 1;
  static_cast<void>(!::write(wakeup_fd_, &one, sizeof one));
  return true;
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
  while (good && !(pending_.empty() && lingering_.empty()) && Clock::now() < drain_deadline) {
    good = serve_events(listening);
    close_timed_out();
  }
  close_all();
  return good;
}

bool ConnectionAcceptor::serve_events(int listening) {
  std::array<epoll_event, 64> events{};
  const int ready =
      ::epoll_wait(epoll_fd_, events.data(), static_cast<int>(events.size()), poll_timeout_ms());
  if (ready < 0) return errno == EINTR;
  const auto happened = std::span<const epoll_event>(events).first(static_cast<std::size_t>(ready));
  for (const epoll_event& event : happened) {
    void* const source = event.data.ptr;
    if (source != nullptr && source != this) serve_connection(*static_cast<Watched*>(source));
  }
  // Last, since both may close one of the connections that have events.
  if (has_event_of(happened, this)) watch_lingering();
  return !has_event_of(happened, nullptr) || accept_next(listening);
}

void ConnectionAcceptor::serve_connection(Watched& watched) {
  if (watched.lingering ? discard_some(watched.connection) : read_some(watched.connection))
    close(watched.self);
}

bool ConnectionAcceptor::accept_next(int listening) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  const int socket = ::accept4(listening, reinterpret_cast<sockaddr*>(&address), &size, SOCK_CLOEXEC);
  if (socket < 0) return recover_from(errno);
  take_in(socket, address);
  return true;
}

bool ConnectionAcceptor::recover_from(int accept_error) {
  if (is_final(accept_error)) return false;
  if (accept_error == EINTR || accept_error == ECONNABORTED || accept_error == EAGAIN) return true;
  // No descriptors or no memory: the oldest connection is closed to free some, first one that is answered.
  if (!lingering_.empty()) close(lingering_.begin());
  else if (!pending_.empty()) close(pending_.begin());
  else std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return true;
}

void ConnectionAcceptor::take_in(int socket, const sockaddr_storage& address) {
  Place place;
  try {
    std::string peer = peer_of(address);
    if (pending_.size() >= limits_.max_pending) make_room(peer);
    place = add(pending_, {.socket = socket, .received = {}, .peer = std::move(peer)});
  } catch (const std::bad_alloc&) {
    ::close(socket);
    return;
  }
  // Most clients have sent their head by now.
  if (read_some(place->connection) || !add_to_epoll(epoll_fd_, socket, &*place)) close(place);
}

/// Closes the oldest connection of the peer that has most of them; of equals, that of the new one.
void ConnectionAcceptor::make_room(const std::string& peer) {
  auto most = pending_of_peer_.find(peer);
  for (auto each = pending_of_peer_.begin(); each != pending_of_peer_.end(); ++each)
    if (most == pending_of_peer_.end() || each->second > most->second) most = each;
  const auto oldest = std::ranges::find_if(
      pending_, [&](const Watched& each) { return each.connection.peer == most->first; });
  if (oldest != pending_.end()) close(oldest);
}

ConnectionAcceptor::Place ConnectionAcceptor::add(std::list<Watched>& to, PendingConnection connection) {
  const bool lingering = &to == &lingering_;
  std::size_t* const count = lingering ? nullptr : &pending_of_peer_[connection.peer];
  to.push_back({.connection = std::move(connection), .lingering = lingering});
  if (count != nullptr) ++*count;
  to.back().self = std::prev(to.end());
  return to.back().self;
}

bool ConnectionAcceptor::read_some(PendingConnection& connection) {
  std::array<char, kBytesAtATime> bytes;
  const ssize_t got = ::recv(connection.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got < 0) return errno != EAGAIN && errno != EINTR;
  if (got == 0) return true;  // closed, without a whole head
  try {
    std::string& received = connection.received;
    const bool complete = append_to_head(received, {bytes.data(), static_cast<std::size_t>(got)});
    if (!complete && received.size() <= limits_.head_bytes) return false;
  } catch (const std::bad_alloc&) {
    return true;
  }
  hand_over(connection);
  return true;
}

void ConnectionAcceptor::hand_over(PendingConnection& connection) {
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, connection.socket, nullptr);
  on_head_({.socket = std::exchange(connection.socket, -1),
            .received = std::move(connection.received),
            .accepted = connection.accepted,
            .peer = connection.peer});
}

bool ConnectionAcceptor::discard_some(const PendingConnection& connection) const {
  std::array<char, kBytesAtATime> bytes;
  const ssize_t got = ::recv(connection.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  return got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

std::vector<int> ConnectionAcceptor::take_sockets_to_linger() {
  std::uint64_t wakeups = 0;
  static_cast<void>(!::read(wakeup_fd_, &wakeups, sizeof wakeups));
  const std::lock_guard lock(mutex_);
  return std::exchange(to_linger_, {});
}

void ConnectionAcceptor::watch_lingering() {
  for (const int socket : take_sockets_to_linger()) {
    if (lingering_.size() >= limits_.max_lingering) close(lingering_.begin());
    try {
      const Place place = add(lingering_, {.socket = socket, .received = {}});
      // Most clients have closed their end by now.
      if (discard_some(place->connection) || !add_to_epoll(epoll_fd_, socket, &*place)) close(place);
    } catch (const std::bad_alloc&) {
      ::close(socket);
    }
  }
}

void ConnectionAcceptor::stop_accepting(int listening) {
  ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, listening, nullptr);
  ::close(listening);
  for (auto each = pending_.begin(); each != pending_.end();) {
    const auto next = std::next(each);
    if (each->connection.received.empty()) close(each);
    each = next;
  }
}

/// A client that has begun to send gets the timeout answer, as far as its socket takes it at once.
void ConnectionAcceptor::close_timed_out() {
  const auto now = Clock::now();
  while (!pending_.empty() && pending_.front().connection.accepted + limits_.head_time <= now) {
    const PendingConnection& late = pending_.front().connection;
    try {
      const std::string answer = late.received.empty() ? "" : make_timeout_answer_(late.received);
      static_cast<void>(::send(late.socket, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
      ::shutdown(late.socket, SHUT_WR);
    } catch (const std::bad_alloc&) {  // closed without an answer
    }
    close(pending_.begin());
  }
  while (!lingering_.empty() && lingering_.front().connection.accepted + limits_.linger_time <= now)
    close(lingering_.begin());
}

void ConnectionAcceptor::close_all() {
  {
    const std::lock_guard lock(mutex_);
    running_ = false;
  }
  watch_lingering();
  for (std::list<Watched>* const list : {&pending_, &lingering_})
    while (!list->empty()) close(list->begin());
}

void ConnectionAcceptor::close(Place place) {
  const PendingConnection& connection = place->connection;
  // close() alone would leave the socket in epoll as long as a process that is being started has a copy of
  // it.
  if (connection.socket >= 0) {
    ::epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, connection.socket, nullptr);
    ::close(connection.socket);
  }
  if (place->lingering) {
    lingering_.erase(place);
    return;
  }
  const auto count = pending_of_peer_.find(connection.peer);
  if (count != pending_of_peer_.end() && --count->second == 0) pending_of_peer_.erase(count);
  pending_.erase(place);
}

int ConnectionAcceptor::poll_timeout_ms() const {
  constexpr int kAtMost = 100;
  if (pending_.empty() && lingering_.empty()) return -1;
  auto deadline = Clock::time_point::max();
  if (!pending_.empty()) deadline = pending_.front().connection.accepted + limits_.head_time;
  if (!lingering_.empty())
    deadline = std::min(deadline, lingering_.front().connection.accepted + limits_.linger_time);
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  return static_cast<int>(std::clamp<long>(left.count(), 0, kAtMost));
}

}  // namespace server
