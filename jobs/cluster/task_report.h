// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace jobs::cluster {

/// One element of an array that Slurm was given: which generation of a batch, and its index in it.
struct TaskName {
  int generation = 0;
  int index = 0;
  auto operator<=>(const TaskName&) const = default;
};

/// Meaning of Slurm's word for a task's state.
enum class Phase { kPending, kRunning, kUnknownWord, kCompleted, kFailed, kTimeout, kNodeFail, kOutOfMemory,
                   kCancelled, kPreempted };

/// A word that a future Slurm may have is no reason to give a task up: it counts as alive.
[[nodiscard]] Phase phase_of(std::string_view word);
[[nodiscard]] inline bool is_alive(Phase phase) { return phase <= Phase::kUnknownWord; }

/// A line of squeue.
struct TaskReport {
  Phase phase = Phase::kPending;
  std::string word;       ///< Slurm's own: "PENDING"
  std::string array_job;  ///< Slurm's number of the array, for humans and for scancel
  int cpus = 0;
  std::string node;       ///< empty while it waits
  std::string reason;     ///< cause of its wait or of its end, in Slurm's words; "None" if there is none
  bool has_log = true;    ///< false: it has failed, and its node has written none

  /// Held because Slurm could not start it, again and again: it would wait forever.
  [[nodiscard]] bool is_held_by_failure() const;
  /// Waits for something that does not come by itself: a human must decide.
  [[nodiscard]] bool needs_human() const;
};

/// Output of squeue, by the array's name, then by the task's index.
using Reports = std::map<std::string, std::map<int, TaskReport>, std::less<>>;

/// The columns that squeue is asked for. The reason is last, since it may hold anything.
inline constexpr std::string_view kReportFormat = "%j|%F|%K|%T|%C|%N|%r";

/// Reads what squeue printed. Of two lines for one task that of a live one counts.
/// @returns empty if a line is not of that form: then nothing can be concluded
[[nodiscard]] std::optional<Reports> parse_reports(std::string_view text);

}  // namespace jobs::cluster
