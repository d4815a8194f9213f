// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "server/messages/message.h"

namespace server_tests {

/// Appends a line of JSON to the file that the environment names in RPSUP_TEST_EXCHANGES, if it does: what
/// was asked, and the answer. tests/openapi checks the lines against the OpenAPI document.
inline void log_exchange(const std::string& method, const std::string& target,
                         const server::Response& response) {
  const char* const file = std::getenv("RPSUP_TEST_EXCHANGES");
  if (file == nullptr) return;
  nlohmann::json headers = nlohmann::json::object();
  if (!response.content_type.empty()) headers["content-type"] = response.content_type;
  for (const auto& [name, value] : response.headers) {
    std::string key = name;
    for (char& c : key) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    headers[key] = value;
  }
  const nlohmann::json line{{"method", method},
                            {"target", target},
                            {"status", response.status},
                            {"headers", headers},
                            {"body", response.body}};
  std::ofstream(file, std::ios::app) << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                                            "\n";
}

/// The same of bytes that were sent and came back over a connection; whatever is no answer of HTTP is left
/// out.
inline void log_raw_exchange(std::string_view sent, std::string_view received) {
  const auto word = [](std::string_view& text, std::string_view ends) {
    const std::size_t end = std::min(text.find_first_of(ends), text.size());
    std::string first(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    return first;
  };
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  if (received.starts_with(kContinue)) received.remove_prefix(kContinue.size());
  if (!received.starts_with("HTTP/1.1 ")) return;
  while (sent.starts_with("\r\n")) sent.remove_prefix(2);  // before a request they mean nothing
  const std::string method = word(sent, " \r\n");
  const std::string target = word(sent, " \r\n");
  const std::size_t head_end = received.find("\r\n\r\n");
  if (head_end == std::string_view::npos) return;
  server::Response response{.status = std::stoi(std::string(received.substr(9, 3))),
                            .content_type = {},
                            .body = std::string(received.substr(head_end + 4)),
                            .headers = {}};
  std::string_view head = received.substr(0, head_end);
  word(head, "\n");
  while (!head.empty()) {
    std::string line = word(head, "\n");
    const std::size_t colon = line.find(": ");
    if (line.ends_with('\r')) line.pop_back();
    if (colon != std::string::npos)
      response.headers.emplace_back(line.substr(0, colon), line.substr(colon + 2));
  }
  log_exchange(method, target, response);
}

}  // namespace server_tests
