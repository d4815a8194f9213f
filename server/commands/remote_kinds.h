// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/base/study_kind.h"

namespace server::commands {

/// Kind of resource of a service.
enum class Kind { kSweep, kJob, kSearch, kWearStudy, kOptimisation, kFit, kMeasurement };

struct KindInfo {
  std::string_view word;       ///< of submit --kind
  std::string_view noun;
  std::string_view id_prefix;
  std::string_view path;       ///< of its collection; "/" and an id follow
  std::string_view page;       ///< of the dashboard, "#/PAGE/ID"
};

[[nodiscard]] constexpr KindInfo study_kind_info(jobs::StudyKind kind, std::string_view page) {
  const jobs::StudyKindInfo& info = jobs::kind_info(kind);
  return {info.file_name, info.name, info.id_prefix, info.path, page};
}

/// By Kind.
inline constexpr std::array<KindInfo, 7> kKinds{
    {{"sweep", "sweep", jobs::kSweepPrefix, "/v1/sweeps", "sweeps"},
     {"job", "job", jobs::kJobPrefix, "/v1/jobs", "jobs"},
     study_kind_info(jobs::StudyKind::kSearch, "searches"),
     study_kind_info(jobs::StudyKind::kWear, "wear"),
     study_kind_info(jobs::StudyKind::kOptimisation, "optimisations"),
     study_kind_info(jobs::StudyKind::kFit, "fits"),
     {"measurement", "measurement", jobs::kMeasurementPrefix, "/v1/measurements", "measurements"}}};

[[nodiscard]] constexpr const KindInfo& info_of(Kind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

inline constexpr std::array kAllKinds{Kind::kSweep,        Kind::kJob, Kind::kSearch,     Kind::kWearStudy,
                                      Kind::kOptimisation, Kind::kFit, Kind::kMeasurement};
inline constexpr std::span<const Kind> kRunningKinds = std::span(kAllKinds).first<6>();  ///< with a state
inline constexpr std::array kTableKinds{Kind::kSweep, Kind::kSearch, Kind::kWearStudy, Kind::kOptimisation,
                                        Kind::kFit};
inline constexpr std::array kSweepKind{Kind::kSweep};
inline constexpr std::array kChannelKinds{Kind::kJob, Kind::kSweep, Kind::kMeasurement};

/// Command that takes ids, and the kinds that it takes.
struct IdCommand {
  std::string_view name;
  std::span<const Kind> kinds;
};

inline constexpr std::array<IdCommand, 11> kIdCommands{{{"status", kAllKinds},
                                                        {"watch", kRunningKinds},
                                                        {"results", kTableKinds},
                                                        {"trajectory", kChannelKinds},
                                                        {"report", kSweepKind},
                                                        {"open", kAllKinds},
                                                        {"cancel", kRunningKinds},
                                                        {"retry", kTableKinds},
                                                        {"extend", kSweepKind},
                                                        {"move", kSweepKind},
                                                        {"delete", kAllKinds}}};

/// The kinds that a command takes; empty if it takes no ids.
[[nodiscard]] std::span<const Kind> kinds_of_command(std::string_view name);

/// Kind of a word, which is that of a kind.
[[nodiscard]] Kind kind_of_word(std::string_view word);

/// Words of kinds.
[[nodiscard]] std::vector<std::string> words_of(std::span<const Kind> kinds);

/// "sweep, search or fit".
[[nodiscard]] std::string list_kinds(std::span<const Kind> kinds);

/// Kind of an id, which is then safe as a segment of a path.
/// @param command  that is given the id
/// @throws BadInput if it is no id, or one of a kind that the command does not take
[[nodiscard]] Kind checked_kind(std::string_view command, const std::string& id);

}  // namespace server::commands
