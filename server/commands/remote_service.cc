// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_service.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "jobs/base/errors.h"
#include "server/commands/command.h"
#include "server/commands/service_token.h"
#include "server/messages/json_text.h"

namespace server::commands {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kUnauthorized = 401;
constexpr int kForbidden = 403;
constexpr std::array kBusy{429, 502, 503, 504};  // the others of 5xx are no matter of time
ServiceUrl checked_url(const std::string& url) {
  const auto parsed = parse_service_url(url);
  if (!parsed)
    throw BadInput("--url " + url + ": must be like http://127.0.0.1:8080 or https://lab.example.org/rpsup");
  return *parsed;
}

std::string checked_token(const RemoteOptions& options) {
  std::string token = find_token(options.token_file, nullptr);
  if (token.empty()) token = options.token;
  const bool visible = std::ranges::all_of(token, [](unsigned char c) { return c > ' ' && c < 0x7f; });
  if (!visible) throw BadInput("the token must hold visible ASCII characters only, no blanks");
  return token;
}

std::string text_at(const Json& object, const char* key) {
  const bool there = object.is_object() && object.contains(key) && object.at(key).is_string();
  return there ? object.at(key).get<std::string>() : "";
}

/// The body of a problem (RFC 9457); empty if it is none.
std::optional<Json> find_problem(const HttpClient::Answer& answer) {
  if (!answer.content_type.starts_with("application/problem+json")) return std::nullopt;
  try {
    Json problem = parse_json(answer.body);
    if (!text_at(problem, "detail").empty()) return problem;
  } catch (const BadJson&) {
    // Then something else has answered, with our media type.
  }
  return std::nullopt;
}

std::vector<jobs::Fault> faults_of(const Json& problem) {
  std::vector<jobs::Fault> faults;
  if (!problem.contains("errors")) return faults;
  for (const Json& error : problem.at("errors"))
    faults.push_back({text_at(error, "pointer"), text_at(error, "detail")});
  return faults;
}

/// Value of a query in which each byte but letters and digits is encoded (RFC 3986, section 2.1).
std::string query_encoded(const std::string& value) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const unsigned char c : value) {
    if (c < 0x80 && std::isalnum(c) != 0) text += static_cast<char>(c);
    else (text += '%') += {kDigits[c >> 4U], kDigits[c & 15U]};
  }
  return text;
}

std::string path_of(Kind kind, const std::string& id) { return std::string(info_of(kind).path) + "/" + id; }

std::string with_query(std::string path, const QueryItems& query) {
  const char* separator = "?";
  for (const auto& [key, value] : query) {
    path.append(separator).append(query_encoded(key)).append("=").append(query_encoded(value));
    separator = "&";
  }
  return path;
}

}  // namespace

RemoteService::RemoteService(const RemoteOptions& options)
    : url_(options.url), client_(checked_url(options.url), checked_token(options)) {}

Json RemoteService::submit(Kind kind, const Json& request) {
  return read(client_.post(std::string(info_of(kind).path), to_text(request)));
}

Json RemoteService::submit_measurement(const std::string& text, const std::string& media_type,
                                       const QueryItems& query, const std::string& key) {
  const std::string path(info_of(Kind::kMeasurement).path);
  return read(client_.post(with_query(path, query), text, media_type, key));
}

Json RemoteService::list(Kind kind, const QueryItems& query) {
  return read(client_.get(with_query(std::string(info_of(kind).path), query), kJsonType));
}

Json RemoteService::find(Kind kind, const std::string& id) {
  return read(client_.get(path_of(kind, id), kJsonType));
}

Json RemoteService::change(Kind kind, const std::string& id, std::string_view action, const Json& body) {
  const std::string path = path_of(kind, id) + "/" + std::string(action);
  return read(client_.post(path, body.is_null() ? "" : to_text(body)));
}

void RemoteService::erase(Kind kind, const std::string& id) { check(client_.erase(path_of(kind, id))); }

std::string RemoteService::get_part(Kind kind, const std::string& id, std::string_view part,
                                    const std::string& media_type, const QueryItems& query) {
  const std::string path = path_of(kind, id) + "/" + std::string(part);
  auto answer = client_.get(with_query(path, query), media_type);
  check(answer);
  check_type(answer, media_type);
  return std::move(answer.body);
}

void RemoteService::save_part(Kind kind, const std::string& id, std::string_view part,
                              const std::string& media_type, const QueryItems& query,
                              const std::function<bool(std::string_view)>& take) {
  const std::string path = path_of(kind, id) + "/" + std::string(part);
  const auto answer = client_.get(with_query(path, query), media_type, take);
  check(answer);
  check_type(answer, media_type);
}

void RemoteService::check_type(const HttpClient::Answer& answer, const std::string& media_type) const {
  if (answer.content_type.starts_with(media_type)) return;
  throw std::runtime_error(url_ + " answers, but not as this service does: no " + media_type +
                           ". Is --url right?");
}

std::string RemoteService::page_of(Kind kind, const std::string& id) const {
  const ServiceUrl url = checked_url(url_);
  return url.origin + url.prefix + "/#/" + std::string(info_of(kind).page) + "/" + id;
}

Json RemoteService::read(const HttpClient::Answer& answer) const {
  check(answer);
  try {
    Json json = parse_json(answer.body);
    if (json.is_object()) return json;
  } catch (const BadJson&) {
    // Told below.
  }
  throw std::runtime_error(url_ + " answers, but not as this service does: no JSON object. Is --url right?");
}

void RemoteService::check(const HttpClient::Answer& answer) const {
  if (answer.status >= 200 && answer.status < 300) return;
  const std::string status = std::to_string(answer.status);
  const auto problem = find_problem(answer);
  // Not of this service but of what stands in front of it.
  if (answer.status == kUnauthorized || (answer.status == kForbidden && !problem)) {
    throw BadInput(url_ + " refuses the request (" + status +
                   "): give the right token by --token-file or RPSUP_TOKEN");
  }
  const std::string detail = problem ? text_at(*problem, "detail") : "";
  if (std::ranges::find(kBusy, answer.status) != kBusy.end())
    throw Busy(url_ + " cannot do it now (" + status + ")" + (problem ? ": " + detail : ""));
  if (!problem)
    throw std::runtime_error(url_ + " answers " + status + ", but not as this service does. Is --url right?");
  if (answer.status >= 500) throw std::runtime_error(url_ + " cannot do it now (" + status + "): " + detail);
  auto faults = faults_of(*problem);
  if (!faults.empty()) throw jobs::InvalidRequest(std::move(faults));
  throw BadInput(detail);
}

}  // namespace server::commands
