// SPDX-License-Identifier: Apache-2.0
#include "server/routes/resource.h"

#include <utility>

#include "server/context/work_limit.h"
#include "server/messages/conditional.h"
#include "server/messages/error_answer.h"
#include "server/messages/json_text.h"

namespace server {

namespace {

/// Waits for the end if the client prefers to, without the permit, which others need. True if it waited.
bool wait_as_preferred(const RequestContext& context, const Resource& resource, const std::string& id,
                       Response& response) {
  return context.long_poll_limit.wait(context.request, response, [&](std::chrono::seconds time) {
    context.permit.give_back();
    resource.wait_for(id, time);
  });
}

}  // namespace

nlohmann::json under_base_path(const Request& request, nlohmann::json resource) {
  if (request.base_path.empty() || !resource.contains("links")) return resource;
  for (auto& link : resource.at("links")) {
    if (link.is_string()) link = request.base_path + link.get<std::string>();
  }
  return resource;
}

Response respond_created(const RequestContext& context, const Resource& resource, nlohmann::json created) {
  const std::string id = created.at("id");
  Response response = json_response(201, "");
  // A stored resource is answered in any case: without the permit, as it was created.
  if (wait_as_preferred(context, resource, id, response) && context.permit.acquire())
    created = resource.find(id).value_or(created);
  response.body = to_text(under_base_path(context.request, std::move(created))) + "\n";
  response.headers.emplace_back("Location", context.request.base_path + resource.path + id);
  return response;
}

Response respond_found(const RequestContext& context, const Resource& resource) {
  Response response = json_response(200, "");
  if (wait_as_preferred(context, resource, context.id, response) && !context.permit.acquire())
    return make_retry_later(503, WorkPermit::kRefusal);
  const auto found = resource.find(context.id);
  if (!found) throw resource.missing(context.id);
  response.body = to_text(under_base_path(context.request, *found)) + "\n";
  return with_etag_if(resource.has_ended(*found), context.request, std::move(response));
}

Response respond_updated(const RequestContext& context, const Resource& resource,
                         const std::optional<nlohmann::json>& updated) {
  if (!updated) throw resource.missing(context.id);
  return json_response(200, to_text(under_base_path(context.request, *updated)));
}

}  // namespace server
