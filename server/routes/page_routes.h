// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "server/context/request_context.h"
#include "server/messages/message.h"

namespace server {

/// A file of web/ as an answer, compressed if the client wants that; 304 if the client has it already.
/// @throws HttpError 404 if there is none of that path
[[nodiscard]] Response make_file_answer(const Request& request, std::string_view path);

/// @returns whether there is a file of web/ of that path
[[nodiscard]] bool is_page_file(std::string_view path);

Response get_page_file(
    const RequestContext& context);  ///< a file of the page, by its path; it is part of the program
Response get_health(const RequestContext& context);     ///< 200 as long as the program answers at all
Response get_readiness(const RequestContext& context);  ///< 200 if requests can be served: the store reads,
                                                        ///< and the service is not ending
Response get_metrics(const RequestContext& context);    ///< counts of Metrics, for Prometheus

}  // namespace server
