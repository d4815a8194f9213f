// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace jobs {

/// Bytes that come from the system at once, in large pages where it has them, and go back to it at once.
/// Small pages take longer to get than many megabytes take to decode.
class LargeBuffer {
 public:
  /// @throws std::bad_alloc
  explicit LargeBuffer(std::size_t size);
  ~LargeBuffer();
  LargeBuffer(const LargeBuffer&) = delete;
  LargeBuffer& operator=(const LargeBuffer&) = delete;

  [[nodiscard]] std::span<char> bytes() { return {start_, size_}; }

 private:
  const std::size_t size_;
  char* start_ = nullptr;
};

}  // namespace jobs
