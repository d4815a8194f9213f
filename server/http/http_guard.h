// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/connection_acceptor.h"
#include "server/http/event_hub.h"
#include "server/http/http_limits.h"
#include "server/http/http_stream.h"
#include "server/http/request_head.h"
#include "server/http/worker_pool.h"
#include "server/messages/message.h"

namespace server {

/// Name of the Accept-Encoding header in the requests that GuardedServer gives to the library: under its own
/// name the header would make the library compress, with brotli at its slowest setting. No client can send a
/// name with blanks.
inline constexpr const char* kAcceptEncoding = "Accept-Encoding of the client";
inline constexpr const char* kRange = "Range of the client";

/// cpp-httplib's server with limits. The library by itself reads heads of any length, waits without end,
/// serves any number of Range headers, keeps its few threads for clients that do nothing, and ends when it
/// cannot accept a connection or has no memory for one. Here a connection carries one request, within
/// HttpLimits, and is closed.
class GuardedServer final : public httplib::Server {
 public:
  /// Turns a status and a sentence into the answer to a request whose head is not served.
  using MakeRefusal = std::function<Response(int status, const std::string& detail)>;
  /// Completes such an answer for the one who asks, and notes that it is sent.
  /// @param head  of the request; it may be faulty or not whole
  using CompleteRefusal = std::function<void(Response& refusal, std::string_view head)>;

  /// @param limits  of every connection
  GuardedServer(const HttpLimits& limits, MakeRefusal make_refusal, CompleteRefusal complete_refusal);

  ~GuardedServer() override;

  /// Binds to an address (no name) and starts to queue connections.
  /// @param port  0: any free one
  /// @returns the port; 0 if it could not be bound, because another process has it say
  int bind(const std::string& address, int port);

  /// Accepts connections until stop_accepting(), and returns when all of them have been served. False if it
  /// could not go on.
  bool accept_connections();
  /// From any thread, also before accept_connections(); bind() came before.
  void stop_accepting();

  /// From now on every connection has HttpLimits::drain_time left; event streams end at once.
  void start_draining() {
    draining_ = true;
    event_hub_.stop();
  }

  /// Reserves one of the connections that may stay open, for an event stream. False if all are reserved.
  [[nodiscard]] bool reserve_event_stream(const std::shared_ptr<EventSource>& events) {
    return event_hub_.reserve(events);
  }

  /// Takes bytes of the request's body off the wire, as ReadBytes does. Within a handler.
  [[nodiscard]] static std::ptrdiff_t read_body(char* to, std::size_t size);

  /// Makes the answer of the request that this thread handles an event stream: once its head has been sent,
  /// the connection stays open and carries the events. For handlers of requests.
  static void stream_events(std::shared_ptr<EventSource> events);

  /// Holds a permit until the answer of the request that this thread handles has been sent. For handlers.
  static void hold_until_sent(std::shared_ptr<const void> permit);

 private:
  void queue_connection(PendingConnection connection) noexcept;
  /// Adds a connection to the queue of its threads. @returns the one that has no place any more
  std::optional<PendingConnection> add_to_queue(PendingConnection& connection);
  /// Answers on the thread that accepts: as much as the socket takes at once, which is all of it.
  void refuse_without_worker(PendingConnection connection, const Response& refusal) noexcept;
  void serve_and_close(PendingConnection connection) noexcept;
  /// Serves the request; an exception is logged, and answered if nothing has been sent.
  void serve_guarded(HttpStream& stream) noexcept;
  void serve(HttpStream& stream);
  /// Reads the head of the request. False if there is none to serve; a client that is still there has been
  /// refused.
  bool read_head_or_refuse(HttpStream& stream);
  void serve_with_library(HttpStream& stream, RequestHead head);
  template <typename Self, typename Fill>
  static void process_with_library(Self& self, HttpStream& stream, const Fill& fill_request);
  void refuse(HttpStream& stream, int status, const std::string& detail);
  /// @param head  see CompleteRefusal
  [[nodiscard]] std::string refusal_text(Response refusal, std::string_view head) const;

  HttpLimits limits_;
  MakeRefusal make_refusal_;
  CompleteRefusal complete_refusal_;
  // Made in advance, while there is memory and time.
  const Response busy_;
  const std::string no_memory_answer_;
  std::atomic<bool> draining_ = false;
  std::atomic<int> queued_ = 0;  ///< connections that no thread has taken yet
  EventHub event_hub_;
  ConnectionAcceptor acceptor_;
  // They use what stands above. Probes have threads of their own: whether the service is up must be told
  // while all others are busy.
  WorkerPool pool_;
  WorkerPool probe_pool_;
};

}  // namespace server
