// SPDX-License-Identifier: Apache-2.0
#include "server/routes/routes.h"

#include <chrono>
#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "server/messages/error_answer.h"
#include "server/messages/identifiers.h"
#include "server/messages/problem.h"
#include "server/messages/safe_log.h"
#include "server/routes/page_routes.h"
#include "server/routes/route_table.h"
#include "server/routes/store_route.h"

namespace server {

namespace {

/// The text in the place of {id} (empty for a pattern without one), if the path is of this pattern.
std::optional<std::string> match(std::string_view pattern, std::string_view path) {
  const auto brace = pattern.find("{id}");
  if (brace == std::string_view::npos) return path == pattern ? std::optional<std::string>("") : std::nullopt;
  const auto before = pattern.substr(0, brace);
  const auto after = pattern.substr(brace + 4);
  if (path.size() < before.size() + after.size() || !path.starts_with(before) || !path.ends_with(after)) {
    return std::nullopt;
  }
  std::string id(path.substr(before.size(), path.size() - before.size() - after.size()));
  return is_id(id) ? std::optional(std::move(id)) : std::nullopt;
}

bool changes_something(const std::string& method) { return method == "POST" || method == "DELETE"; }

Response make_wrong_method(const std::string& allowed) {
  Response response = make_problem(405, "this path allows: " + allowed);
  response.headers.emplace_back("Allow", allowed);
  return response;
}

}  // namespace

Routes::Routes(jobs::Service& service, std::shared_ptr<Metrics> metrics)
    : service_(service), metrics_(std::move(metrics)) {
  remove_left_over_copy(service.store_file());
}

Response Routes::answer(const Request& request) const {
  const auto start = std::chrono::steady_clock::now();
  std::string_view pattern;
  Response response;
  try {
    response = dispatch(request, pattern);
  } catch (...) {
    response = make_error_answer(std::current_exception(), request.id);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  try {
    metrics_->add_request(request.method, pattern, response.status, took.count());
  } catch (const std::bad_alloc&) {  // what has been done is done, and is answered
    log_error("request {} is missing in the metrics: no memory", request.id);
  }
  return response;
}

Response Routes::dispatch(const Request& request, std::string_view& pattern) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  std::string allowed;
  for (const Route& route : route_table()) {
    auto id = match(route.pattern, request.path);
    if (!id) continue;
    pattern = route.pattern;
    if (route.method == method) {
      if (draining_ && changes_something(method))
        return make_retry_later(503, "the service is shutting down");
      return route.handler(
          {service_, request, std::move(*id), draining_, *metrics_, long_poll_limit_, store_copy_limit_});
    }
    allowed +=
        (allowed.empty() ? "" : ", ") + std::string(route.method == "GET" ? "GET, HEAD" : route.method);
  }
  // What the page is made of; only the page names it.
  if (allowed.empty() && is_page_file(request.path)) {
    pattern = "/";
    if (method == "GET") return make_file_answer(request, request.path);
    allowed = "GET, HEAD";
  }
  if (!allowed.empty()) return make_wrong_method(allowed);
  throw HttpError(404, "there is nothing at " + request.path);
}

}  // namespace server
