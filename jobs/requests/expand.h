// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"

namespace jobs {

/// One job that is to be stored.
struct PlannedJob {
  std::string parameters;  ///< all of them, canonical
  std::string content_id;
  std::string kind;  ///< features on which its cost depends most: "flexible, clearance"
  std::optional<std::uint64_t> replicate;
  std::string swept;  ///< JSON list of the values of SweepPlan::swept
};

struct SweepPlan {
  std::string name;
  std::vector<std::string> swept;  ///< paths of the parameters that differ from job to job
  bool replicated = false;
  bool reuse = true;
  std::int64_t priority = 0;
  std::string executor;            ///< that is to compute it; empty: whichever the service has chosen
  std::vector<PlannedJob> jobs;
};

/// All jobs of a sweep: cases outermost, then the points of the design, then the axes in their order, the
/// last one fastest, replicates innermost.
/// @throws InvalidRequest with every fault; one that several points have is told once, with the first of them
[[nodiscard]] SweepPlan plan_sweep(const nlohmann::ordered_json& request, std::size_t max_jobs);

/// Jobs of cases that a study adds to its sweep, one by one: a case need not have the values that replicates
/// are for. @param common  the sweep without cases
[[nodiscard]] std::vector<PlannedJob> plan_cases(nlohmann::ordered_json common,
                                                 const nlohmann::ordered_json& cases);

/// @throws InvalidRequest with every fault
[[nodiscard]] PlannedJob plan_job(const nlohmann::json& parameters);

/// Factor of replicate k on contact_stiffness_scale: 1 for k = 0, else 1 + perturbation u, with u in [-1, 1)
/// made of the upper 53 bits of the k-th number of the generator splitmix64 that starts from the seed.
[[nodiscard]] double replicate_factor(std::uint64_t seed, std::uint64_t k, double perturbation);

}  // namespace jobs
