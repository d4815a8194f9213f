// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <stop_token>
#include <string>
#include <vector>

namespace jobs::cluster {

/// Result of another program.
struct ProcessOutcome {
  enum class End { kExited, kNotStarted, kTimedOut, kStopped };

  End end = End::kNotStarted;
  int code = 0;          ///< of one that exited; 128 and the signal's number of one that a signal ended
  std::string out, err;  ///< output; of each the first 64 MiB

  [[nodiscard]] bool succeeded() const { return end == End::kExited && code == 0; }
  /// Text for a human: its last output, or how it ended.
  [[nodiscard]] std::string text() const;
};

/// Runs a program, found by PATH, without a shell: no input, a deadline (or a request to stop) at which it
/// and all it has started are killed, and cleaned_environment().
[[nodiscard]] ProcessOutcome run_process(const std::vector<std::string>& arguments,
                                         std::chrono::milliseconds deadline,
                                         const std::stop_token& stop = {});

/// This process's environment without what would change how Slurm's commands work or what they print
/// (SQUEUE_FORMAT, SBATCH_*, SLURM_* of a job that this may be part of), save SLURM_CONF; and without our own
/// secrets and options.
[[nodiscard]] std::vector<std::string> cleaned_environment();

/// The words of a command line, with blanks between; a text in single or double quotes is one word.
[[nodiscard]] std::vector<std::string> split_words(const std::string& line);

/// A text as one word of a POSIX shell's command line.
[[nodiscard]] std::string shell_quoted(const std::string& text);

}  // namespace jobs::cluster
