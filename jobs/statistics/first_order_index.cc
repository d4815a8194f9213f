// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/first_order_index.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <vector>

namespace jobs {
namespace {

constexpr std::size_t kMostClasses = 16;

/// The class of each point, from 0 on.
std::vector<std::size_t> classify(std::span<const nlohmann::json> x) {
  std::map<nlohmann::json, std::size_t> count_of;
  for (const nlohmann::json& value : x) ++count_of[value];
  std::map<nlohmann::json, std::size_t> class_of;  // in the order of the values
  const bool few = count_of.size() <= kMostClasses ||
                   std::ranges::any_of(x, [](const nlohmann::json& value) { return value.is_string(); });
  std::size_t before = 0;
  for (const auto& [value, count] : count_of) {
    class_of[value] = few ? class_of.size() : before * kMostClasses / x.size();
    before += count;
  }
  std::vector<std::size_t> classes;
  for (const nlohmann::json& value : x) classes.push_back(class_of[value]);
  return classes;
}

}  // namespace

std::optional<double> calc_first_order_index(std::span<const nlohmann::json> x, std::span<const double> y) {
  if (y.empty()) return std::nullopt;
  constexpr double kRounding = 1e-12;  // of the largest y
  const double largest =
      std::abs(*std::ranges::max_element(y, {}, [](double value) { return std::abs(value); }));
  const auto n = static_cast<double>(y.size());
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / n;
  const std::vector<std::size_t> classes = classify(x);
  std::vector<double> sums(*std::ranges::max_element(classes) + 1, 0.0), counts(sums.size(), 0.0);
  double total = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    sums[classes[i]] += y[i] - mean;
    counts[classes[i]] += 1.0;
    total += (y[i] - mean) * (y[i] - mean);
  }
  double between = 0.0, used = 0.0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (counts[k] == 0.0) continue;
    between += sums[k] * sums[k] / counts[k];
    used += 1.0;
  }
  if (!(total > n * (kRounding * largest) * (kRounding * largest)) || n < 2.0 * used) return std::nullopt;
  const double by_chance = (used - 1.0) * (total - between) / (n - used);
  return std::max(0.0, (between - by_chance) / total);
}

}  // namespace jobs
