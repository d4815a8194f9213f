// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_guard.h"

#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "server/http/memory_reserve.h"
#include "server/http/request_head.h"
#include "server/messages/problem.h"
#include "server/messages/safe_log.h"

// The packaged library is built with these; without them its classes have another layout and the program
// crashes.
#if !defined(CPPHTTPLIB_OPENSSL_SUPPORT) || !defined(CPPHTTPLIB_ZLIB_SUPPORT) || \
    !defined(CPPHTTPLIB_BROTLI_SUPPORT)
#error "compile with the flags of pkg-config --cflags cpp-httplib"
#endif

namespace server {

namespace {

// They wait for clients most of the time. Some are left when all that may wait for others do (WorkLimit).
constexpr std::size_t kThreads = 32;
constexpr std::size_t kProbeThreads = 2;
constexpr std::size_t kMostProbesQueued = 512;
constexpr int kBacklog = 511;  // the library's 5 makes clients wait for a second when a few come at once

void set_reuse_address(socket_t socket) {
  // Not SO_REUSEPORT, the library's choice: with it a second server on the port would start without a word.
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

/// Copies the head that the client has sent to the library's request, with Range under another name: the
/// library would answer any number of ranges, of every body.
void fill(httplib::Request& request, RequestHead head) {
  if (auto range = head.headers.extract("range")) {
    range.key() = kRange;
    head.headers.insert(std::move(range));
  }
  if (auto encoding = head.headers.extract("accept-encoding")) {
    encoding.key() = kAcceptEncoding;
    head.headers.insert(std::move(encoding));
  }
  request.path = std::move(head.path);
  request.params = {head.query.begin(), head.query.end()};
  request.headers = {head.headers.begin(), head.headers.end()};
}

/// Event stream that follows the head of the answer, set by the handler. The library calls a handler on the
/// thread that serves the connection, and does not tell the handler which connection that is.
thread_local std::shared_ptr<EventSource> events_of_this_connection;
/// Permit of the answer on that connection, until it has been sent.
thread_local std::shared_ptr<const void> permit_of_this_connection;
/// Stream of that connection, while the library serves it.
thread_local HttpStream* stream_of_this_connection = nullptr;

/// Head of the answer as HTTP/1.1 text: status line, headers, empty line.
std::string head_of(const Response& response) {
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + " " +
                     std::string(status_phrase(response.status)) +
                     "\r\nConnection: close\r\nContent-Type: " + response.content_type +
                     "\r\nContent-Length: " + std::to_string(response.body.size()) + "\r\n";
  for (const auto& [name, value] : response.headers) text += name + ": " + value + "\r\n";
  return text + "\r\n";
}

std::string text_of(const Response& response) { return head_of(response) + response.body; }

/// @returns whether a head asks for a path that may be a probe, which its last segment says
bool may_be_probe(std::string_view head) {
  if (!head.starts_with("GET ") && !head.starts_with("HEAD ")) return false;
  const std::string_view path = raw_path_of(head);
  return path.ends_with("/healthz") || path.ends_with("/readyz");
}

}  // namespace

GuardedServer::GuardedServer(const HttpLimits& limits, MakeRefusal make_refusal,
                             CompleteRefusal complete_refusal)
    : limits_(limits),
      make_refusal_(std::move(make_refusal)),
      complete_refusal_(std::move(complete_refusal)),
      busy_(make_refusal_(503, "as many requests as may wait are waiting; try again")),
      no_memory_answer_(
          text_of(make_refusal_(503, "the machine has no memory left for this request; try again"))),
      event_hub_(limits.event_stall_time),
      acceptor_(
          {.head_bytes = limits.head_bytes,
           .head_time = limits.head_time,
           .linger_time = limits.linger_time,
           .drain_time = limits.drain_time},
          [this](PendingConnection connection) { queue_connection(std::move(connection)); },
          [this](const std::string& received) {
            return refusal_text(make_refusal_(408, "the head of the request did not come in time"), received);
          }),
      pool_(kThreads, limits.max_queued,
            [this](PendingConnection connection) {
              --queued_;
              serve_and_close(std::move(connection));
            }),
      probe_pool_(kProbeThreads, kMostProbesQueued,
                  [this](PendingConnection connection) { serve_and_close(std::move(connection)); }) {
  set_socket_options(set_reuse_address);
  set_tcp_nodelay(true);
  set_payload_max_length(limits.largest_body_bytes());
}

GuardedServer::~GuardedServer() {
  pool_.finish();
  probe_pool_.finish();
  const socket_t socket = svr_sock_.exchange(INVALID_SOCKET);
  if (socket != INVALID_SOCKET) ::close(socket);
}

int GuardedServer::bind(const std::string& address, int port) {
  const int bound = port == 0 ? bind_to_any_port(address) : (bind_to_port(address, port) ? port : -1);
  if (bound <= 0 || ::listen(svr_sock_, kBacklog) != 0) return 0;
  return bound;
}

bool GuardedServer::accept_connections() {
  const bool good = acceptor_.run(svr_sock_);
  svr_sock_ = INVALID_SOCKET;
  pool_.finish();
  probe_pool_.finish();
  return good;
}

void GuardedServer::stop_accepting() { acceptor_.stop(); }

void GuardedServer::queue_connection(PendingConnection connection) noexcept {
  std::optional<PendingConnection> displaced;
  try {
    displaced = add_to_queue(connection);
  } catch (const std::bad_alloc&) {
    log_error("a connection is closed: no memory");
    ::close(connection.socket);
    return;
  }
  if (displaced) refuse_without_worker(std::move(*displaced), busy_);
}

std::optional<PendingConnection> GuardedServer::add_to_queue(PendingConnection& connection) {
  if (may_be_probe(connection.received)) return probe_pool_.add(connection);
  ++queued_;
  try {
    std::optional<PendingConnection> displaced = pool_.add(connection);
    if (displaced) --queued_;
    return displaced;
  } catch (...) {
    --queued_;
    throw;
  }
}

void GuardedServer::refuse_without_worker(PendingConnection connection, const Response& refusal) noexcept {
  try {
    const std::string answer = refusal_text(refusal, connection.received);
    static_cast<void>(::send(connection.socket, answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
  } catch (const std::bad_alloc&) {  // closed without an answer
  }
  if (!acceptor_.linger(connection.socket)) ::close(connection.socket);
}

void GuardedServer::serve_and_close(PendingConnection connection) noexcept {
  const int socket = connection.socket;
  HttpStream stream(std::move(connection), limits_, draining_, queued_);
  events_of_this_connection.reset();
  serve_guarded(stream);
  permit_of_this_connection.reset();
  if (auto events = std::exchange(events_of_this_connection, nullptr)) {
    if (!event_hub_.adopt(socket, std::move(events))) ::close(socket);
    return;
  }
  if (acceptor_.linger(socket)) return;
  stream.lingering_close();
  ::close(socket);
}

void GuardedServer::serve_guarded(HttpStream& stream) noexcept {
  try {
    if (!refill_memory_reserve()) throw std::bad_alloc();
    serve(stream);
  } catch (const std::bad_alloc&) {
    log_error("a request could not be answered: no memory");
    if (!stream.has_sent()) stream.send_all(no_memory_answer_);
  } catch (const std::exception& error) {
    log_error("a connection ended early: {}", error.what());
  }
}

void GuardedServer::stream_events(std::shared_ptr<EventSource> events) {
  events_of_this_connection = std::move(events);
}

void GuardedServer::hold_until_sent(std::shared_ptr<const void> permit) {
  permit_of_this_connection = std::move(permit);
}

std::ptrdiff_t GuardedServer::read_body(char* to, std::size_t size) {
  stream_of_this_connection->send_continue();
  return stream_of_this_connection->read(to, size);
}

bool GuardedServer::read_head_or_refuse(HttpStream& stream) {
  switch (stream.read_head()) {
    case HttpStream::Head::kComplete:
      return true;
    case HttpStream::Head::kClosed:
      break;
    case HttpStream::Head::kTooSlow:
      refuse(stream, 408, "the head of the request did not come in time");
      break;
    case HttpStream::Head::kTooLarge:
      refuse(stream, 431, "the head is larger than " + std::to_string(limits_.head_bytes) + " bytes");
      break;
  }
  return false;
}

void GuardedServer::serve(HttpStream& stream) {
  if (!read_head_or_refuse(stream)) return;
  const std::size_t body_bytes = limits_.body_bytes_of(raw_path_of(stream.head()));
  if (const auto fault = find_fault_in_head(stream.head(), body_bytes)) {
    return refuse(stream, fault->status, fault->detail);
  }
  RequestHead head = read_head(stream.head());
  stream.allow_body(body_bytes);
  // The library is not to say "100 Continue": it would before it has asked whether the client may.
  if (const auto expected = head.headers.extract("expect"))
    stream.expect_continue(::strcasecmp(expected.mapped().c_str(), "100-continue") == 0);
  serve_with_library(stream, std::move(head));
}

/// Versions of the library decode "%41" in the values of headers, and differ in which headers they drop or
/// refuse and in how they parse a query. The library therefore parses method and version alone; fill() sets
/// the rest.
void GuardedServer::serve_with_library(HttpStream& stream, RequestHead head) {
  stream.replace_head(head.request_line + "\r\n\r\n");
  stream_of_this_connection = &stream;
  process_with_library(*this, stream, [&head](httplib::Request& request) { fill(request, std::move(head)); });
  stream_of_this_connection = nullptr;
}

/// Lets the library serve a request. Older versions ask the stream for the addresses of its ends; newer
/// versions take them as arguments.
/// @param self  this object, as a template's argument: an overload that the library does not have is then no
/// error
template <typename Self, typename Fill>
void GuardedServer::process_with_library(Self& self, HttpStream& stream, const Fill& fill_request) {
  bool connection_closed = true;
  if constexpr (requires { self.process_request(stream, true, connection_closed, fill_request); }) {
    self.process_request(stream, true, connection_closed, fill_request);
  } else {
    std::string client;
    std::string server;
    int client_port = 0;
    int server_port = 0;
    stream.get_remote_ip_and_port(client, client_port);
    stream.get_local_ip_and_port(server, server_port);
    self.process_request(stream, client, client_port, server, server_port, true, connection_closed,
                         fill_request);
  }
}

void GuardedServer::refuse(HttpStream& stream, int status, const std::string& detail) {
  stream.send_all(refusal_text(make_refusal_(status, detail), stream.received()));
}

std::string GuardedServer::refusal_text(Response refusal, std::string_view head) const {
  complete_refusal_(refusal, head);
  return head.starts_with("HEAD ") ? head_of(refusal) : text_of(refusal);
}

}  // namespace server
