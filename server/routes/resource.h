// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "server/context/request_context.h"
#include "server/messages/message.h"
#include "server/messages/problem.h"

namespace server {

/// Kind of resource that is created, computed and then final: job, sweep, study.
struct Resource {
  std::string path;  ///< of the collection, with a '/' at its end
  std::function<std::optional<nlohmann::json>(const std::string& id)> find;
  std::function<void(const std::string& id, std::chrono::seconds at_most)> wait_for;
  std::function<bool(const nlohmann::json&)> has_ended;
  std::function<HttpError(const std::string& id)> missing;
};

/// Resource with its links as clients reach them through the proxy of a request.
[[nodiscard]] nlohmann::json under_base_path(const Request& request, nlohmann::json resource);

/// Answers 201 with the Location; with the state at the end, if the client prefers to wait and the end comes
/// by then.
/// @param created  state at its creation
[[nodiscard]] Response respond_created(const RequestContext& context, const Resource& resource,
                                       nlohmann::json created);

/// Answers with the resource that the path names, with an ETag once it has ended; waits for its end if the
/// client prefers to wait.
/// @throws HttpError 404 if there is none
[[nodiscard]] Response respond_found(const RequestContext& context, const Resource& resource);

/// Answers with the resource that the path names, as the request has changed it.
/// @param updated  empty: there is none
/// @throws HttpError 404 if there is none
[[nodiscard]] Response respond_updated(const RequestContext& context, const Resource& resource,
                                       const std::optional<nlohmann::json>& updated);

}  // namespace server
