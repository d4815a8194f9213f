// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace server {

/// Accepted connection, with what has come of its request.
struct PendingConnection {
  int socket = -1;
  std::string received{};  ///< bytes so far
  std::chrono::steady_clock::time_point accepted{std::chrono::steady_clock::now()};
  /// Address of the client as bytes, without its port; of IPv6 the half that names its network
  std::string peer{};
};

}  // namespace server
