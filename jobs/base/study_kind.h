// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "jobs/base/ids.h"

namespace jobs {

/// Kind of study. kSearch searches the limit of a parameter, kWear follows a bearing that is worn over the
/// hours, kOptimisation looks for the least or largest values of metrics, kFit for parameters with which
/// jobs give measured signals.
enum class StudyKind { kSearch, kWear, kOptimisation, kFit };

struct StudyKindInfo {
  std::string_view name;       ///< as users know it
  std::string_view path;       ///< of its collection; "/" and an id follow
  std::string_view file_name;  ///< of its tables
  std::string_view id_prefix;
};

/// By StudyKind.
inline constexpr std::array<StudyKindInfo, 4> kStudyKinds{
    {{"search", "/v1/searches", "search", kSearchPrefix},
     {"wear study", "/v1/wear-studies", "wear-study", kWearStudyPrefix},
     {"optimisation", "/v1/optimisations", "optimisation", kOptimisationPrefix},
     {"fit", "/v1/fits", "fit", kFitPrefix}}};

[[nodiscard]] constexpr const StudyKindInfo& kind_info(StudyKind kind) {
  return kStudyKinds[static_cast<std::size_t>(kind)];
}

/// "the search sch_...", of the study with that id.
[[nodiscard]] inline std::string name_of_study(const std::string& id) {
  for (const StudyKindInfo& kind : kStudyKinds)
    if (id.starts_with(kind.id_prefix)) return "the " + std::string(kind.name) + " " + id;
  return id;
}

}  // namespace jobs
