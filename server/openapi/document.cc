// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/document.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string>

#include "jobs/base/program_info.h"
#include "server/messages/problem.h"
#include "server/openapi/request_parameters.h"
#include "server/openapi/request_schemas.h"
#include "server/openapi/resource_schemas.h"
#include "server/openapi/schema_parts.h"

namespace server::openapi {

namespace {

constexpr std::array kProblemsOfAll{400, 401, 403, 408, 413, 414, 431, 500, 501, 503};

/// Problems of a route's requests: those of any route, and its own.
std::set<int> problems_of(const Route& route) {
  std::set<int> problems(kProblemsOfAll.begin(), kProblemsOfAll.end());
  problems.insert(route.problems.begin(), route.problems.end());
  if (!route.body.empty() || route.method == "POST") problems.insert(415);
  if (route.method != "GET") problems.insert(507);
  if (changes_existing(route)) problems.insert(412);
  return problems;
}

/// "NotFound" for 404.
std::string problem_name(int status) {
  std::string name(status_phrase(status));
  std::erase(name, ' ');
  return name;
}

/// The headers of answers beside those that HTTP itself and browsers' safety need.
Json make_headers() {
  const Json text{{"type", "string"}};
  return {
      {"Location",
       {{"description", "Path of what was made; behind a proxy that of the proxy stands before it"},
        {"required", true},
        {"schema", {{"type", "string"}, {"pattern", "^(/[^?#]*)?/v1/"}}}}},
      {"ETag", {{"description", "For If-None-Match and If-Match; only on what has ended"}, {"schema", text}}},
      {"Preference-Applied",
       {{"description", "The wait that was done; without it there was none"},
        {"schema", {{"type", "string"}, {"pattern", "^wait=[0-9]+$"}}}}},
      {"Content-Disposition",
       {{"description", "A name for the file, in forms that are saved rather than read"}, {"schema", text}}},
      {"Accept-Ranges",
       {{"description", "bytes: a request with Range gets a part"},
        {"schema", {{"type", "string"}, {"const", "bytes"}}}}},
      {"Content-Range", {{"description", "First and last byte of the part, and the size"}, {"schema", text}}},
      {"Retry-After",
       {{"description", "Seconds after which to try again"}, {"schema", {{"type", "integer"}}}}},
      {"X-Request-Id", {{"description", "What the log calls the request"}, {"schema", text}}}};
}

void add_header_to(Json& answer, const std::string& name) {
  answer["headers"][name] = {{"$ref", "#/components/headers/" + name}};
}

Json make_problem_answer(int status) {
  Json answer{{"description", status_phrase(status)},
              {"content", {{"application/problem+json", {{"schema", ref("Problem")}}}}}};
  add_header_to(answer, "X-Request-Id");
  if (status == 429 || status == 503) add_header_to(answer, "Retry-After");
  if (status == 416) add_header_to(answer, "Content-Range");
  return answer;
}

/// @returns whether browsers save an answer of this form instead of showing it
bool is_saved(const AnswerForm& form) {
  constexpr std::array<std::string_view, 5> kSaved{"text/csv", "application/x-npz", "application/x-hdf5",
                                                   "application/x-matlab-data", "application/vnd.sqlite3"};
  return std::ranges::find(kSaved, form.media_type) != kSaved.end();
}

/// An answer that is no problem, without its body.
Json make_answer(const Route& route, int status) {
  Json answer{{"description", status_phrase(status)}};
  add_header_to(answer, "X-Request-Id");
  if (status == 201) add_header_to(answer, "Location");
  if (std::ranges::find(route.bodiless, 304) != route.bodiless.end()) add_header_to(answer, "ETag");
  if (std::ranges::find(route.headers, "prefer") != route.headers.end())
    add_header_to(answer, "Preference-Applied");
  if (std::ranges::any_of(route.answers, is_saved)) add_header_to(answer, "Content-Disposition");
  return answer;
}

Json make_success(const Route& route, int status) {
  Json answer = make_answer(route, status);
  if (route.partial) add_header_to(answer, "Accept-Ranges");
  if (status == 206) add_header_to(answer, "Content-Range");
  for (const AnswerForm& form : route.answers)
    answer["content"][std::string(form.media_type)]["schema"] = openapi::ref(form.schema);  // not std::ref
  return answer;
}

void add_parameters_to(Json& operation, const Route& route) {
  if (route.pattern.find("{id}") != std::string_view::npos)
    operation["parameters"].push_back({{"$ref", "#/components/parameters/id"}});
  for (const auto* ids : {&route.query, &route.headers}) {
    for (const std::string_view id : *ids)
      operation["parameters"].push_back({{"$ref", "#/components/parameters/" + std::string(id)}});
  }
  if (changes_existing(route))
    operation["parameters"].push_back({{"$ref", "#/components/parameters/if_match"}});
}

Json make_request_body(const Route& route) {
  Json body{{"required", true},
            {"content", {{"application/json", {{"schema", openapi::ref(route.body)}}}}}};
  for (const AnswerForm& form : route.other_bodies)
    body["content"][std::string(form.media_type)]["schema"] = openapi::ref(form.schema);
  return body;
}

Json make_responses(const Route& route) {
  Json responses = Json::object();
  responses[std::to_string(route.success)] = make_success(route, route.success);
  for (const OtherAnswer& other : route.other_answers) {
    Json answer = make_answer(route, other.status);
    answer["content"][std::string(other.form.media_type)]["schema"] = openapi::ref(other.form.schema);
    responses[std::to_string(other.status)] = std::move(answer);
  }
  if (route.partial) responses["206"] = make_success(route, 206);
  for (const int status : route.bodiless) responses[std::to_string(status)] = make_answer(route, status);
  for (const int status : problems_of(route))
    responses[std::to_string(status)] = {{"$ref", "#/components/responses/" + problem_name(status)}};
  return responses;
}

Json make_operation(const Route& route) {
  Json operation{{"operationId", route.operation_id}, {"tags", {route.tag}}, {"summary", route.summary}};
  add_parameters_to(operation, route);
  if (!route.body.empty()) operation["requestBody"] = make_request_body(route);
  operation["responses"] = make_responses(route);
  return operation;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

Json make_paths(std::span<const Route> routes) {
  Json paths = Json::object();
  for (const Route& route : routes)
    paths[std::string(route.pattern)][lower_case(route.method)] = make_operation(route);
  return paths;
}

Json make_parameters() {
  Json parameters{{"id", {{"name", "id"}, {"in", "path"}, {"required", true}, {"schema", ref("Id")}}}};
  for (const RequestParameter& parameter : request_parameters()) {
    Json& made = parameters[std::string(parameter.id)];
    made = {{"name", parameter.name},
            {"in", parameter.in},
            {"description", parameter.help},
            {"schema", parameter.schema}};
    // Lists are one key with commas; of an object each member is a key.
    if (parameter.in == "query") made["explode"] = parameter.schema.value("type", "") == "object";
  }
  return parameters;
}

Json make_problem_answers(std::span<const Route> routes) {
  std::set<int> met;
  for (const Route& route : routes) met.merge(problems_of(route));
  Json answers = Json::object();
  for (const int status : met) answers[problem_name(status)] = make_problem_answer(status);
  return answers;
}

Json make_schemas() {
  Json schemas = make_request_schemas();
  schemas.update(make_resource_schemas());
  return schemas;
}

/// None is needed where the service was started without a token.
Json make_security_schemes() {
  return {{"bearer",
           {{"type", "http"},
            {"scheme", "bearer"},
            {"description", "The token that the service was started with, if it was"}}},
          {"basic",
           {{"type", "http"},
            {"scheme", "basic"},
            {"description", "The same token as the password of any user"}}}};
}

Json make_info() {
  return {{"title", "RPSUP parameter studies"},
          {"version", jobs::kProgramVersion},
          {"description",
           "Simulates the RPSUP linkage over sweeps of its parameters, keeps peaks and trajectories, and "
           "hands them out. Units stand in the names; whatever answers GET answers HEAD, too."}};
}

}  // namespace

nlohmann::ordered_json make_document(std::span<const Route> routes) {
  return {{"openapi", "3.1.0"},
          {"info", make_info()},
          {"servers", {{{"url", ".."}}}},  // relative to /v1/openapi.json
          {"security", {Json::object(), {{"bearer", Json::array()}}, {{"basic", Json::array()}}}},
          {"paths", make_paths(routes)},
          {"components",
           {{"schemas", make_schemas()},
            {"parameters", make_parameters()},
            {"headers", make_headers()},
            {"responses", make_problem_answers(routes)},
            {"securitySchemes", make_security_schemes()}}}};
}

}  // namespace server::openapi
