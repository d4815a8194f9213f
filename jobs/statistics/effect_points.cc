// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/effect_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "jobs/statistics/replicate_statistics.h"
#include "jobs/statistics/splitmix64.h"

namespace jobs {
namespace {

constexpr double kConfidence = 0.95;
constexpr std::size_t kBootstrapSamples = 1000;
constexpr std::uint64_t kBootstrapSeed = 1;

/// Random numbers one after the other.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : seed_(seed) {}
  /// In [0, count); what a count of at most some thousands makes uneven cannot be seen.
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>((splitmix64(seed_, ++drawn_) >> 11U) % count);
  }

 private:
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
};

std::vector<std::size_t> random_order(std::size_t count, Chance& chance) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[chance.below(i)]);
  return order;
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The sums that both estimators are made of, block by block: A and B less the mean, and for each input the
/// products.
struct BlockTerms {
  std::vector<double> square;                    ///< (a^2 + b^2) / 2
  std::vector<std::vector<double>> first, total;  ///< b (ab - a) and (a - ab)^2 / 2, by input
};

/// @param block  the values at a, at b, and at a with one input after the other of b
void add_block(std::span<const double> block, double mean, BlockTerms& terms) {
  const double a = block[0] - mean;
  const double b = block[1] - mean;
  terms.square.push_back(0.5 * (a * a + b * b));
  for (std::size_t i = 0; i < terms.first.size(); ++i) {
    const double ab = block[2 + i] - mean;
    terms.first[i].push_back(b * (ab - a));
    terms.total[i].push_back(0.5 * (a - ab) * (a - ab));
  }
}

BlockTerms terms_of(std::span<const double> values, std::size_t dimensions) {
  const std::size_t width = dimensions + 2;
  const std::size_t blocks = values.size() / width;
  double mean = 0.0;
  for (std::size_t k = 0; k < blocks; ++k)
    mean += 0.5 * (values[k * width] + values[k * width + 1]) / static_cast<double>(blocks);
  BlockTerms terms{.square = {}, .first = std::vector<std::vector<double>>(dimensions),
                   .total = std::vector<std::vector<double>>(dimensions)};
  for (std::size_t k = 0; k < blocks; ++k) add_block(values.subspan(k * width, width), mean, terms);
  return terms;
}

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// The mean of what was sampled, over the variance of the same sample.
class Bootstrap {
 public:
  explicit Bootstrap(const std::vector<double>& square) : square_(square) {
    Chance chance(kBootstrapSeed);
    samples_.resize(kBootstrapSamples);
    for (auto& sample : samples_) {
      for (std::size_t k = 0; k < square.size(); ++k)
        sample.push_back(static_cast<std::uint32_t>(chance.below(square.size())));
    }
  }

  [[nodiscard]] Estimate estimate(const std::vector<double>& term) const {
    std::vector<double> ratios;
    for (const auto& sample : samples_) ratios.push_back(ratio_in(sample, term));
    std::ranges::sort(ratios);
    const auto at = [&](double part) {
      return ratios[static_cast<std::size_t>(part * static_cast<double>(ratios.size() - 1))];
    };
    return {ratio(mean_of(term), mean_of(square_)), at(0.5 * (1.0 - kConfidence)),
            at(0.5 * (1.0 + kConfidence))};
  }

 private:
  [[nodiscard]] double ratio_in(const std::vector<std::uint32_t>& sample,
                                const std::vector<double>& term) const {
    double part = 0.0;
    double whole = 0.0;
    for (const std::uint32_t k : sample) {
      part += term[k];
      whole += square_[k];
    }
    return ratio(part, whole);
  }

  const std::vector<double>& square_;
  std::vector<std::vector<std::uint32_t>> samples_;
};

/// A point of the grid in the unit cube. @param levels  number of them along each side
std::vector<double> to_unit_point(const std::vector<std::size_t>& grid_point, std::size_t levels) {
  const double spacing = 1.0 / static_cast<double>(levels - 1);
  std::vector<double> point;
  for (const std::size_t level : grid_point) point.push_back(static_cast<double>(level) * spacing);
  return point;
}

/// Adds a point by chance and those after it, each with a jump of one input.
void add_trajectory(std::size_t dimensions, std::size_t levels, Chance& chance, UnitPoints& points) {
  const std::size_t jump = levels / 2;
  std::vector<std::size_t> grid_point(dimensions);
  for (std::size_t& level : grid_point) level = chance.below(levels);
  points.push_back(to_unit_point(grid_point, levels));
  for (const std::size_t d : random_order(dimensions, chance)) {
    grid_point[d] = grid_point[d] < jump ? grid_point[d] + jump : grid_point[d] - jump;
    points.push_back(to_unit_point(grid_point, levels));
  }
}

/// The effects of each input.
std::vector<std::vector<double>> effects_of(const UnitPoints& points, std::span<const double> values) {
  const std::size_t dimensions = points.front().size();
  std::vector<std::vector<double>> effects(dimensions);
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (k % (dimensions + 1) == 0) continue;  // the next trajectory begins
    for (std::size_t d = 0; d < dimensions; ++d) {
      const double step = points[k][d] - points[k - 1][d];
      if (step != 0.0) effects[d].push_back((values[k] - values[k - 1]) / step);
    }
  }
  return effects;
}

}  // namespace

UnitPoints morris_points(std::size_t trajectories, std::size_t dimensions, std::size_t levels,
                         std::uint64_t seed) {
  Chance chance(seed);
  UnitPoints points;
  for (std::size_t t = 0; t < trajectories; ++t) add_trajectory(dimensions, levels, chance, points);
  return points;
}

UnitPoints saltelli_points(std::size_t blocks, std::size_t dimensions, std::uint64_t seed) {
  UnitPoints points;
  for (const auto& both : sobol_points(blocks, 2 * dimensions, seed)) {
    const std::vector<double> a(both.begin(), both.begin() + static_cast<std::ptrdiff_t>(dimensions));
    points.push_back(a);
    points.emplace_back(both.begin() + static_cast<std::ptrdiff_t>(dimensions), both.end());
    for (std::size_t i = 0; i < dimensions; ++i) {
      points.push_back(a);
      points.back()[i] = both[dimensions + i];
    }
  }
  return points;
}

std::vector<std::optional<ElementaryEffects>> calc_elementary_effects(const UnitPoints& points,
                                                                      std::span<const double> values) {
  std::vector<std::optional<ElementaryEffects>> measures;
  for (const auto& of_input : effects_of(points, values)) {
    auto& measured = measures.emplace_back();
    if (of_input.size() < 2) continue;
    std::vector<double> sizes;
    for (const double effect : of_input) sizes.push_back(std::abs(effect));
    measured = ElementaryEffects{.mean = mean_of(of_input), .mean_size = estimate_mean(sizes),
                                 .deviation = *calc_replicate_statistics(of_input).spread};
  }
  return measures;
}

std::vector<SobolIndices> calc_sobol_indices(std::span<const double> values, std::size_t dimensions) {
  const BlockTerms terms = terms_of(values, dimensions);
  const Bootstrap bootstrap(terms.square);
  std::vector<SobolIndices> indices;
  for (std::size_t i = 0; i < dimensions; ++i)
    indices.push_back(
        {.first_order = bootstrap.estimate(terms.first[i]), .total = bootstrap.estimate(terms.total[i])});
  return indices;
}

}  // namespace jobs
