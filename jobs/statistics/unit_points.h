// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace jobs {

/// Points of the unit cube [0, 1)^d, one list of d coordinates a point.
using UnitPoints = std::vector<std::vector<double>>;

/// The largest number of dimensions of sobol_points, that of the direction numbers.
inline constexpr std::size_t kMostSobolDimensions = 3667;

/// A Latin hypercube: in every dimension each of the `count` intervals [k/count, (k+1)/count) has one point,
/// at a random place in it. The intervals are permuted independently in each dimension. The same arguments
/// give the same points.
/// @param count  in [0, 2^29]
[[nodiscard]] UnitPoints latin_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed);

/// The first points of Sobol's sequence with the direction numbers of Joe and Kuo (new-joe-kuo-6.21201,
/// through Boost.Random), the origin first. With a seed, each coordinate's bits are flipped by a mask of its
/// dimension's own (a digital shift): another set of points that fills the cube as evenly.
/// @param dimensions  at most kMostSobolDimensions
[[nodiscard]] UnitPoints sobol_points(std::size_t count, std::size_t dimensions,
                                      std::optional<std::uint64_t> seed);

}  // namespace jobs
