// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>

namespace server::commands {

/// Takes SIGINT and SIGTERM out of the hands of every thread that is started while it lives: they wait to be
/// asked for.
class EndSignals {
 public:
  EndSignals();
  ~EndSignals();  ///< from here on they end the program again
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// Blocks until one of them comes.
  void wait() const;

  /// True if one of them has come, or comes within that time.
  [[nodiscard]] bool arrived(std::chrono::milliseconds within = std::chrono::milliseconds(0)) const;

 private:
  sigset_t set_{}, before_{};
};

}  // namespace server::commands
