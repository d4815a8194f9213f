// SPDX-License-Identifier: Apache-2.0
#include "server/routes/resource.h"

#include <utility>

#include "server/messages/conditional.h"
#include "server/messages/json_text.h"

namespace server {

namespace {

/// Waits for the end, if that is preferred. Whether it did.
bool wait_as_preferred(const Call& call, const Resource& resource, const std::string& id, Response& response) {
  return call.waiting_room.wait(call.request, response, [&](std::chrono::seconds time) { resource.wait_for(id, time); });
}

}  // namespace

Response answer_made(const Call& call, const Resource& resource, nlohmann::json made) {
  const std::string id = made.at("id");
  Response response = make_json(201, "");
  if (wait_as_preferred(call, resource, id, response)) made = resource.find(id).value_or(made);
  response.body = to_text(made) + "\n";
  response.headers.emplace_back("Location", resource.path + id);
  return response;
}

Response answer_found(const Call& call, const Resource& resource) {
  Response response = make_json(200, "");
  wait_as_preferred(call, resource, call.id, response);
  const auto found = resource.find(call.id);
  if (!found) throw resource.missing(call.id);
  response.body = to_text(*found) + "\n";
  return with_etag_if(resource.has_ended(*found), call.request, std::move(response));
}

Response answer_changed(const Call& call, const Resource& resource, const std::optional<nlohmann::json>& changed) {
  if (!changed) throw resource.missing(call.id);
  return make_json(200, to_text(*changed));
}

}  // namespace server
