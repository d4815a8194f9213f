#pragma once

#include <csignal>

namespace server::commands {

/// Takes SIGINT and SIGTERM out of the hands of every thread that is started from here on: they wait to be asked for.
class EndSignals {
 public:
  EndSignals();

  /// Blocks until one of them comes.
  void wait() const;

  /// True if one of them has come.
  [[nodiscard]] bool arrived() const;

 private:
  sigset_t set_{};
};

}  // namespace server::commands
