// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/httplib.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/connection_acceptor.h"

namespace server {

/// How much one connection may ask for. Times are totals: a limit on a single read lets a client send a byte at a
/// time for ever.
struct HttpLimits {
  std::size_t head_bytes = 16 * 1024;
  std::size_t body_bytes = 8 * 1024 * 1024;        ///< after decoding
  std::chrono::milliseconds head_time{5'000};
  std::chrono::milliseconds body_time{10'000};
  std::chrono::milliseconds response_time{60'000};
  std::size_t response_bytes_per_s = 256 * 1024;   ///< what the client takes buys it more of that time: a copy of the store has gigabytes
  std::chrono::milliseconds stall_time{10'000};    ///< waiting, all in all, until the client takes more of the answer
  std::size_t least_bytes_per_s = 1024;            ///< what the client takes buys it more of that time
  std::chrono::milliseconds linger_time{2'000};    ///< waiting for the client to close its end
  std::chrono::milliseconds crowded_time{500};     ///< in place of each longer wait for a client, to send or to take, while others wait for a thread
  std::chrono::milliseconds drain_time{1'000};     ///< what is left to every connection once the server is ending
};

/// One connection with deadlines. Reads the head of the request itself, then hands everything to httplib.
class HttpStream final : public httplib::Stream {
 public:
  enum class Head { kComplete, kClosed, kTooLarge, kTooSlow };

  /// @param arrival   whose socket stays the caller's
  /// @param draining  set once the server is ending; outlives this
  /// @param waiting   connections that no thread has taken yet; outlives this
  HttpStream(PendingConnection arrival, const HttpLimits& limits, const std::atomic<bool>& draining, const std::atomic<int>& waiting);

  /// Reads up to the empty line that ends the head; what follows it is kept for read().
  Head read_head();
  /// Whether the request, as far as it has come, asks for an answer without its body.
  [[nodiscard]] bool asks_for_head() const { return buffer_.starts_with("HEAD "); }
  [[nodiscard]] std::string_view head() const { return std::string_view(buffer_).substr(0, head_size_); }

  /// Puts another head in the place of the one that was read. Not after read().
  void replace_head(const std::string& head);

  /// Whether the client has been sent anything.
  [[nodiscard]] bool has_sent() const { return sent_bytes_ > 0; }

  /// Sends all of a text. False if the client is gone or too slow.
  bool send_all(std::string_view text);

  /// Ends the connection so that the client sees the whole answer: a plain close with unread bytes would reset it.
  void close_gently();

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* to, std::size_t size) override;
  ssize_t write(const char* from, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// Waits until the socket has one of these poll events. False when the deadline passes first.
  bool wait_for(short events, Clock::time_point deadline) const;
  /// When a client that takes nothing now has been waited for long enough, or is too slow by now.
  [[nodiscard]] Clock::time_point write_deadline() const;
  /// Like recv(), after waiting. 0: closed by the client; negative: deadline or error.
  ssize_t receive(char* to, std::size_t size, Clock::time_point deadline) const;

  int socket_;
  HttpLimits limits_;
  const std::atomic<bool>& draining_;
  const std::atomic<int>& waiting_;
  mutable std::optional<Clock::time_point> drain_deadline_;  ///< set when draining is first noticed
  std::string buffer_;                ///< bytes received and not yet given to httplib, from consumed_ on
  std::size_t consumed_ = 0;
  std::size_t head_size_ = 0;
  std::size_t raw_body_bytes_ = 0;
  Clock::time_point read_deadline_;
  Clock::time_point crowded_deadline_;  ///< of reads, while others wait for a thread
  std::optional<Clock::time_point> write_start_;  ///< of the first write
  std::size_t sent_bytes_ = 0;
  Clock::duration waited_{};  ///< for the client to take what it was sent
};

}  // namespace server
