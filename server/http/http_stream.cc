// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_stream.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace server {

namespace {

constexpr std::size_t kReadBytes = 16 * 1024;
// Ending the server is noticed within this time by a connection that waits.
constexpr std::chrono::milliseconds kPollSlice{100};

/// Chunked bodies carry a size line a chunk: this much more than the body itself may come off the wire.
std::size_t raw_body_limit(std::size_t body_bytes) { return 2 * body_bytes + 64 * 1024; }

template <typename NameOf>
void read_address(NameOf name_of, int socket, std::string& ip, int& port) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (name_of(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return;
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &address, sizeof v4);
    inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
    port = ntohs(v4.sin_port);
  } else if (address.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &address, sizeof v6);
    inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
    port = ntohs(v6.sin6_port);
  }
  ip = text.data();
}

}  // namespace

HttpStream::HttpStream(PendingConnection connection, const HttpLimits& limits,
                       const std::atomic<bool>& draining, const std::atomic<int>& queued)
    : socket_(connection.socket),
      limits_(limits),
      draining_(draining),
      queued_(queued),
      buffer_(std::move(connection.received)),
      body_limit_(limits.body_bytes),
      read_deadline_(connection.accepted + limits.head_time),
      crowded_deadline_(Clock::now() + limits.crowded_time) {}

HttpStream::Head HttpStream::read_head() {
  for (std::size_t searched = 0;;) {
    const auto end = buffer_.find("\r\n\r\n", searched);
    if (end != std::string::npos && end + 4 <= limits_.head_bytes) {
      complete_head(end + 4);
      return Head::kComplete;
    }
    if (buffer_.size() > limits_.head_bytes) return Head::kTooLarge;
    const std::size_t old_size = buffer_.size();
    const ssize_t got = receive_more();
    if (got == 0 || (got < 0 && buffer_.empty())) return Head::kClosed;
    if (got < 0) return Head::kTooSlow;
    // The empty line may straddle two reads.
    searched = old_size < 3 ? 0 : old_size - 3;
  }
}

void HttpStream::complete_head(std::size_t size) {
  head_size_ = size;
  read_deadline_ = Clock::now() + limits_.body_time;
  crowded_deadline_ = Clock::now() + limits_.crowded_time;
}

ssize_t HttpStream::receive_more() {
  const std::size_t old_size = buffer_.size();
  buffer_.resize(old_size + kReadBytes);
  const ssize_t got = receive(buffer_.data() + old_size, kReadBytes, read_deadline_);
  buffer_.resize(old_size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return got;
}

void HttpStream::replace_head(const std::string& head) {
  buffer_.replace(0, head_size_, head);
  head_size_ = head.size();
}

void HttpStream::allow_body(std::size_t bytes) {
  body_limit_ = bytes;
  if (bytes <= limits_.body_bytes) return;
  const double times = static_cast<double>(bytes) / static_cast<double>(limits_.body_bytes);
  read_deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(times * limits_.body_time);
}

void HttpStream::send_continue() {
  if (!std::exchange(expects_continue_, false)) return;
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  // The first bytes of a connection: its socket has room for them.
  static_cast<void>(::send(socket_, kContinue.data(), kContinue.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
}

bool HttpStream::send_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = write(text.data(), text.size());
    if (sent <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

void HttpStream::lingering_close() {
  ::shutdown(socket_, SHUT_WR);
  const auto deadline = Clock::now() + limits_.linger_time;
  crowded_deadline_ = Clock::now() + limits_.crowded_time;
  std::array<char, kReadBytes> unread;
  while (receive(unread.data(), unread.size(), deadline) > 0) {
  }
}

bool HttpStream::is_readable() const {
  return consumed_ < buffer_.size() || wait_for(POLLIN, read_deadline_);
}

bool HttpStream::is_writable() const { return wait_for(POLLOUT, write_deadline()); }

ssize_t HttpStream::take_buffered(char* to, std::size_t size) {
  const std::size_t n = std::min(size, buffer_.size() - consumed_);
  std::memcpy(to, buffer_.data() + consumed_, n);
  consumed_ += n;
  return static_cast<ssize_t>(n);
}

ssize_t HttpStream::read(char* to, std::size_t size) {
  if (consumed_ < buffer_.size()) return take_buffered(to, size);
  if (raw_body_bytes_ > raw_body_limit(body_limit_)) return -1;
  // httplib reads chunk sizes a byte at a time: one system call each would be a burden.
  buffer_.clear();
  const ssize_t got = receive_more();
  consumed_ = 0;
  head_size_ = 0;
  raw_body_bytes_ += buffer_.size();
  return got <= 0 ? got : read(to, size);
}

ssize_t HttpStream::write(const char* from, std::size_t size) {
  const auto start = Clock::now();
  if (!write_start_) write_start_ = start;
  const auto deadline = write_deadline();
  while (wait_for(POLLOUT, deadline)) {
    const ssize_t sent = ::send(socket_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0) {
      sent_bytes_ += static_cast<std::size_t>(sent);
      waited_ += Clock::now() - start;
      return sent;
    }
    if (errno != EAGAIN && errno != EINTR) return -1;
  }
  return -1;
}

void HttpStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  read_address(::getpeername, socket_, ip, port);
}

void HttpStream::get_local_ip_and_port(std::string& ip, int& port) const {
  read_address(::getsockname, socket_, ip, port);
}

bool HttpStream::wait_for(short events, Clock::time_point deadline) const {
  const auto start = Clock::now();
  for (;;) {
    const auto now = Clock::now();
    if (draining_ && !drain_deadline_) drain_deadline_ = now + limits_.drain_time;
    auto end = drain_deadline_ ? std::min(deadline, *drain_deadline_) : deadline;
    // A few slow clients are tolerated; while connections queue, no slow client keeps its thread.
    if (queued_ > 0) end = std::min(end, events == POLLIN ? crowded_deadline_ : start + limits_.crowded_time);
    if (now >= end) return false;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
    pollfd entry{socket_, events, 0};
    const int ready = ::poll(&entry, 1, static_cast<int>(std::min(left, kPollSlice).count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

HttpStream::Clock::time_point HttpStream::write_deadline() const {
  const auto now = Clock::now();
  const auto earned = [this](std::size_t bytes_per_s) {
    return std::chrono::milliseconds(1000 * sent_bytes_ / bytes_per_s);
  };
  return std::min(write_start_.value_or(now) + limits_.response_time + earned(limits_.response_bytes_per_s),
                  now + limits_.stall_time + earned(limits_.least_bytes_per_s) - waited_);
}

ssize_t HttpStream::receive(char* to, std::size_t size, Clock::time_point deadline) const {
  while (wait_for(POLLIN, deadline)) {
    const ssize_t got = ::recv(socket_, to, size, MSG_DONTWAIT);
    if (got >= 0) return got;
    if (errno != EAGAIN && errno != EINTR) return -1;
  }
  return -1;
}

}  // namespace server
