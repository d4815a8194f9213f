// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/task_report.h"

#include <array>
#include <charconv>
#include <utility>

namespace jobs::cluster {
namespace {

constexpr std::size_t kFields = 7;

std::optional<int> to_int(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 0 ? std::optional(value)
                                                                                : std::nullopt;
}

/// Takes the next line off a text.
std::string_view take_line(std::string_view& text) {
  const auto end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

using ReportFields = std::array<std::string_view, kFields>;

/// The last field takes what is left, whatever it holds.
std::optional<ReportFields> split_fields(std::string_view line) {
  ReportFields fields;
  for (std::size_t i = 0; i + 1 < kFields; ++i) {
    const auto bar = line.find('|');
    if (bar == std::string_view::npos) return std::nullopt;
    fields.at(i) = line.substr(0, bar);
    line.remove_prefix(bar + 1);
  }
  fields.back() = line;
  return fields;
}

/// @returns whether all tasks of an array were cancelled before they began: nothing is said of single ones
bool is_cancelled_array(const ReportFields& fields) {
  return fields[2] == "N/A" && !is_alive(phase_of(fields[3]));
}

TaskReport report_of(const ReportFields& fields, int cpus) {
  return {.phase = phase_of(fields[3]),
          .word = std::string(fields[3]),
          .array_job = std::string(fields[1]),
          .cpus = cpus,
          .node = std::string(fields[5]),
          .reason = std::string(fields[6])};
}

}  // namespace

Phase phase_of(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, Phase>, 25> kWords{{{"PENDING", Phase::kPending},
                                                                       {"CONFIGURING", Phase::kPending},
                                                                       {"REQUEUED", Phase::kPending},
                                                                       {"REQUEUE_FED", Phase::kPending},
                                                                       {"REQUEUE_HOLD", Phase::kPending},
                                                                       {"RESV_DEL_HOLD", Phase::kPending},
                                                                       {"SPECIAL_EXIT", Phase::kPending},
                                                                       {"RUNNING", Phase::kRunning},
                                                                       {"COMPLETING", Phase::kRunning},
                                                                       {"RESIZING", Phase::kRunning},
                                                                       {"SIGNALING", Phase::kRunning},
                                                                       {"STAGE_OUT", Phase::kRunning},
                                                                       {"STOPPED", Phase::kRunning},
                                                                       {"SUSPENDED", Phase::kRunning},
                                                                       {"COMPLETED", Phase::kCompleted},
                                                                       {"FAILED", Phase::kFailed},
                                                                       {"LAUNCH_FAILED", Phase::kFailed},
                                                                       {"TIMEOUT", Phase::kTimeout},
                                                                       {"DEADLINE", Phase::kTimeout},
                                                                       {"NODE_FAIL", Phase::kNodeFail},
                                                                       {"BOOT_FAIL", Phase::kNodeFail},
                                                                       {"OUT_OF_MEMORY", Phase::kOutOfMemory},
                                                                       {"CANCELLED", Phase::kCancelled},
                                                                       {"REVOKED", Phase::kCancelled},
                                                                       {"PREEMPTED", Phase::kPreempted}}};
  for (const auto& [known, phase] : kWords) {
    if (known == word) return phase;
  }
  return Phase::kUnknownWord;
}

bool TaskReport::is_held_by_failure() const {
  return phase == Phase::kPending && reason.find("launch failed") != std::string::npos;
}

bool TaskReport::needs_human() const {
  if (phase != Phase::kPending) return phase == Phase::kUnknownWord;
  constexpr std::array<std::string_view, 12> kReasons{"JobHeldUser",
                                                      "JobHeldAdmin",
                                                      "BadConstraints",
                                                      "DependencyNeverSatisfied",
                                                      "QOS",
                                                      "Assoc",
                                                      "PartitionDown",
                                                      "PartitionInactive",
                                                      "PartitionNodeLimit",
                                                      "PartitionTimeLimit",
                                                      "InvalidAccount",
                                                      "ReqNodeNotAvail"};
  for (const std::string_view known : kReasons) {
    if (reason.find(known) != std::string::npos) return true;
  }
  return false;
}

std::optional<Reports> parse_reports(std::string_view text) {
  Reports reports;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (line.empty()) continue;
    const auto fields = split_fields(line);
    if (fields && is_cancelled_array(*fields)) continue;
    const auto index = fields ? to_int((*fields)[2]) : std::nullopt;
    const auto cpus = fields ? to_int((*fields)[4]) : std::nullopt;
    if (!index || !cpus || (*fields)[0].empty() || (*fields)[3].empty()) return std::nullopt;
    TaskReport report = report_of(*fields, *cpus);
    const auto [known, is_new] = reports[std::string((*fields)[0])].try_emplace(*index, report);
    if (!is_new && !is_alive(known->second.phase)) known->second = std::move(report);
  }
  return reports;
}

}  // namespace jobs::cluster
