#pragma once

#include <string>
#include <utility>
#include <vector>

namespace server {

/// A request as the routes see it: no transport in sight.
struct Request {
  std::string method;                                       ///< upper case
  std::string path;                                         ///< percent-decoded, starts with '/'
  std::vector<std::pair<std::string, std::string>> query;   ///< percent-decoded
  std::string accept;                                       ///< of the Accept header; may be empty
  std::string body;
  std::string id;                                           ///< names this request in answers and in the log
};

/// What goes back.
struct Response {
  int status = 200;
  std::string content_type;                                 ///< empty: there is no body
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers; ///< beside Content-Type and Content-Length
};

}  // namespace server
