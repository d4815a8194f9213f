// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/httplib.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/http_limits.h"
#include "server/http/pending_connection.h"

namespace server {

/// One connection with deadlines. Reads the head of the request itself, then hands everything to httplib.
class HttpStream final : public httplib::Stream {
 public:
  enum class Head { kComplete, kClosed, kTooLarge, kTooSlow };

  /// @param connection  whose socket stays the caller's
  /// @param draining    set once the server is ending; outlives this
  /// @param queued      number of connections that no thread has taken yet; outlives this
  HttpStream(PendingConnection connection, const HttpLimits& limits, const std::atomic<bool>& draining,
             const std::atomic<int>& queued);

  /// Reads up to the empty line that ends the head; what follows it is kept for read().
  Head read_head();
  /// The request as far as it has come.
  [[nodiscard]] std::string_view received() const { return buffer_; }
  [[nodiscard]] std::string_view head() const { return std::string_view(buffer_).substr(0, head_size_); }

  /// Replaces the head that was read. Not after read().
  void replace_head(const std::string& head);

  /// Sets the largest body, and the time for it. Before the body is read.
  void allow_body(std::size_t bytes);

  /// Notes whether the client waits for "100 Continue" before it sends the body (RFC 9110, section 10.1.1).
  void expect_continue(bool expected) { expects_continue_ = expected; }
  /// Sends it to a client that waits, once. Not counted as part of the answer.
  void send_continue();

  /// @returns whether the client has been sent anything
  [[nodiscard]] bool has_sent() const { return sent_bytes_ > 0; }

  /// Sends all of a text. False if the client is gone or too slow.
  bool send_all(std::string_view text);

  /// Lingering close (RFC 9112, section 9.6): reads and discards until the client has closed its end, so that
  /// it sees the whole answer. A plain close with unread bytes would reset the connection.
  void lingering_close();

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
  /// End of the wait for a client that takes nothing: by stall_time or by response_time, whichever ends
  /// first.
  [[nodiscard]] Clock::time_point write_deadline() const;
  /// Notes where the head ends, and begins the time for the body.
  void complete_head(std::size_t size);
  /// Appends what the client has sent to the buffer. @returns as receive() does
  ssize_t receive_more();
  /// Hands out bytes that have come with the head or with others.
  ssize_t take_buffered(char* to, std::size_t size);
  /// Like recv(), after waiting. 0: closed by the client; negative: deadline or error.
  ssize_t receive(char* to, std::size_t size, Clock::time_point deadline) const;

  int socket_;
  HttpLimits limits_;
  const std::atomic<bool>& draining_;
  const std::atomic<int>& queued_;
  mutable std::optional<Clock::time_point> drain_deadline_;  ///< set when draining is first noticed
  std::string buffer_;                ///< bytes received and not yet given to httplib, from consumed_ on
  std::size_t body_limit_;            ///< bytes of the body, decoded
  std::size_t consumed_ = 0;
  std::size_t head_size_ = 0;
  std::size_t raw_body_bytes_ = 0;
  Clock::time_point read_deadline_;
  Clock::time_point crowded_deadline_;  ///< of reads, while other connections queue for a thread
  std::optional<Clock::time_point> write_start_;  ///< of the first write
  std::size_t sent_bytes_ = 0;
  bool expects_continue_ = false;
  Clock::duration waited_{};  ///< sum of the waits until the client took more
};

}  // namespace server
