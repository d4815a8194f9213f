// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "server/http/request_head.h"

namespace server {

/// Form of a body, from the head.
struct BodyForm {
  bool chunked = false;        ///< else content_length counts
  std::size_t content_length = 0;
  std::string coding{};        ///< Content-Encoding: "", "identity", "gzip" or "deflate"
};

/// Takes bytes off the wire. @returns how many there were, at most `size`; 0 or less at the end, after an
/// error, or too late
using ReadBytes = std::function<std::ptrdiff_t(char* to, std::size_t size)>;

/// Reads the body of a request and decodes it: chunks with extensions and trailers, which say nothing to this
/// service (RFC 9112, section 7.1), and gzip of one member or several (RFC 1952, section 2.2), each with the
/// checksum at its end.
/// @param body_bytes  largest body after decoding
/// @param body        becomes the body
/// @returns what is wrong with it, if anything
[[nodiscard]] std::optional<Refusal> read_request_body(const ReadBytes& read, const BodyForm& form,
                                                       std::size_t body_bytes, std::string& body);

}  // namespace server
