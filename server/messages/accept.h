// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace server {

/// Media type that an Accept header wants most: the one with the largest weight (q), of those the one whose
/// range stands first, of those the first. A type has the weight of the narrowest range that it is in (RFC
/// 9110, section 12.5.1).
/// @returns its index among the types; empty if none is acceptable, or nothing is said
[[nodiscard]] std::optional<std::size_t> find_accepted(std::string_view accept,
                                                       std::span<const std::string_view> media_types);

/// @returns whether an Accept-Encoding header wants gzip: gzip is acceptable, and its weight is not less than
/// that of no coding (RFC 9110, section 12.5.3). False if nothing is said, as by programs that cannot unpack.
[[nodiscard]] bool wants_gzip(std::string_view accept_encoding);

}  // namespace server
