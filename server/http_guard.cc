#include "server/http_guard.h"

#include <sys/socket.h>
#include <unistd.h>

#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/problem.h"
#include "server/request_head.h"

// The packaged library is built with these; without them its classes have another layout and the program crashes.
#if !defined(CPPHTTPLIB_OPENSSL_SUPPORT) || !defined(CPPHTTPLIB_ZLIB_SUPPORT) || !defined(CPPHTTPLIB_BROTLI_SUPPORT)
#error "compile with the flags of pkg-config --cflags cpp-httplib"
#endif

namespace server {

namespace {

constexpr std::size_t kThreads = 32;  // they wait for clients most of the time
constexpr int kBacklog = 511;         // the library's 5 makes clients wait for a second when a few come at once

/// The library's threads, and how many connections wait for one.
class CountingPool final : public httplib::TaskQueue {
 public:
  explicit CountingPool(std::atomic<int>& waiting) : waiting_(waiting), pool_(kThreads) {}

  void enqueue(std::function<void()> task) override {
    ++waiting_;
    pool_.enqueue([&waiting = waiting_, task = std::move(task)] {
      --waiting;
      task();
    });
  }

  void shutdown() override { pool_.shutdown(); }

 private:
  std::atomic<int>& waiting_;
  httplib::ThreadPool pool_;
};

void set_reuse_address(socket_t socket) {
  // Not SO_REUSEPORT, the library's choice: with it a second server on the port would start without a word.
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

/// Takes out of a request what makes the library do much work for little: compressing with brotli at its slowest setting.
void disarm(httplib::Request& request) { request.headers.erase("Accept-Encoding"); }

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

}  // namespace

GuardedServer::GuardedServer(const HttpLimits& limits, std::function<Response(int, const std::string&)> make_refusal)
    : limits_(limits), make_refusal_(std::move(make_refusal)) {
  new_task_queue = [this] { return new CountingPool(waiting_); };
  set_socket_options(set_reuse_address);
  set_tcp_nodelay(true);
  set_payload_max_length(limits.body_bytes);
}

GuardedServer::~GuardedServer() {
  // The library closes the socket when it ends accepting; this one may never have begun.
  const socket_t socket = svr_sock_.exchange(INVALID_SOCKET);
  if (socket != INVALID_SOCKET) ::close(socket);
}

int GuardedServer::bind(const std::string& address, int port) {
  const int bound = port == 0 ? bind_to_any_port(address) : (bind_to_port(address, port) ? port : -1);
  if (bound <= 0 || ::listen(svr_sock_, kBacklog) != 0) return 0;
  return bound;
}

bool GuardedServer::process_and_close_socket(socket_t socket) {
  HttpStream stream(socket, limits_, draining_, waiting_);
  events_of_this_connection.reset();
  // Called on a thread of the library's pool, where an exception would end the process.
  try {
    serve(stream);
  } catch (const std::exception& error) {
    spdlog::error("a connection ended early: {}", error.what());
  }
  if (auto events = std::exchange(events_of_this_connection, nullptr)) {
    hub_.take(socket, std::move(events));
    return true;
  }
  stream.close_gently();
  ::close(socket);
  return true;
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
  // The library would answer any number of ranges, and refuse those that it does not understand; whoever does not serve ranges ignores them.
  stream.replace_head(without_header(stream.head(), "range"));
  bool connection_closed = true;
  process_request(stream, true, connection_closed, disarm);
}

void GuardedServer::refuse(HttpStream& stream, int status, const std::string& detail) {
  const Response refusal = make_refusal_(status, detail);
  stream.send_all(head_of(refusal) + (stream.asks_for_head() ? "" : refusal.body));
}

}  // namespace server
