// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_guard.h"

#include <sys/socket.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <utility>

#include "server/http/memory_reserve.h"
#include "server/http/request_head.h"
#include "server/messages/problem.h"
#include "server/messages/safe_log.h"

// The packaged library is built with these; without them its classes have another layout and the program crashes.
#if !defined(CPPHTTPLIB_OPENSSL_SUPPORT) || !defined(CPPHTTPLIB_ZLIB_SUPPORT) || !defined(CPPHTTPLIB_BROTLI_SUPPORT)
#error "compile with the flags of pkg-config --cflags cpp-httplib"
#endif

namespace server {

namespace {

constexpr std::size_t kThreads = 32;  // they wait for clients most of the time
constexpr int kBacklog = 511;         // the library's 5 makes clients wait for a second when a few come at once

void set_reuse_address(socket_t socket) {
  // Not SO_REUSEPORT, the library's choice: with it a second server on the port would start without a word.
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

/// Has a request say what its client has sent, but no ranges: the library would answer any number of them, and refuse
/// those that it does not understand; whoever does not serve ranges ignores them.
void fill(httplib::Request& request, RequestHead head) {
  head.headers.erase("range");
  if (auto encoding = head.headers.extract("accept-encoding")) {
    encoding.key() = kAcceptEncoding;
    head.headers.insert(std::move(encoding));
  }
  request.path = std::move(head.path);
  request.params = {head.query.begin(), head.query.end()};
  request.headers = {head.headers.begin(), head.headers.end()};
}

/// What the handler wants to follow the head of the answer. The library calls a handler on the thread that serves the connection,
/// and tells it nothing of the connection.
thread_local std::shared_ptr<EventSource> events_of_this_connection;

/// All before the body, in the form of HTTP.
std::string head_of(const Response& response) {
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + " " + std::string(status_phrase(response.status)) +
                     "\r\nConnection: close\r\nContent-Type: " + response.content_type +
                     "\r\nContent-Length: " + std::to_string(response.body.size()) + "\r\n";
  for (const auto& [name, value] : response.headers) text += name + ": " + value + "\r\n";
  return text + "\r\n";
}

std::string text_of(const Response& response) { return head_of(response) + response.body; }

}  // namespace

GuardedServer::GuardedServer(const HttpLimits& limits, std::function<Response(int, const std::string&)> make_refusal)
    : limits_(limits),
      make_refusal_(std::move(make_refusal)),
      no_memory_answer_(text_of(make_refusal_(503, "the machine has no memory left for this request; try again"))),
      pool_(kThreads),
      acceptor_({.head_bytes = limits.head_bytes, .head_time = limits.head_time, .drain_time = limits.drain_time},
                 [this](PendingConnection arrival) { queue_connection(std::move(arrival)); },
                 [this](const std::string& received) {
                   return refusal_text(408, "the head of the request did not come in time", received.starts_with("HEAD "));
                 }) {
  set_socket_options(set_reuse_address);
  set_tcp_nodelay(true);
  set_payload_max_length(limits.body_bytes);
}

GuardedServer::~GuardedServer() {
  pool_.finish();
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
  return good;
}

void GuardedServer::stop_accepting() { acceptor_.stop(); }

void GuardedServer::queue_connection(PendingConnection arrival) noexcept {
  const int socket = arrival.socket;
  ++waiting_;
  try {
    pool_.add([this, arrival = std::move(arrival)]() mutable { serve_and_close(std::move(arrival)); });
  } catch (const std::bad_alloc&) {
    --waiting_;
    log_error("a connection is closed: no memory");
    ::close(socket);
  }
}

void GuardedServer::serve_and_close(PendingConnection arrival) noexcept {
  --waiting_;
  const int socket = arrival.socket;
  HttpStream stream(std::move(arrival), limits_, draining_, waiting_);
  events_of_this_connection.reset();
  serve_guarded(stream);
  if (auto events = std::exchange(events_of_this_connection, nullptr)) {
    if (!hub_.take(socket, std::move(events))) ::close(socket);
    return;
  }
  stream.close_gently();
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

void GuardedServer::follow_with(std::shared_ptr<EventSource> events) { events_of_this_connection = std::move(events); }

void GuardedServer::serve(HttpStream& stream) {
  switch (stream.read_head()) {
    case HttpStream::Head::kClosed:
      return;
    case HttpStream::Head::kTooSlow:
      return refuse(stream, 408, "the head of the request did not come in time");
    case HttpStream::Head::kTooLarge:
      return refuse(stream, 431, "the head is larger than " + std::to_string(limits_.head_bytes) + " bytes");
    case HttpStream::Head::kComplete:
      break;
  }
  if (const auto fault = find_fault_in_head(stream.head(), limits_.body_bytes)) {
    return refuse(stream, fault->status, fault->detail);
  }
  // Versions of the library decode "%41" in the values of headers, and differ in which headers they drop or refuse, and
  // in how they take a query apart: the library is shown method and version alone, and told what the rest says.
  RequestHead head = read_head(stream.head());
  stream.replace_head(head.request_line + "\r\n\r\n");
  have_processed(*this, stream, [&head](httplib::Request& request) { fill(request, std::move(head)); });
}

/// Has the library serve a request. Older versions ask a stream for the addresses of its ends; newer ones are told.
/// @param self  this object, as a template's argument: what it cannot do is then no error
template <typename Self, typename Fill>
void GuardedServer::have_processed(Self& self, HttpStream& stream, const Fill& fill_request) {
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
  stream.send_all(refusal_text(status, detail, stream.asks_for_head()));
}

std::string GuardedServer::refusal_text(int status, const std::string& detail, bool head_alone) const {
  const Response refusal = make_refusal_(status, detail);
  return head_alone ? head_of(refusal) : text_of(refusal);
}

}  // namespace server
