// SPDX-License-Identifier: Apache-2.0
#include "server/routes/routes.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <utility>

#include "server/messages/conditional.h"
#include "server/messages/error_answer.h"
#include "server/messages/identifiers.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
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

/// A key or a value of a query as it stands in an address.
std::string percent_encoded(std::string_view part) {
  constexpr std::string_view kSigns = "-._~,:";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const unsigned char c : part) {
    if (is_alphanumeric_or(c, kSigns)) text += static_cast<char>(c);
    else (text += '%') += {kDigits[c >> 4U], kDigits[c & 15U]};
  }
  return text;
}

std::string address_query(const Request& request) {
  std::string text;
  for (const auto& [key, value] : request.query)
    text += (text.empty() ? "?" : "&") + percent_encoded(key) + "=" + percent_encoded(value);
  return text;
}

bool changes_something(std::string_view method) {
  return method == "POST" || method == "PATCH" || method == "DELETE";
}

/// The route that answers GET with what a route changes: at the same path, or without the action at its end.
const Route* find_changed(const Route& route) {
  const auto is_read_at = [](std::string_view pattern) {
    return [=](const Route& other) { return other.method == "GET" && other.pattern == pattern; };
  };
  const auto table = route_table();
  auto found = std::ranges::find_if(table, is_read_at(route.pattern));
  if (found == table.end())
    found = std::ranges::find_if(table, is_read_at(route.pattern.substr(0, route.pattern.rfind('/'))));
  return found == table.end() ? nullptr : &*found;
}

/// GET of what a request changes.
Request make_get_of(const Request& request) {
  return {.method = "GET", .path = request.path, .query = {}, .accept = {}, .body = {}, .id = request.id,
          .base_path = request.base_path};
}

Response make_wrong_method(const std::string& allowed) {
  Response response = make_problem(405, "this path allows: " + allowed);
  response.headers.emplace_back("Allow", allowed);
  return response;
}

/// Leads from a path with a slash too many to the one that is meant, or says which.
/// @throws HttpError 404
Response answer_unknown_path(const Request& request, const std::string& method) {
  std::string_view meant = request.path;
  while (meant.size() > 1 && meant.ends_with('/')) meant.remove_suffix(1);
  const bool known = meant.size() < request.path.size() && meant.size() > 1 &&
                     (is_page_file(meant) || std::ranges::any_of(route_table(), [&](const Route& route) {
                        return match(route.pattern, meant).has_value();
                      }));
  if (!known) throw HttpError(404, "there is nothing at " + request.path);
  if (method != "GET")
    throw HttpError(404, "there is nothing at " + request.path + "; " + std::string(meant) +
                             ", without a slash at its end, is meant");
  std::string up;
  for (std::size_t k = meant.size(); k < request.path.size(); ++k) up += "../";
  return make_redirect(up + std::string(meant.substr(meant.rfind('/') + 1)) + address_query(request));
}

}  // namespace

bool is_heavy(const Route& route, const Request& request) {
  constexpr std::size_t kLargeBody = 64 * 1024;
  constexpr std::size_t kLargePage = 1000;
  return route.work == Work::kLarge || request.body.size() > kLargeBody ||
         Query(request, {}, Query::Others::kKept).count("limit").value_or(0) > kLargePage;
}

Routes::Routes(jobs::Service& service, std::shared_ptr<Metrics> metrics)
    : service_(service), metrics_(std::move(metrics)) {
  remove_left_over_files(service.store_file());
}

void Routes::give_memory_back() {
  constexpr std::size_t kMuch = std::size_t{48} << 20U;
  // Long texts leave holes that the allocator keeps.
  if (::mallinfo2().fordblks > kMuch) ::malloc_trim(0);
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
  metrics_->add_request(request.method, pattern, response.status, took.count());
  return response;
}

Response Routes::dispatch(const Request& request, std::string_view& pattern) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  std::string allowed;
  for (const Route& route : route_table()) {
    auto id = match(route.pattern, request.path);
    if (!id) continue;
    pattern = route.pattern;
    if (route.method == method) return run_route(route, request, std::move(*id));
    allowed +=
        (allowed.empty() ? "" : ", ") + std::string(route.method == "GET" ? "GET, HEAD" : route.method);
  }
  if (!allowed.empty()) return make_wrong_method(allowed);
  if (!is_page_file(request.path)) return answer_unknown_path(request, method);
  pattern = "/";  // of what the page is made of; only the page names it
  return method == "GET" ? make_file_answer(request, request.path) : make_wrong_method("GET, HEAD");
}

Response Routes::run_route(const Route& route, const Request& request, std::string id) const {
  if (draining_ && changes_something(route.method))
    return make_retry_later(503, "the service is shutting down");
  const bool heavy = is_heavy(route, request);
  WorkPermit permit(heavy ? &heavy_limit_ : nullptr);
  if (!permit.acquire()) return make_retry_later(503, WorkPermit::kRefusal);
  const auto answer_by = [&](const Route& one, const Request& asked) {
    return one.handler({service_, asked, id, draining_, *metrics_, long_poll_limit_, store_copy_limit_,
                        stream_limit_, export_limit_, permit});
  };
  if (heavy && route.method == "GET") return with_permit_to_send(answer_by(route, request));
  if (!changes_existing(route)) return answer_by(route, request);
  if (request.if_match.empty()) {
    const std::shared_lock beside_others(change_mutex_);
    return answer_by(route, request);
  }
  const std::lock_guard alone(change_mutex_);  // nothing changes between the look and the change
  if (const Route* changed = find_changed(route))
    check_if_match(request, answer_by(*changed, make_get_of(request)));
  return answer_by(route, request);
}

Response Routes::with_permit_to_send(Response answer) const {
  constexpr std::size_t kLargeAnswer = 1024 * 1024;
  if (answer.body.size() <= kLargeAnswer) return answer;
  answer.permit = answer_limit_.acquire();
  if (!answer.permit) return make_retry_later(503, "as many large answers are being sent as may; try again");
  return answer;
}

}  // namespace server
