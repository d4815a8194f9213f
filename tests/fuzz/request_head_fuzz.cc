// SPDX-License-Identifier: Apache-2.0
// The head of a request as it comes off the wire, and the origin that it claims.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/http/request_head.h"
#include "tests/fuzz/expect.h"

namespace {

constexpr std::size_t kBodyBytes = 1 << 20;

void check_refusal(const server::Refusal& refusal) {
  fuzz::expect(refusal.status >= 400 && refusal.status < 600 && !refusal.detail.empty(),
               "a refusal has a status and a sentence");
}

/// The value of the first line with that name, as a client may have written it.
std::string value_of(std::string_view head, std::string_view name) {
  const auto line = head.find(name);
  if (line == std::string_view::npos) return {};
  const auto end = head.find("\r\n", line);
  return std::string(
      head.substr(line + name.size(), end == std::string_view::npos ? end : end - line - name.size()));
}

std::size_t end_of_head(std::string_view text) {
  const auto end = text.find("\r\n\r\n");
  return end == std::string_view::npos ? text.size() : end + 4;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string_view head = text.substr(0, end_of_head(text));  // as far as the stream reads
  static const server::OriginCheck origins("127.0.0.1", {"https://lab.example.org"});
  const auto wrong_origin = origins.find_fault({.method = "POST",
                                                .host = value_of(head, "Host: "),
                                                .origin = value_of(head, "Origin: "),
                                                .fetch_site = value_of(head, "Sec-Fetch-Site: "),
                                                .fetch_mode = value_of(head, "Sec-Fetch-Mode: ")});
  if (wrong_origin) check_refusal(*wrong_origin);
  if (const auto fault = server::find_fault_in_head(head, kBodyBytes)) {
    check_refusal(*fault);
    return 0;
  }
  if (!head.ends_with("\r\n\r\n")) return 0;  // the stream waits for the end
  fuzz::expect(head.find('\0') == std::string_view::npos, "a good head is text");
  const server::RequestHead read = server::read_head(head);
  fuzz::expect(!server::find_fault_in_head(read.request_line + "\r\nHost: a\r\n\r\n", kBodyBytes),
               "what the library is shown is a good head");
  fuzz::expect(read.headers.contains("host") || read.request_line.ends_with("HTTP/1.0"),
               "a good head names its host");
  for (const auto& [name, value] : read.headers) {
    if (value.find(", ") != std::string::npos) continue;  // perhaps of several lines
    fuzz::expect(head.find(value) != std::string_view::npos, "the value of a header is what was sent");
  }
  return 0;
}
