// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "jobs/service.h"
#include "server/context/request_context.h"
#include "server/messages/message.h"
#include "server/messages/problem.h"

namespace server {

/// What has happened to what is followed since a change; empty if it is not there (any more).
using FindNews = std::function<std::optional<jobs::SweepNews>(std::int64_t after)>;

/// Server-sent events of a sweep or a study:
///
///     progress   how far it is, at the beginning and whenever that changes
///     job        a job that has ended; first those that had ended before
///     done       how far it is at its end; the last one
///
/// The ids of `job` and `done` are what Last-Event-ID resumes from. Who has had `done`, and asks again, gets 204, which tells a
/// browser's EventSource to ask no more.
/// @param missing  thrown if there is nothing to follow
[[nodiscard]] Response answer_events(const RequestContext& context, FindNews find_news, const HttpError& missing);

}  // namespace server
