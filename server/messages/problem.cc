// SPDX-License-Identifier: Apache-2.0
#include "server/messages/problem.h"

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "server/messages/json_text.h"

namespace server {

namespace {

constexpr std::size_t kMostFaults = 100;  // a request of 8 MiB may have a million of them

/// Text about the faults that an answer has no room for; empty if there are none.
std::string describe_left_out(std::size_t faults) {
  return faults > kMostFaults ? "; " + std::to_string(faults - kMostFaults) + " more are left out here" : "";
}

}  // namespace

std::string_view status_phrase(int status) {
  switch (status) {
    case 200: return "OK";
    case 201: return "Created";
    case 204: return "No Content";
    case 206: return "Partial Content";
    case 304: return "Not Modified";
    case 308: return "Permanent Redirect";
    case 400: return "Bad Request";
    case 401: return "Unauthorized";
    case 403: return "Forbidden";
    case 404: return "Not Found";
    case 405: return "Method Not Allowed";
    case 408: return "Request Timeout";
    case 409: return "Conflict";
    case 412: return "Precondition Failed";
    case 413: return "Content Too Large";
    case 414: return "URI Too Long";
    case 415: return "Unsupported Media Type";
    case 416: return "Range Not Satisfiable";
    case 422: return "Unprocessable Content";
    case 429: return "Too Many Requests";
    case 431: return "Request Header Fields Too Large";
    case 500: return "Internal Server Error";
    case 501: return "Not Implemented";
    case 503: return "Service Unavailable";
    case 507: return "Insufficient Storage";
    default: return "Error";
  }
}

Response make_problem(int status, const std::string& detail, const std::vector<jobs::Fault>& faults) {
  nlohmann::ordered_json problem = {{"type", "about:blank"},
                                    {"title", status_phrase(status)},
                                    {"status", status},
                                    {"detail", detail + describe_left_out(faults.size())}};
  for (std::size_t i = 0; i < std::min(faults.size(), kMostFaults); ++i) {
    problem["errors"].push_back({{"pointer", faults[i].pointer}, {"detail", faults[i].detail}});
  }
  return {.status = status,
          .content_type = "application/problem+json",
          .body = to_text(problem) + "\n",
          .headers = {}};
}

}  // namespace server
