// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace server {

/// From now on, a small allocation that fails is tried again for a moment, and has a reserve to fall back on,
/// before it throws std::bad_alloc. The memory of a request is given back when the request is refused, but
/// the destructors of JSON values allocate, too: one that could not would end the process.
void keep_memory_reserve();

/// Fills the reserve again if it has been used. False if there is no memory for it: then nothing new should
/// be begun.
[[nodiscard]] bool refill_memory_reserve();

}  // namespace server
