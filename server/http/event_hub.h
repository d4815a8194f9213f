// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/messages/message.h"

namespace server {

/// Serves all event streams on one thread of its own: connections that stay open occupy no worker thread.
class EventHub {
 public:
  static constexpr std::size_t kMaxStreams = 64;

  /// @param stall_time  wait until a client takes more of its events, before its connection is closed
  explicit EventHub(std::chrono::milliseconds stall_time);
  ~EventHub();  ///< closes every connection
  EventHub(const EventHub&) = delete;
  EventHub& operator=(const EventHub&) = delete;

  /// Reserves one of kMaxStreams streams for these events, for as long as they exist. False if all are
  /// reserved.
  [[nodiscard]] bool reserve(const std::shared_ptr<EventSource>& events);

  /// Takes over the connection of events with a reservation; the head of the answer has been sent. Closes the
  /// connection at its end.
  /// @returns false without memory, or after stop(): the connection stays the caller's
  [[nodiscard]] bool adopt(int socket, std::shared_ptr<EventSource> events);

  /// Closes every connection; none is adopted afterwards.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  struct Stream {
    int socket;
    std::shared_ptr<EventSource> events;
    std::string unsent{};
    Clock::time_point last_taken{Clock::now()};  ///< by the client, or when what it does not take came
    bool client_has_shut = false;                ///< its half of the connection
  };

  void work(const std::stop_token& stop);
  /// Serves each stream once, without the lock.
  void serve_streams(std::unique_lock<std::mutex>& lock, const std::stop_token& stop);
  /// False when the connection is to be closed.
  bool serve(Stream& stream) const;
  /// Appends what is new to the text that is not sent. False if the client is gone or the events are lost.
  static bool append_next(Stream& stream);

  const std::chrono::milliseconds stall_time_;
  std::mutex mutex_;  // guards the rest but the thread
  std::condition_variable_any changed_;
  std::list<Stream> streams_;
  std::vector<std::weak_ptr<EventSource>> reserved_;
  bool stopped_ = false;
  std::jthread thread_;  // last: uses the rest
};

}  // namespace server
