// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "jobs/base/ids.h"

namespace jobs {

/// Kind of study. kLimit searches the limit of a parameter, kWear follows a bearing that is worn over the
/// hours, kOptimisation looks for the least or largest values of metrics.
enum class StudyKind { kLimit, kWear, kOptimisation };

struct StudyKindInfo {
  std::string_view name;       ///< as users know it
  std::string_view path;       ///< of its collection; "/" and an id follow
  std::string_view file_name;  ///< of its tables
  std::string_view id_prefix;
};

/// By StudyKind.
inline constexpr std::array<StudyKindInfo, 3> kStudyKinds{
    {{"search", "/v1/searches", "search", kSearchPrefix},
     {"wear study", "/v1/wear-studies", "wear-study", kWearStudyPrefix},
     {"optimisation", "/v1/optimisations", "optimisation", kOptimisationPrefix}}};

[[nodiscard]] constexpr const StudyKindInfo& kind_info(StudyKind kind) {
  return kStudyKinds[static_cast<std::size_t>(kind)];
}

}  // namespace jobs
