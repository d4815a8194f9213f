// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/server/exchange_log.h"

namespace server_tests {

/// A connection that sends exactly the bytes it is given: no HTTP library would send what the guard is there
/// for.
class RawClient {
 public:
  explicit RawClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    // Bounds connect(), too: a server whose queue is full lets it wait for minutes.
    const timeval patience{.tv_sec = 2, .tv_usec = 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// False if the server has closed its end.
  bool send(std::string_view bytes) {
    sent_ += bytes;
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// Everything up to the end of the connection; what came so far if that takes more than 10 s.
  std::string read_all() {
    std::string text;
    char bytes[4096];
    pollfd entry{socket_, POLLIN, 0};
    while (::poll(&entry, 1, 10'000) > 0) {
      const ssize_t got = ::recv(socket_, bytes, sizeof bytes, 0);
      if (got <= 0) {
        log_raw_exchange(sent_, text);
        return text;
      }
      text.append(bytes, static_cast<std::size_t>(got));
    }
    return text + " [no end of the connection within 10 s]";
  }

  /// The status of the first line, read without waiting for the end of the connection; 0 if there is none.
  int read_status() {
    std::string line(12, '\0');  // "HTTP/1.1 200"
    return ::recv(socket_, line.data(), line.size(), MSG_WAITALL) == 12 ? std::stoi(line.substr(9)) : 0;
  }

  /// True once there is something to read or the server has closed its end.
  bool answered_within(std::chrono::milliseconds time) {
    pollfd entry{socket_, POLLIN, 0};
    return ::poll(&entry, 1, static_cast<int>(time.count())) > 0;
  }

 private:
  int socket_;
  std::string sent_;
};

/// The status in an answer's first line; 0 if there is no answer.
inline int status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
}

inline std::string body_of(const std::string& answer) {
  const auto end = answer.find("\r\n\r\n");
  return end == std::string::npos ? "" : answer.substr(end + 4);
}

}  // namespace server_tests
