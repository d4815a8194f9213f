// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace server {

/// The parts of a service's URL.
struct ServiceUrl {
  std::string origin;  ///< "http://127.0.0.1:8080"
  std::string prefix;  ///< path in front of every route, "/lab" say, where a proxy serves more than this; no
                       ///< slash at its end
};

/// Takes the URL of a service apart: http or https, a host, perhaps a port and a path.
/// @returns nothing if it is no such URL: another scheme, a query, a name and password
[[nodiscard]] std::optional<ServiceUrl> parse_service_url(const std::string& url);

/// No answer came.
class Unreachable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Asks a service over HTTP, a connection a request.
class HttpClient {
 public:
  struct Answer {
    int status = 0;
    std::string content_type;
    std::string body;
  };

  /// @param token  sent as `Authorization: Bearer`; empty: nothing is sent. Visible ASCII without blanks
  HttpClient(const ServiceUrl& url, const std::string& token);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// @param path    of the route, starts with '/'
  /// @param accept  media type that is wanted
  /// @throws Unreachable
  [[nodiscard]] Answer get(const std::string& path, const std::string& accept);
  /// The same, the body of success given to take() piece by piece instead of kept.
  /// @param take  false: it cannot take more
  [[nodiscard]] Answer get(const std::string& path, const std::string& accept,
                           const std::function<bool(std::string_view)>& take);
  /// @param body  JSON; may be empty
  /// @throws Unreachable
  Answer post(const std::string& path, const std::string& body);
  /// @param path        with its query, if any
  /// @param media_type  of the body
  /// @param key         Idempotency-Key; empty: none is sent
  /// @throws Unreachable
  Answer post(const std::string& path, const std::string& body, const std::string& media_type,
              const std::string& key);
  /// @throws Unreachable
  Answer erase(const std::string& path);

  /// Most time for a connection, and for each part of an answer.
  void set_patience(std::chrono::milliseconds time);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace server
