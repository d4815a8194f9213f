// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace jobs {

/// Size of the queue and of the store.
struct QueueStats {
  std::int64_t queued = 0, running = 0;  ///< jobs
  std::int64_t store_bytes = 0;          ///< on disk, with its log
};

}  // namespace jobs
