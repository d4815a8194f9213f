// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_head.h"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include "server/messages/identifiers.h"
#include "server/messages/trimmed.h"

namespace server {

namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return result;
}

bool has_control_character(std::string_view line) {
  return std::any_of(line.begin(), line.end(),
                     [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
}

/// Characters of a token, the form of header names (RFC 9110, section 5.6.2).
bool is_token_character(unsigned char c) {
  constexpr std::string_view kSigns = "!#$%&'*+-.^_`|~";
  return is_alphanumeric_or(c, kSigns);
}

/// Length of the body and name of the host, from the header lines.
struct Framing {
  bool may_lack_host = false;  ///< as HTTP/1.0 may
  int host_count = 0;
  int length_count = 0;
  std::string length;
  int encoding_count = 0;
  std::string encoding;
};

/// @param name  of a header, in lower case
void note_framing(const std::string& name, std::string_view value, Framing& framing) {
  if (name == "host") ++framing.host_count;
  if (name == "content-length") {
    ++framing.length_count;
    framing.length = value;
  }
  if (name == "transfer-encoding") {
    ++framing.encoding_count;
    framing.encoding = lower(value);
  }
}

std::optional<Refusal> read_header_line(std::string_view line, Framing& framing) {
  const auto colon = line.find(':');
  if (colon == std::string_view::npos || colon == 0) return Refusal{400, "a header line has no name"};
  if (!std::ranges::all_of(line.substr(0, colon), is_token_character)) {
    return Refusal{400, "the name of a header is no token"};
  }
  const std::string name = lower(line.substr(0, colon));
  const std::string_view value = trimmed(line.substr(colon + 1));
  // A proxy may drop headers without a value: the request would come as one without a key, and be stored
  // twice, or without a condition, and be done in any state.
  if (name == "idempotency-key" && value.empty()) return Refusal{400, "Idempotency-Key has no value"};
  if (name == "if-match" && value.empty()) return Refusal{400, "If-Match has no value"};
  note_framing(name, value, framing);
  return std::nullopt;
}

std::optional<Refusal> find_fault_in_length(const std::string& text, std::size_t body_bytes) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos) {
    return Refusal{400, "Content-Length is no number"};
  }
  std::size_t length = 0;
  const auto error = std::from_chars(text.data(), text.data() + text.size(), length).ec;
  if (error != std::errc{} || length > body_bytes) {
    return Refusal{413, "the body is larger than " + std::to_string(body_bytes) + " bytes"};
  }
  return std::nullopt;
}

std::optional<Refusal> find_fault_in_framing(const Framing& framing, std::size_t body_bytes) {
  const bool lacks_host = framing.host_count == 0 && framing.may_lack_host;
  if (framing.host_count != 1 && !lacks_host)
    return Refusal{400, "a request must have exactly one Host header"};
  if (framing.length_count + framing.encoding_count > 1)
    return Refusal{400, "the length of the body is given twice"};
  if (framing.encoding_count == 1 && framing.encoding != "chunked") {
    return Refusal{501, "the Transfer-Encoding is not supported; chunked is"};
  }
  if (framing.length_count == 1) return find_fault_in_length(framing.length, body_bytes);
  return std::nullopt;
}

/// Target of a request in its two forms (RFC 9112, section 3.2): "/v1/sweeps?limit=1", and with scheme and
/// host before it, as clients send it that take the service for a proxy.
struct Target {
  std::string_view host;  ///< with its port; empty in the first form
  std::string_view rest;  ///< path and query; the path may be empty in the second form
};

Target split_target(std::string_view target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (lower(target.substr(0, scheme.size())) != scheme) continue;
    const std::string_view after = target.substr(scheme.size());
    const auto end = std::min(after.find_first_of("/?#"), after.size());
    if (end > 0) return {.host = after.substr(0, end), .rest = after.substr(end)};
  }
  return {.host = {}, .rest = target};
}

std::optional<Refusal> find_fault_in_request_line(std::string_view line) {
  const auto start = line.find(' ');
  if (start == std::string_view::npos) return Refusal{400, "the request line is incomplete"};
  const auto blank = line.find(' ', start + 1);
  if (blank == std::string_view::npos) return Refusal{400, "the request line is incomplete"};
  const Target target = split_target(line.substr(start + 1, blank - start - 1));
  if (target.host.find('@') != std::string_view::npos)
    return Refusal{400, "the target names a user, which http does not have"};
  if (target.host.empty() && !target.rest.starts_with('/'))
    return Refusal{400, "the path does not start with /"};
  if (std::min(target.rest.find_first_of("?#"), target.rest.size()) > kMaxPathBytes) {
    return Refusal{414, "the path is longer than " + std::to_string(kMaxPathBytes) + " bytes"};
  }
  return std::nullopt;
}

