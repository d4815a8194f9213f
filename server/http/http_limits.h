// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string_view>

namespace server {

/// Limits of one connection. Times are totals: a limit on a single read lets a client send a byte at a time
/// for ever.
struct HttpLimits {
  std::size_t head_bytes = 16 * 1024;
  std::size_t body_bytes = 8 * 1024 * 1024;      ///< after decoding
  std::size_t measurement_body_bytes = 64 * 1024 * 1024;  ///< the same of POST /v1/measurements
  std::chrono::milliseconds head_time{5'000};
  std::chrono::milliseconds body_time{10'000};  ///< of a body of body_bytes; longer for a larger limit
  std::chrono::milliseconds response_time{60'000};
  std::size_t response_bytes_per_s =
      256 * 1024;  ///< bytes that extend response_time by 1 s: stores have gigabytes
  std::chrono::milliseconds stall_time{
      10'000};  ///< sum of the waits until the client takes more of the answer
  std::chrono::milliseconds event_stall_time{30'000};  ///< each wait until the client takes more events
  std::size_t least_bytes_per_s = 1024;          ///< bytes that extend stall_time by 1 s
  std::chrono::milliseconds linger_time{2'000};  ///< wait for the client to close its end
  std::chrono::milliseconds crowded_time{
      500};  ///< each longer wait, while other connections queue for a thread
  std::size_t max_queued = 512;                  ///< connections that wait for a thread; beyond them: 503
  std::chrono::milliseconds drain_time{1'000};   ///< time left to every connection once the server is ending

  /// Largest body of a request to a path, which may stand below the path of a proxy.
  [[nodiscard]] std::size_t body_bytes_of(std::string_view path) const {
    return path.ends_with("/v1/measurements") ? measurement_body_bytes : body_bytes;
  }
  [[nodiscard]] std::size_t largest_body_bytes() const {
    return std::max(body_bytes, measurement_body_bytes);
  }
};

}  // namespace server
