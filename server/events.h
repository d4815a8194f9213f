#pragma once

#include "server/message.h"
#include "server/routes.h"

namespace server {

/// Server-sent events of a sweep:
///
///     progress   how far it is, at the beginning and whenever that changes
///     job        a job that has ended; first those that had ended before
///     done       how far it is at its end; the last one
///
/// The ids of `job` and `done` are what Last-Event-ID resumes from. Who has had `done`, and asks again, gets 204, which tells a
/// browser's EventSource to ask no more.
Response get_events(const Call& call);

}  // namespace server
