#pragma once

#include <csignal>

namespace server::commands {

/// Takes SIGINT and SIGTERM out of the hands of every thread that is started while it lives: they wait to be asked for.
class EndSignals {
 public:
  EndSignals();
  ~EndSignals();  ///< from here on they end the program again
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// Blocks until one of them comes.
  void wait() const;

  /// True if one of them has come.
  [[nodiscard]] bool arrived() const;

 private:
  sigset_t set_{}, before_{};
};

}  // namespace server::commands
