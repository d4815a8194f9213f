// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "server/routes/routes.h"

namespace server {

struct HttpOptions {
  std::string address = "127.0.0.1";  ///< an IP address, not a name
  int port = 8080;                    ///< 0: any free one
  std::vector<std::string>
      cors_origins{};  ///< other sites whose pages may ask, as "https://lab.example.org", in lower case
  std::vector<std::string>
      names{};  ///< other names under which clients reach this server, as "rpsup.example.org", in lower case
  std::string token{};                      ///< that every request must carry, see AccessCheck; empty: none
  /// Path under which a proxy shows the service, as "/rpsup"; see find_base_path(). Requests may come with it
  std::string base_path{};
};

struct HttpLimits;

/// Serves routes over HTTP/1.1: one request a connection, within limits, to clients that may ask.
///
/// cpp-httplib sees an empty request. GuardedServer reads and checks the head, and gives the library method
/// and version alone, with "/" as the target. Path, query and headers are filled in afterwards (fill() in
/// http_guard.cc): so the library decodes, drops and parses none of them. Headers on which it would act, it
/// gets under names that it does not know (kRange, kAcceptEncoding). Handlers here take the body off the
/// wire, ask the routes, and copy their answer to the library, which sends it. A mark (kHasRanges in http.cc)
/// tells in the end which headers are an answer's own and which the library's.
class HttpServer {
 public:
  /// @param routes  outlives this
  HttpServer(const Routes& routes, const HttpOptions& options);
  HttpServer(const Routes& routes, const HttpOptions& options, const HttpLimits& limits);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Binds; clients may connect from here on.
  /// @returns the port; 0 if it could not be bound, because another process has it say
  int bind();

  /// Serves until stop(). False if it could not.
  bool listen();

  /// Ends listen() within HttpLimits::drain_time, after the answers that are under way. From any thread;
  /// bind() came before.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace server
