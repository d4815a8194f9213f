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

BlockTerms terms_of(std::span<const double> values, std::size_t dimensions) {
  const std::size_t width = dimensions + 2;
  const std::size_t blocks = values.size() / width;
  double mean = 0.0;
  for (std::size_t k = 0; k < blocks; ++k)
    mean += 0.5 * (values[k * width] + values[k * width + 1]) / static_cast<double>(blocks);
  BlockTerms terms{.square = {}, .first = std::vector<std::vector<double>>(dimensions),
                   .total = std::vector<std::vector<double>>(dimensions)};
  for (std::size_t k = 0; k < blocks; ++k) {
    const double a = values[k * width] - mean;
    const double b = values[k * width + 1] - mean;
    terms.square.push_back(0.5 * (a * a + b * b));
    for (std::size_t i = 0; i < dimensions; ++i) {
      const double ab = values[k * width + 2 + i] - mean;
      terms.first[i].push_back(b * (ab - a));
      terms.total[i].push_back(0.5 * (a - ab) * (a - ab));
    }
  }
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
    for (const auto& sample : samples_) {
      double part = 0.0;
      double whole = 0.0;
      for (const std::uint32_t k : sample) {
        part += term[k];
        whole += square_[k];
      }
      ratios.push_back(ratio(part, whole));
    }
    std::ranges::sort(ratios);
    const auto at = [&](double part) {
      return ratios[static_cast<std::size_t>(part * static_cast<double>(ratios.size() - 1))];
    };
    return {ratio(mean_of(term), mean_of(square_)), at(0.5 * (1.0 - kConfidence)),
            at(0.5 * (1.0 + kConfidence))};
  }

 private:
  const std::vector<double>& square_;
  std::vector<std::vector<std::uint32_t>> samples_;
};

}  // namespace

UnitPoints morris_points(std::size_t trajectories, std::size_t dimensions, std::size_t levels,
                         std::uint64_t seed) {
  Chance chance(seed);
  const double spacing = 1.0 / static_cast<double>(levels - 1);
  const std::size_t jump = levels / 2;
  UnitPoints points;
  for (std::size_t t = 0; t < trajectories; ++t) {
    std::vector<std::size_t> grid_point(dimensions);
    for (std::size_t& level : grid_point) level = chance.below(levels);
    const auto add = [&] {
      points.emplace_back();
      for (const std::size_t level : grid_point)
        points.back().push_back(static_cast<double>(level) * spacing);
    };
    add();
    for (const std::size_t d : random_order(dimensions, chance)) {
      grid_point[d] = grid_point[d] < jump ? grid_point[d] + jump : grid_point[d] - jump;
      add();
    }
  }
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

std::vector<ElementaryEffects> calc_elementary_effects(const UnitPoints& points,
                                                       std::span<const double> values) {
  const std::size_t dimensions = points.front().size();
  std::vector<std::vector<double>> effects(dimensions);
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (k % (dimensions + 1) == 0) continue;  // the next trajectory begins
    for (std::size_t d = 0; d < dimensions; ++d) {
      const double step = points[k][d] - points[k - 1][d];
      if (step != 0.0) effects[d].push_back((values[k] - values[k - 1]) / step);
    }
  }
  std::vector<ElementaryEffects> measures;
  for (const auto& of_input : effects) {
    std::vector<double> sizes;
    for (const double effect : of_input) sizes.push_back(std::abs(effect));
    measures.push_back({.mean = mean_of(of_input), .mean_size = estimate_mean(sizes),
                        .deviation = *calc_replicate_statistics(of_input).spread});
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
