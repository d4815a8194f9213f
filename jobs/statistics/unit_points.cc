// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/unit_points.h"

#include <algorithm>
#include <numeric>

#include <boost/random/sobol.hpp>

#include "jobs/statistics/splitmix64.h"

namespace jobs {
namespace {

static_assert(boost::random::default_sobol_table::max_dimension == kMostSobolDimensions);

/// The upper 53 bits as a number in [0, 1).
double unit_number(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1p-53; }

/// 0 .. count - 1 in the order of as many random numbers.
std::vector<std::size_t> random_permutation(std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return splitmix64(seed, k + 1); });
  return order;
}

}  // namespace

UnitPoints latin_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  UnitPoints points(count, std::vector<double>(dimensions));
  for (std::size_t d = 0; d < dimensions; ++d) {
    const std::uint64_t order_seed = splitmix64(seed, 2 * d + 1);
    const std::uint64_t offset_seed = splitmix64(seed, 2 * d + 2);
    const auto intervals = random_permutation(count, order_seed);
    for (std::size_t k = 0; k < count; ++k) {
      // 24 bits of offset and 29 of interval: the sum is exact, so that no point is rounded into the next
      // interval.
      const double offset = static_cast<double>(splitmix64(offset_seed, k + 1) >> 40U) * 0x1p-24;
      points[k][d] = (static_cast<double>(intervals[k]) + offset) / static_cast<double>(count);
    }
  }
  return points;
}

UnitPoints sobol_points(std::size_t count, std::size_t dimensions, std::optional<std::uint64_t> seed) {
  std::vector<std::uint64_t> shift(dimensions, 0);
  if (seed) {
    for (std::size_t d = 0; d < dimensions; ++d) shift[d] = splitmix64(*seed, d + 1);
  }
  boost::random::sobol sequence(dimensions);
  UnitPoints points(count, std::vector<double>(dimensions));
  for (std::size_t k = 0; k < count; ++k) {
    // Boost leaves out the origin; without it the first 2^m points would not have one in each interval of
    // 2^-m.
    for (std::size_t d = 0; d < dimensions; ++d)
      points[k][d] = unit_number((k == 0 ? 0 : sequence()) ^ shift[d]);
  }
  return points;
}

}  // namespace jobs
