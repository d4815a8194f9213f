// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace bench {

/// Processor time that this process has used so far, all threads together, [s].
[[nodiscard]] inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time of one call, [s].
template <typename Work>
[[nodiscard]] double time_cpu(const Work& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

/// Processor time of one call of something short, [s]: the least of some batches, each long enough to be
/// measured.
template <typename Work>
[[nodiscard]] double time_short(const Work& work, double batch_seconds = 0.02, int batches = 7) {
  long calls = 1;
  const auto batch = [&] {
    for (long i = 0; i < calls; ++i) work();
  };
  while (time_cpu(batch) < batch_seconds) calls *= 2;
  double least = time_cpu(batch);
  for (int i = 1; i < batches; ++i) {
    const double seconds = time_cpu(batch);
    if (seconds < least) least = seconds;
  }
  return least / static_cast<double>(calls);
}

}  // namespace bench
