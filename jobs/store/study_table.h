// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/requests/expand.h"
#include "jobs/store/idempotency_record.h"
#include "jobs/store/rows.h"
#include "jobs/store/store_core.h"

namespace jobs {

/// Studies of all types; the prefix of an id tells the type. May be called from any thread. Throws
/// StorageError.
class StudyTable {
 public:
  explicit StudyTable(StoreCore& core) : core_(core) {}

  /// Stores a study with the sweep of its first evaluations. Returns its id.
  /// @param measurements  ids of those in the request's list, which are there as long as the study is
  /// @throws QueueFull as add_sweep() does; InvalidRequest if a measurement has been deleted in between
  std::string add(std::string_view prefix, const SweepPlan& plan, const std::string& sweep_request,
                  const std::string& request, std::size_t max_queued,
                  const IdempotencyRecord<StudySnapshot>& idempotency = {},
                  const std::vector<std::string>& measurements = {});
  [[nodiscard]] std::optional<StudyRow> find(const std::string& id) const;
  /// Studies of one type, newest first. @param state empty: all  @param before  an id; empty: the newest
  [[nodiscard]] std::vector<StudyRow> list(std::string_view prefix, const std::string& state,
                                           const std::string& before, std::size_t limit) const;
  /// Gives a study another state. False, and nothing is stored, if it is not in the former one.
  bool set_state(const std::string& id, const std::string& former, const std::string& state,
                 const std::optional<std::string>& error = {});

 private:
  StoreCore& core_;
};

}  // namespace jobs
