#include "server/routes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>

#include "server/error_answer.h"
#include "server/job_routes.h"
#include "server/page_routes.h"
#include "server/problem.h"
#include "server/store_route.h"
#include "server/sweep_events.h"
#include "server/sweep_routes.h"

namespace server {

namespace {

struct Route {
  std::string_view method;
  std::string_view pattern;  ///< {id} stands for one segment that is_id
  Response (*handler)(const Call&);
};

constexpr std::array kRoutes = {
    Route{"POST", "/v1/sweeps", post_sweep},
    Route{"GET", "/v1/sweeps", get_sweeps},
    Route{"GET", "/v1/sweeps/{id}", get_sweep},
    Route{"DELETE", "/v1/sweeps/{id}", delete_sweep},
    Route{"GET", "/v1/sweeps/{id}/results", get_results},
    Route{"GET", "/v1/sweeps/{id}/events", get_events},
    Route{"POST", "/v1/sweeps/{id}/cancel", cancel_sweep},
    Route{"POST", "/v1/sweeps/{id}/retry", retry_sweep},
    Route{"POST", "/v1/sweeps/{id}/extend", extend_sweep},
    Route{"POST", "/v1/jobs", post_job},
    Route{"GET", "/v1/jobs", get_jobs},
    Route{"GET", "/v1/jobs/{id}", get_job},
    Route{"POST", "/v1/jobs/{id}/cancel", cancel_job},
    Route{"GET", "/v1/jobs/{id}/trajectory", get_trajectory},
    Route{"GET", "/v1/parameters", get_parameters},
    Route{"GET", "/v1/store", get_store},
    Route{"GET", "/healthz", get_health},
    Route{"GET", "/readyz", get_readiness},
    Route{"GET", "/", get_page_file},
};

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

Response Routes::answer(const Request& request) const {
  try {
    return dispatch(request);
  } catch (...) {
    return make_error_answer(std::current_exception(), request.id);
  }
}

Response Routes::dispatch(const Request& request) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  std::string allowed;
  for (const Route& route : kRoutes) {
    auto id = match(route.pattern, request.path);
    if (!id) continue;
    if (route.method == method) {
      if (draining_ && changes_something(method)) return make_retry_later(503, "the service is shutting down");
      return route.handler({service_, request, std::move(*id), draining_, waiting_room_, copying_});
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(route.method == "GET" ? "GET, HEAD" : route.method);
  }
  if (allowed.empty() && is_page_file(request.path)) {
    if (method == "GET") return make_file_answer(request.path);
    allowed = "GET, HEAD";
  }
  if (!allowed.empty()) return make_wrong_method(allowed);
  throw HttpError(404, "there is nothing at " + request.path);
}

bool is_id(const std::string& text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

std::string find_key(const Request& request) {
  constexpr std::size_t kLongest = 255;
  if (!request.idempotency_key) return "";
  std::string_view key = *request.idempotency_key;
  if (key.size() > 2 && key.front() == '"' && key.back() == '"') key = key.substr(1, key.size() - 2);
  const bool visible = std::all_of(key.begin(), key.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (key.empty() || key.size() > kLongest || !visible) {
    throw HttpError(400, "Idempotency-Key must be 1 to " + std::to_string(kLongest) + " visible ASCII characters");
  }
  return std::string(key);
}

Response make_json(int status, std::string text) {
  return {.status = status, .content_type = "application/json", .body = std::move(text) + "\n", .headers = {}};
}

}  // namespace server