/// The number that a hexadecimal digit stands for; empty for another character.
std::optional<unsigned> hex_digit(char c) {
  unsigned digit = 0;
  const auto [end, error] = std::from_chars(&c, &c + 1, digit, 16);
  return error == std::errc{} && end == &c + 1 ? std::optional(digit) : std::nullopt;
}

/// Decodes each "%" with two hexadecimal digits once (RFC 3986, section 2.1); what is no such triplet stays.
std::string percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
    const auto low = high ? hex_digit(text[i + 2]) : std::nullopt;
    result += low ? static_cast<char>(*high * 16 + *low) : text[i];
    if (low) i += 2;
  }
  return result;
}

/// A key or a value of a query, which forms write with "+" for a blank.
std::string query_text(std::string_view text) {
  std::string result(text);
  std::ranges::replace(result, '+', ' ');
  return percent_decoded(result);
}

/// Keys and values of "key=value&key=value"; the value is empty where there is no "=".
decltype(RequestHead::query) read_query_pairs(std::string_view text) {
  decltype(RequestHead::query) pairs;
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(item.size() + 1, text.size()));
    if (item.empty()) continue;
    const auto equals = std::min(item.find('='), item.size());
    const std::string_view value = item.substr(std::min(equals + 1, item.size()));
    pairs.emplace_back(query_text(item.substr(0, equals)), query_text(value));
  }
  return pairs;
}

/// @returns the host in the target; empty if there is none
std::string_view read_request_line(std::string_view line, RequestHead& result) {
  const auto start = line.find(' ') + 1;
  const std::string_view whole = line.substr(start, line.find(' ', start) - start);
  result.request_line.append(line.substr(0, start)).append("/").append(line.substr(start + whole.size()));
  const Target parts = split_target(whole);
  const std::string_view target = parts.rest.substr(0, parts.rest.find('#'));
  const auto mark = std::min(target.find('?'), target.size());
  result.path = mark == 0 ? "/" : percent_decoded(target.substr(0, mark));
  result.query = read_query_pairs(target.substr(std::min(mark + 1, target.size())));
  return parts.host;
}

/// @param first  whether it is the request line
std::optional<Refusal> read_line_of_head(std::string_view line, bool first, Framing& framing) {
  if (line.size() > kMaxLineBytes) {
    return Refusal{first ? 414 : 431,
                   "a line of the head is longer than " + std::to_string(kMaxLineBytes) + " bytes"};
  }
  if (!first) return read_header_line(line, framing);
  framing.may_lack_host = line.ends_with(" HTTP/1.0");
  return find_fault_in_request_line(line);
}

/// Takes the first line off a head, without its line end.
std::string_view take_head_line(std::string_view& head) {
  const std::string_view line = head.substr(0, head.find("\r\n"));
  head.remove_prefix(line.size() + 2);
  return line;
}

/// The name in a Host header: no port, no brackets, no dot at its end, in lower case. Empty where anything
/// but a port follows the name.
std::string bare_host(const std::string& host) {
  std::string name = lower(host);
  const bool bracketed = name.starts_with('[');
  const auto end = bracketed ? name.find(']') : std::min(name.find(':'), name.size());
  if (end == std::string::npos) return "";
  const std::string_view port = std::string_view(name).substr(bracketed ? end + 1 : end);
  if (!port.empty() && (port[0] != ':' || port.find_first_not_of("0123456789", 1) != std::string_view::npos))
    return "";
  if (bracketed) return name.substr(1, end - 1);
  name.resize(end);
  if (name.ends_with('.')) name.pop_back();
  return name;
}

}  // namespace

std::string_view raw_path_of(std::string_view head) {
  const std::string_view line = head.substr(0, head.find("\r\n"));
  const auto start = line.find(' ');
  if (start == std::string_view::npos) return {};
  const std::string_view target = line.substr(start + 1);
  return target.substr(0, target.find_first_of(" ?#"));
}

std::string raw_header_of(std::string_view head, std::string_view name) {
  while (!head.empty()) {
    const std::string_view line = head.substr(0, head.find("\r\n"));
    if (line.empty()) break;
    head.remove_prefix(std::min(line.size() + 2, head.size()));
    const auto colon = line.find(':');
    if (colon != std::string_view::npos && lower(line.substr(0, colon)) == name)
      return std::string(trimmed(line.substr(colon + 1)));
  }
  return "";
}

std::optional<Refusal> find_fault_in_head(std::string_view head, std::size_t body_bytes) {
  Framing framing;
  bool first = true;
  while (!head.empty()) {
    const auto end = head.find("\r\n");
    if (end == std::string_view::npos) return Refusal{400, "the head is incomplete"};
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(end + 2);
    if (has_control_character(line)) return Refusal{400, "the head holds a control character"};
    if (line.empty()) break;
    if (auto fault = read_line_of_head(line, first, framing)) return fault;
    first = false;
  }
  return find_fault_in_framing(framing, body_bytes);
}

