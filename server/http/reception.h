// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <string>

namespace server {

/// A connection whose client has begun to send.
struct Arrival {
  int socket = -1;
  std::string received{};  ///< so far
  std::chrono::steady_clock::time_point since{std::chrono::steady_clock::now()};  ///< when it was accepted
};

/// Accepts connections and keeps each until the head of its request has come, all on the thread that calls run(): clients that send nothing,
/// or a byte now and then, take no thread from those who serve.
class Reception {
 public:
  /// How long, and how much, a head may take; see HttpLimits.
  struct Limits {
    std::size_t head_bytes;
    std::chrono::milliseconds head_time;
    std::chrono::milliseconds drain_time;
    std::size_t most_waiting = 2000;  ///< connections; one more takes the place of the oldest
  };

  /// @param hand_over    takes over a connection whose head has come or is too large; must not throw
  /// @param late_answer  to a client whose head has not come in time, from what it has sent
  Reception(const Limits& limits, std::function<void(Arrival)> hand_over, std::function<std::string(const std::string&)> late_answer);
  ~Reception();
  Reception(const Reception&) = delete;
  Reception& operator=(const Reception&) = delete;

  /// Accepts on a listening socket, which it closes at the end, until stop(); then those that have begun to send have the drain time left.
  /// @returns false if accepting failed for good
  bool run(int listening);

  /// From any thread, also before run().
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  /// Waits for something to happen and sees to it. False if accepting has failed for good.
  bool serve_events(int listening);
  bool accept_next(int listening);
  void read_ready(const Arrival* ready);
  /// True if the connection is done with here.
  bool read_some(Arrival& arrival);
  void stop_accepting(int listening);
  void drop_late();
  void drop(std::list<Arrival>::iterator arrival);
  [[nodiscard]] int patience_ms() const;

  const Limits limits_;
  const std::function<void(Arrival)> hand_over_;
  const std::function<std::string(const std::string&)> late_answer_;
  std::atomic<bool> stopping_ = false;
  int epoll_ = -1;
  int bell_ = -1;                ///< eventfd: rung by stop()
  std::list<Arrival> waiting_;   ///< oldest first
};

}  // namespace server
