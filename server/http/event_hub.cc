// SPDX-License-Identifier: Apache-2.0
#include "server/http/event_hub.h"

#include <sys/socket.h>
#include <unistd.h>

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

/// @returns whether the client has closed its end. Bytes that the client sends are not looked at.
bool is_closed(int socket) {
  char byte = 0;
  const ssize_t got = ::recv(socket, &byte, 1, MSG_DONTWAIT);
  return got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
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

EventHub::EventHub() : thread_([this](const std::stop_token& stop) { work(stop); }) {}

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

bool EventHub::serve(Stream& stream) {
  try {
    if (is_closed(stream.socket)) return false;
    if (!stream.events->has_ended()) stream.unsent += stream.events->next();
  } catch (const std::exception& error) {  // of the store; the client reconnects with its Last-Event-ID
    log_error("events end early: {}", error.what());
    return false;
  }
  if (stream.unsent.empty() && Clock::now() - stream.last_sent > kKeepAliveInterval) stream.unsent = ":\n\n";
  if (stream.unsent.size() > kMaxUnsentBytes) return false;
  if (!stream.unsent.empty()) stream.last_sent = Clock::now();
  return send_some(stream.socket, stream.unsent) && !(stream.unsent.empty() && stream.events->has_ended());
}

}  // namespace server