RequestHead read_head(std::string_view head) {
  RequestHead result;
  const std::string_view host = read_request_line(take_head_line(head), result);
  for (std::string_view line = take_head_line(head); !line.empty(); line = take_head_line(head)) {
    const auto colon = line.find(':');
    const std::string_view value = trimmed(line.substr(colon + 1));
    const auto [header, is_first] = result.headers.try_emplace(lower(line.substr(0, colon)), value);
    if (!is_first) header->second.append(", ").append(value);
  }
  // The Host header beside it is not to be looked at (RFC 9112, section 3.2.2).
  if (!host.empty()) result.headers["host"] = host;
  return result;
}

/// @returns whether a name is written out: one with an escape stands for another
static bool is_plain_name(std::string_view host) {
  constexpr std::string_view kSigns = ".-_:[]";
  return std::ranges::all_of(host, [&](unsigned char c) { return is_alphanumeric_or(c, kSigns); });
}

OriginCheck::OriginCheck(std::string bound_host, std::vector<std::string> allowed,
                         std::vector<std::string> names)
    : bound_host_(lower(bound_host)), allowed_(std::move(allowed)), names_(std::move(names)) {
  std::ranges::transform(allowed_, allowed_.begin(), normal_origin);
}

bool OriginCheck::is_allowed(const std::string& origin) const {
  return std::ranges::find(allowed_, normal_origin(origin)) != allowed_.end();
}

std::optional<Refusal> OriginCheck::find_fault(const Headers& headers) const {
  const bool is_open = headers.any_host && is_plain_name(headers.host);
  if (!is_open && !names_this_server(headers.host))
    return Refusal{403, "this service does not answer under the name in Host"};
  if (is_allowed(headers.origin)) return std::nullopt;
  if (!headers.origin.empty() && !is_own(headers.origin, headers.host)) {
    return Refusal{403, "requests of other sites are refused"};
  }
  const std::string& site = headers.fetch_site;
  if (site.empty() || site == "same-origin" || site == "none") return std::nullopt;
  // A link on another page may be followed: it changes nothing and the other page does not see the answer.
  const bool follows_link =
      (headers.method == "GET" || headers.method == "HEAD") && headers.fetch_mode == "navigate";
  if (follows_link) return std::nullopt;
  return Refusal{403, "requests of other sites are refused"};
}

bool OriginCheck::names_this_server(const std::string& host) const {
  const std::string name = bare_host(host);
  return name == "localhost" || name == "127.0.0.1" || name == "::1" ||
         (!name.empty() && name == bound_host_) || std::ranges::find(names_, name) != names_.end();
}

bool OriginCheck::is_own(const std::string& origin, const std::string& host) const {
  const std::string own = normal_origin(origin);
  if (own == normal_origin("http://" + host)) return true;
  // A proxy that speaks https passes its own name on.
  return std::ranges::find(names_, bare_host(host)) != names_.end() &&
         own == normal_origin("https://" + host);
}

std::string normal_origin(std::string_view origin) {
  std::string normal = lower(origin);
  const auto host = normal.find("://");
  const auto colon = normal.rfind(':');
  const bool in_brackets = colon != std::string::npos && normal.find(']', colon) != std::string::npos;
  if (host == std::string::npos || colon <= host || in_brackets) return normal;
  const std::string_view port = std::string_view(normal).substr(colon + 1);
  const std::string_view own = normal.starts_with("https:")  ? "443"
                               : normal.starts_with("http:") ? "80"
                                                             : "";
  if (port.empty() || port == own) normal.resize(colon);
  return normal;
}

/// @returns whether no segment of a path is empty, "." or "..", or has a sign that must be encoded
static bool has_valid_segments(std::string_view path) {
  constexpr std::string_view kSigns = "-._~!$&'()*+;=:@%";
  while (!path.empty()) {
    path.remove_prefix(1);
    const std::string_view segment = path.substr(0, path.find('/'));
    path.remove_prefix(segment.size());
    const bool good =
        std::ranges::all_of(segment, [&](unsigned char c) { return is_alphanumeric_or(c, kSigns); });
    if (!good || segment.empty() || segment == "." || segment == "..") return false;
  }
  return true;
}

std::optional<std::string> find_base_path(std::string_view text) {
  std::string path;
  while (!text.empty()) {
    std::string_view part = trimmed(text.substr(0, text.find(',')));
    text.remove_prefix(std::min(text.find(','), text.size() - 1) + 1);
    while (part.ends_with('/')) part.remove_suffix(1);
    if (!part.empty() && !part.starts_with('/')) return std::nullopt;
    path += part;
  }
  if (path.size() > kMaxPathBytes || !has_valid_segments(path)) return std::nullopt;
  return path;
}

bool is_address(const std::string& host) {
  in6_addr address{};  // the larger of the two
  return inet_pton(AF_INET, host.c_str(), &address) == 1 || inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

bool is_loopback(const std::string& host) {
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  in6_addr v6{};
  if (inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_LOOPBACK(&v6) != 0;
  return host == "localhost";
}

}  // namespace server
