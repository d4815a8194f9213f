// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace jobs {

/// Disk quota of a store. Zero: no limit.
struct StoreQuota {
  std::int64_t most_bytes = 0;     ///< that it may hold, its log apart
  std::int64_t reserve_bytes = 0;  ///< that stay free on the disk for others
};

}  // namespace jobs
