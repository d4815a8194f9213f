// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "server/messages/message.h"

namespace server {

/// Marks an answer about something that has ended with what names its content, and turns it into 304 without
/// a body if the client has that content. A retry or an extension may start it again, so the client has to
/// ask each time.
[[nodiscard]] Response with_etag(const Request& request, Response response);

/// The same with a tag that is known already, in its quotes. Cache-Control is the caller's.
[[nodiscard]] Response with_etag(const Request& request, Response response, std::string_view etag);

/// Checks that what a request changes is what its client has seen: the answer to GET has a tag of If-Match.
/// @param current  answer to GET now
/// @throws HttpError 412
void check_if_match(const Request& request, const Response& current);

/// Marks an answer about something that still changes.
[[nodiscard]] Response without_etag(Response response);

/// The one or the other.
[[nodiscard]] Response with_etag_if(bool ended, const Request& request, Response response);

}  // namespace server
