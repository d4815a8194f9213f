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

/// Finds the news of a sweep or study since a change; empty if it does not exist (any more).
using FindNews = std::function<std::optional<jobs::SweepNews>(std::int64_t after)>;

/// Answers with the server-sent events of a sweep or a study:
///
///     progress   counts of jobs, at the beginning and after every change
///     job        a job that has ended; at first those that had ended before
///     done       progress at the end; the last event
///
/// Last-Event-ID resumes after the id of a `job` or of `done`. A client that resumes after `done` gets 204,
/// which makes a browser's EventSource stop.
/// @param missing  thrown if there is no such sweep or study
[[nodiscard]] Response answer_events(const RequestContext& context, FindNews find_news,
                                     const HttpError& missing);

}  // namespace server
