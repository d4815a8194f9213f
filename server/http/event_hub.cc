// SPDX-License-Identifier: Apache-2.0
#include "server/http/event_hub.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>
#include <new>
#include <utility>

#include "server/messages/safe_log.h"

namespace server {

namespace {

constexpr std::chrono::milliseconds kPollInterval{200};
constexpr std::chrono::seconds kKeepAliveInterval{15};      // proxies and browsers close silent connections
constexpr std::size_t kMaxUnsentBytes = 16 * 1024 * 1024;  // of a client that does not read
constexpr const char* kComment = ":\n\n";                  // means nothing to the client

enum class ClientEnd { kOpen, kShut, kBroken };

/// State of the client's end. Bytes that the client sends are not looked at.
ClientEnd look_at_end(int socket) {
  std::array<char, 1024> ignored;  // unread bytes would make close() reset the connection
  static_cast<void>(::recv(socket, ignored.data(), ignored.size(), MSG_DONTWAIT));
  // After the end of what the client sends, recv() does not tell of a connection that is reset.
  pollfd entry{socket, POLLRDHUP, 0};
  if (::poll(&entry, 1, 0) <= 0) return ClientEnd::kOpen;
  return (entry.revents & (POLLERR | POLLHUP)) != 0 ? ClientEnd::kBroken : ClientEnd::kShut;
}

/// Sends as much as the socket takes at once. False if the client is gone.
bool send_some(int socket, std::string& text) {
  while (!text.empty()) {
    const ssize_t sent = ::send(socket, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    text.erase(0, static_cast<std::size_t>(sent));
  }
  return true;
}

}  // namespace

EventHub::EventHub(std::chrono::milliseconds stall_time)
    : stall_time_(stall_time), thread_([this](const std::stop_token& stop) { work(stop); }) {}

EventHub::~EventHub() { stop(); }

bool EventHub::reserve(const std::shared_ptr<EventSource>& events) {
  const std::lock_guard lock(mutex_);
  std::erase_if(reserved_, [](const auto& each) { return each.expired(); });
  if (stopped_ || reserved_.size() >= kMaxStreams) return false;
  reserved_.push_back(events);
  return true;
}

bool EventHub::adopt(int socket, std::shared_ptr<EventSource> events) try {
  const std::lock_guard lock(mutex_);
  if (stopped_) return false;
  streams_.push_back({.socket = socket, .events = std::move(events)});
  changed_.notify_all();
  return true;
} catch (const std::bad_alloc&) {
  return false;
}

void EventHub::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void EventHub::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    changed_.wait(lock, stop, [this] { return !streams_.empty(); });
    serve_streams(lock, stop);
    changed_.wait_for(lock, stop, kPollInterval, [] { return false; });
  }
  for (const Stream& stream : streams_) ::close(stream.socket);
  streams_.clear();
}

void EventHub::serve_streams(std::unique_lock<std::mutex>& lock, const std::stop_token& stop) {
  // Other threads only append streams; only this thread removes them.
  for (auto stream = streams_.begin(); stream != streams_.end() && !stop.stop_requested();) {
    lock.unlock();
    const bool goes_on = serve(*stream);
    if (!goes_on) ::close(stream->socket);
    lock.lock();
    stream = goes_on ? std::next(stream) : streams_.erase(stream);
  }
}

bool EventHub::serve(Stream& stream) const {
  const auto now = Clock::now();
  const bool all_was_sent = stream.unsent.empty();
  if (!append_next(stream)) return false;
  if (stream.unsent.empty() && now - stream.last_taken > kKeepAliveInterval) stream.unsent = kComment;
  const std::size_t offered = stream.unsent.size();
  if (offered > kMaxUnsentBytes || !send_some(stream.socket, stream.unsent)) return false;
  if (offered > 0 && (all_was_sent || stream.unsent.size() < offered)) stream.last_taken = now;
  if (stream.unsent.empty()) return !stream.events->has_ended();
  return now - stream.last_taken < stall_time_;
}

bool EventHub::append_next(Stream& stream) {
  const ClientEnd end = look_at_end(stream.socket);
  if (end == ClientEnd::kBroken) return false;
  try {
    if (!stream.events->has_ended()) stream.unsent += stream.events->next();
    // A client that sends no more may read on (RFC 9293, section 3.6). One that has closed resets the
    // connection when it is sent something.
    if (end == ClientEnd::kShut && !std::exchange(stream.client_has_shut, true)) stream.unsent += kComment;
  } catch (const std::exception& error) {  // of the store; the client reconnects with its Last-Event-ID
    log_error("events end early: {}", error.what());
    return false;
  }
  return true;
}

}  // namespace server
