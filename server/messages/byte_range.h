// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "server/messages/message.h"

namespace server {

/// Answer with a file that may be fetched in parts (RFC 9110, section 14), so that a download that broke off
/// can go on: 200 with all of it, 206 with the one range that the request names, or 416. A request for
/// several ranges, or one whose If-Range is another tag, gets all of it.
/// @param etag  of the file's bytes, in its quotes
[[nodiscard]] Response answer_with_file(const Request& request, Response response,
                                        std::shared_ptr<FileBody> file, std::string_view etag);

}  // namespace server
