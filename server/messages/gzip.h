// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace server {

/// Unpacks a text that gzip has packed.
/// @param size  of the text, [bytes]
/// @throws std::runtime_error if it is damaged, or of another size
[[nodiscard]] std::string gunzip(std::string_view packed, std::size_t size);

}  // namespace server
