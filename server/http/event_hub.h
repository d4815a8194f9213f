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

/// Carries all connections that stay open for events on one thread of its own, so that they take none from those who ask and go.
class EventHub {
 public:
  static constexpr std::size_t kPlaces = 64;

  EventHub();
  ~EventHub();  ///< closes every connection
  EventHub(const EventHub&) = delete;
  EventHub& operator=(const EventHub&) = delete;

  /// Gives these events a place, which is theirs for as long as they exist. False if there is none.
  [[nodiscard]] bool admit(const std::shared_ptr<EventSource>& events);

  /// Takes the connection of admitted events over, whose head has been sent, and closes it at the end.
  /// @returns false if there is no memory for it, or no connection is taken any more; it stays the caller's
  [[nodiscard]] bool take(int socket, std::shared_ptr<EventSource> events);

  /// Closes every connection, and those that come from now on.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  struct Stream {
    int socket;
    std::shared_ptr<EventSource> events;
    std::string unsent{};
    Clock::time_point last_sent{Clock::now()};
  };

  void work(const std::stop_token& stop);
  /// False when the connection is done with.
  static bool serve(Stream& stream);

  std::mutex mutex_;  // guards all but the thread
  std::condition_variable_any changed_;
  std::list<Stream> streams_;
  std::vector<std::weak_ptr<EventSource>> admitted_;
  bool stopped_ = false;
  std::jthread thread_;  // last: uses the rest
};

}  // namespace server
