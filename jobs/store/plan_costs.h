// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/requests/expand.h"

namespace jobs {

/// Cost of the newest computed jobs of one kind.
struct KindCost {
  std::int64_t measured = 0;      ///< number of those jobs
  double seconds = 0.0;           ///< wall time of them all
  double simulated_s = 0.0;       ///< simulated time of them all
  double trajectory_bytes = 0.0;  ///< of the packed trajectories of them all
  double samples = 0.0;           ///< in those trajectories
  double other_bytes = 0.0;       ///< of parameters and metrics of them all
};

/// Costs of the jobs of a plan, from the store.
struct PlanCosts {
  std::set<std::string> stored;           ///< content ids of those with a result
  std::map<std::string, KindCost> kinds;  ///< by PlannedJob::kind, those without computed jobs among them
};

[[nodiscard]] PlanCosts read_plan_costs(const SQLite::Database& database, const SweepPlan& plan);

}  // namespace jobs
