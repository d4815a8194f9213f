// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace server {

/// Status and reason of a request that is not served.
struct Refusal {
  int status;
  std::string detail;
};

/// Longest path, and longest line of a head, that are looked at.
inline constexpr std::size_t kMaxPathBytes = 512;
inline constexpr std::size_t kMaxLineBytes = 8000;

/// Path of a request line, not decoded: for a limit that depends on the path. Empty if there is none.
[[nodiscard]] std::string_view raw_path_of(std::string_view head);

/// Value of a header in a head that may be faulty or not whole; empty if it is missing.
/// @param name  in lower case
[[nodiscard]] std::string raw_header_of(std::string_view head, std::string_view name);

/// Examines the head of a request as it came off the wire, before anything else reads it: two readers that
/// understand a head differently are how one request is smuggled inside another.
/// @param head        request line and header lines, up to and with the empty line
/// @param body_bytes  largest Content-Length
/// @returns what is wrong with it, if anything
[[nodiscard]] std::optional<Refusal> find_fault_in_head(std::string_view head, std::size_t body_bytes);

/// A head that has passed find_fault_in_head, taken literally: nothing but the target is decoded, and that
/// once.
struct RequestHead {
  std::string request_line;  ///< without its line end, and with "/" in the place of the target
  std::string path;          ///< percent-decoded
  /// Keys and values, percent-decoded, with blanks for "+".
  std::vector<std::pair<std::string, std::string>> query;
  /// Values by name in lower case. Lines of one name are one list (RFC 9110, section 5.3).
  std::map<std::string, std::string> headers;
};

[[nodiscard]] RequestHead read_head(std::string_view head);

/// Examines what names this server and where a request comes from. A page of another site that a user's
/// browser shows must not reach this service, neither under a name that resolves to it nor by a form or a
/// script.
class OriginCheck {
 public:
  /// @param bound_host  the address the server is bound to; it and the names of the loopback are good
  /// @param allowed     other sites whose pages may ask, as "https://lab.example.org"
  /// @param names       other names under which clients reach this server, perhaps through a proxy that
  /// speaks https, in lower case
  explicit OriginCheck(std::string bound_host, std::vector<std::string> allowed = {},
                       std::vector<std::string> names = {});

  /// Headers about the origin of a request; an empty text is a header that is missing.
  struct Headers {
    std::string method;
    std::string host;
    std::string origin;
    std::string fetch_site;  ///< Sec-Fetch-Site
    std::string fetch_mode;  ///< Sec-Fetch-Mode
    bool any_host = false;   ///< the path is one that is served under every name without escapes
  };

  [[nodiscard]] std::optional<Refusal> find_fault(const Headers& headers) const;

  /// @returns whether an origin is one of the other sites whose pages may ask
  [[nodiscard]] bool is_allowed(const std::string& origin) const;

 private:
  [[nodiscard]] bool names_this_server(const std::string& host) const;
  /// @returns whether an origin is that of this server's own page
  [[nodiscard]] bool is_own(const std::string& origin, const std::string& host) const;

  std::string bound_host_;
  std::vector<std::string> allowed_;
  std::vector<std::string> names_;
};

/// Scheme, host and port of an origin as browsers send it: in lower case, without the port that the scheme
/// has anyway. "HTTPS://Lab.example.org:443" is "https://lab.example.org".
[[nodiscard]] std::string normal_origin(std::string_view origin);

/// Path under which a proxy shows the service, as "/rpsup" or "/user/a/proxy/8080": without a slash at its
/// end; empty for "/".
/// @param text  that of an option, or of an X-Forwarded-Prefix header, in which each proxy adds its own after
///     a comma
/// @returns nothing if it is no path: it must begin with one slash, and have no empty, "." or ".." segment
[[nodiscard]] std::optional<std::string> find_base_path(std::string_view text);

/// True for an IP address, of either version.
[[nodiscard]] bool is_address(const std::string& host);

/// True for an address or name that only this machine reaches: 127.0.0.0/8, ::1, localhost.
[[nodiscard]] bool is_loopback(const std::string& host);

}  // namespace server
