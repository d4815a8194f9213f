// SPDX-License-Identifier: Apache-2.0
// Whatever a client sends down a connection: through the stream, the guard and the library, to handlers that
// answer at once.

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include <spdlog/spdlog.h>

#include "server/http/http_guard.h"
#include "server/messages/problem.h"
#include "server/messages/trimmed.h"
#include "tests/fuzz/expect.h"

namespace {

using namespace std::chrono_literals;

server::HttpLimits short_limits() {
  server::HttpLimits limits;
  limits.head_bytes = 1024;
  limits.body_bytes = 2048;
  limits.head_time = limits.body_time = 1s;
  return limits;
}

/// Headers as the handlers see them, each on a line of its own.
std::string seen_of(const httplib::Request& request) {
  std::string text = "\n";
  for (const auto& [name, value] : request.headers) text += name + ": " + value + "\n";
  return text;
}

/// A guarded server that answers every POST with the body that it had, and every other request with its head
/// as seen. It lives as long as the fuzzer.
class Target {
 public:
  Target() {
    spdlog::set_level(spdlog::level::off);
    guard_.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
      if (request.method == "POST") return httplib::Server::HandlerResponse::Unhandled;
      response.set_content(seen_of(request), "text/plain");
      return httplib::Server::HandlerResponse::Handled;
    });
    guard_.Post(R"([\s\S]*)", [](const httplib::Request&, httplib::Response& response,
                                 const httplib::ContentReader& reader) {
      std::string body;
      reader([&](const char* data, std::size_t size) {
        body.append(data, size);
        fuzz::expect(body.size() <= 16 * short_limits().body_bytes, "a body has its bound");
        return true;
      });
      response.set_content(body, "application/octet-stream");
    });
    port_ = guard_.bind("127.0.0.1", 0);
    fuzz::expect(port_ > 0, "a port of the loopback");
    std::thread([this] { guard_.accept_connections(); }).detach();
  }

  /// Sends a text in two parts, says that this is all, and reads until the connection ends.
  [[nodiscard]] std::string answer_to(std::string_view first, std::string_view second) const {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    fuzz::expect(::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0,
                 "a connection is taken");
    const linger reset{.l_onoff = 1, .l_linger = 0};  // else so many connections would use up the ports
    ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
    send_all(socket, first);
    send_all(socket, second);
    ::shutdown(socket, SHUT_WR);
    std::string answer;
    char bytes[16 * 1024];
    for (ssize_t got = 0; (got = ::recv(socket, bytes, sizeof bytes, 0)) > 0;)
      answer.append(bytes, static_cast<std::size_t>(got));
    ::close(socket);
    return answer;
  }

 private:
  static void send_all(int socket, std::string_view text) {
    while (!text.empty()) {
      const ssize_t sent = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;  // the server has seen enough
      text.remove_prefix(static_cast<std::size_t>(sent));
    }
  }

  server::GuardedServer guard_{
      short_limits(),
      [](int status, const std::string& detail) { return server::make_problem(status, detail); },
      [](server::Response&, std::string_view) {}};
  int port_ = 0;
};

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// @param seen  what seen_of made of the request
void check_headers(std::string_view request, const std::string& seen) {
  request = request.substr(0, request.find("\r\n\r\n") + 2);
  // A target with a host stands for the header (RFC 9112, section 3.2.2).
  const auto end_of_first = request.find("\r\n");
  const bool target_names_host = request.substr(0, end_of_first).find("://") != std::string_view::npos;
  request.remove_prefix(end_of_first + 2);
  while (!request.empty()) {
    const std::string_view line = request.substr(0, request.find("\r\n"));
    request.remove_prefix(line.size() + 2);
    std::string name = lower(line.substr(0, line.find(':')));
    if (name == "range" || (name == "host" && target_names_host)) continue;
    if (name == "accept-encoding") name = server::kAcceptEncoding;
    const auto begin = seen.find("\n" + name + ": ");
    fuzz::expect(begin != std::string::npos, "a header that was sent is seen");
    const std::string value = seen.substr(begin, seen.find('\n', begin + 1) - begin).substr(name.size() + 3);
    const std::string_view sent = server::trimmed(line.substr(line.find(':') + 1));
    fuzz::expect(value.find(sent) != std::string::npos, "the value of a header is seen as it was sent");
  }
}

void check_answer(std::string_view request, const std::string& answer) {
  if (answer.empty()) return;
  while (request.starts_with("\r\n")) request.remove_prefix(2);  // no part of the request
  fuzz::expect(answer.starts_with("HTTP/1.1 ") && answer.size() > 12, "an answer begins with its status");
  const std::size_t start = answer.starts_with("HTTP/1.1 100 ") ? answer.find("\r\n\r\n") + 4 : 0;
  fuzz::expect(answer.substr(start + 9, 3) != "500", "nothing that a client sends is our mistake");
  const auto end = answer.find("\r\n\r\n", start);
  fuzz::expect(end != std::string::npos, "the head of an answer ends");
  constexpr std::string_view kLength = "\r\nContent-Length: ";
  const auto length = answer.find(kLength, start);
  if (length == std::string::npos || length > end || request.starts_with("HEAD ")) return;
  const auto bytes = std::stoull(answer.substr(length + kLength.size()));
  fuzz::expect(answer.size() == end + 4 + bytes, "one connection, one answer");
  const bool shows_head = answer.substr(start + 9, 3) == "200" && !request.starts_with("POST ");
  if (shows_head) check_headers(request, answer.substr(end + 4));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Target& target = *new Target;
  const std::string_view request(reinterpret_cast<const char*>(data), size);
  // Where the text is cut depends on it alone, so that a finding can be shown again.
  const std::size_t cut = size == 0 ? 0 : data[size / 2] % size;
  check_answer(request, target.answer_to(request.substr(0, cut), request.substr(cut)));
  return 0;
}
