// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "jobs/statistics/estimate.h"
#include "jobs/statistics/unit_points.h"

namespace jobs {

/// Trajectories of Morris (1991): each begins at a random point of a grid and changes one coordinate after
/// the other, in random order, by levels / (2 (levels - 1)) up or down. Point t (dimensions + 1) + s is the
/// s-th of trajectory t. The same arguments give the same points.
/// @param levels  of the grid, even
[[nodiscard]] UnitPoints morris_points(std::size_t trajectories, std::size_t dimensions, std::size_t levels,
                                       std::uint64_t seed);

/// The points of Saltelli (2010): in blocks of dimensions + 2, the k-th of which has a point A, a point B,
/// and A with each coordinate in turn taken from B. (A, B) is the k-th point of Sobol's sequence in twice as
/// many dimensions, shifted at random by the seed.
/// @param dimensions  at most kMostSobolDimensions / 2
[[nodiscard]] UnitPoints saltelli_points(std::size_t blocks, std::size_t dimensions, std::uint64_t seed);

/// Morris' measures of the change of a response by a whole range of one input.
struct ElementaryEffects {
  double mean = 0.0;       ///< mu: of the effects with their signs
  Estimate mean_size;      ///< mu*: of their magnitudes; the interval is Student's
  double deviation = 0.0;  ///< sigma: how much the effect depends on the point
};

/// @param points, values  of whole trajectories, two or more, as morris_points() gives them; coordinates may
/// be those of rounded values
/// @returns one a dimension; empty if fewer than two trajectories have a step along it
[[nodiscard]] std::vector<std::optional<ElementaryEffects>> calc_elementary_effects(
    const UnitPoints& points, std::span<const double> values);

/// Sobol's indices: part of a response's variance that an input makes.
struct SobolIndices {
  Estimate first_order;  ///< alone
  Estimate total;        ///< with all that it does together with others
};

/// The estimators of Saltelli (2010) for the first order and of Jansen (1999) for the total, with intervals
/// from 1000 bootstrap samples of the blocks. Where the response does not vary all are 0.
/// @param values  of whole blocks, two or more, as saltelli_points() orders them
[[nodiscard]] std::vector<SobolIndices> calc_sobol_indices(std::span<const double> values,
                                                           std::size_t dimensions);

}  // namespace jobs
