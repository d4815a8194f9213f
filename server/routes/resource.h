// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "server/messages/message.h"
#include "server/messages/problem.h"
#include "server/routing/call.h"

namespace server {

/// Something that is made, computed and then stays as it is: a job, a sweep, a study.
struct Resource {
  std::string path;  ///< of all of them, with a '/' at its end
  std::function<std::optional<nlohmann::json>(const std::string& id)> find;
  std::function<void(const std::string& id, std::chrono::seconds at_most)> wait_for;
  std::function<bool(const nlohmann::json&)> has_ended;
  std::function<HttpError(const std::string& id)> missing;
};

/// 201 and where it is; as it is at its end, if the client prefers to wait and it ends by then.
/// @param made  as it was made
[[nodiscard]] Response answer_made(const Call& call, const Resource& resource, nlohmann::json made);

/// The one that the path names, with an ETag once it has ended; at its end, if the client prefers to wait and it ends by then.
/// @throws HttpError 404 if there is none
[[nodiscard]] Response answer_found(const Call& call, const Resource& resource);

/// The one that the path names, as a request has changed it.
/// @param changed  empty: there is none
/// @throws HttpError 404 if there is none
[[nodiscard]] Response answer_changed(const Call& call, const Resource& resource, const std::optional<nlohmann::json>& changed);

}  // namespace server
