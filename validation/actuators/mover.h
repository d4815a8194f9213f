// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "engine/simulate_linkage.h"
#include "validation/support/runs.h"

namespace validation {

inline constexpr double kFlywheelInertia = 0.02;  // moment of inertia, [kg m^2]
inline constexpr double kBlockMass = 2.0;         // mass, [kg]
inline constexpr const char* kStepTolerance = "the steps' tolerance of 1e-10";

/// A flywheel on a shaft, or a block on a level slide: one freedom "q", which nothing but its actuator and its
/// load moves.
[[nodiscard]] inline Linkage make_mover(JointKind kind, LinkageFreedom freedom) {
  Linkage linkage;
  linkage.bodies = {
      {.name = "body", .mass = kBlockMass, .inertia = kFlywheelInertia * Eigen::Matrix3d::Identity().eval()}};
  linkage.joints = {{.name = "joint",
                     .kind = kind,
                     .from = kGroundName,
                     .to = "body",
                     .placement = {},
                     .freedoms = {std::move(freedom)}}};
  return linkage;
}

/// A run of a described linkage that must succeed, in steps of a tolerance of 1e-10.
[[nodiscard]] inline RunResult run_mover(const Linkage& linkage, Integrator integrator, double duration) {
  const RunOptions options{.duration = duration,
                           .output_rate = 100.0,
                           .integrator = integrator,
                           .relative_tolerance = 1e-10,
                           .absolute_tolerance = 1e-10};
  RunResult result = simulate_linkage(linkage, options, 0.0, {});
  if (result.status != RunStatus::kSucceeded)
    throw std::runtime_error("a run of the validation failed: " + result.detail);
  return result;
}

/// A metric of a described linkage's run by its key.
[[nodiscard]] inline double metric_of(const Linkage& linkage, const RunResult& run, std::string_view key) {
  const LinkageTables tables = linkage_tables(linkage);
  for (std::size_t i = 0; i < tables.metrics.size(); ++i)
    if (tables.metrics[i].key == key) return run.metrics.at(i);
  throw std::out_of_range("no metric of that key");
}

}  // namespace validation
