#include "server/commands/signals.h"

namespace server::commands {

EndSignals::EndSignals() {
  sigemptyset(&set_);
  sigaddset(&set_, SIGINT);
  sigaddset(&set_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set_, nullptr);
}

void EndSignals::wait() const {
  int signal = 0;
  sigwait(&set_, &signal);
}

bool EndSignals::arrived() const {
  const timespec at_once{};
  return sigtimedwait(&set_, nullptr, &at_once) > 0;
}

}  // namespace server::commands
