// SPDX-License-Identifier: Apache-2.0
#include "server/commands/signals.h"

namespace server::commands {

EndSignals::EndSignals() {
  sigemptyset(&set_);
  sigaddset(&set_, SIGINT);
  sigaddset(&set_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set_, &before_);
}

EndSignals::~EndSignals() {
  while (arrived()) {
    // Asked twice: the program has ended what it was asked to end.
  }
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void EndSignals::wait() const {
  int signal = 0;
  sigwait(&set_, &signal);
}

bool EndSignals::arrived(std::chrono::milliseconds within) const {
  const timespec time{.tv_sec = within.count() / 1000, .tv_nsec = within.count() % 1000 * 1'000'000};
  return sigtimedwait(&set_, nullptr, &time) > 0;
}

}  // namespace server::commands
