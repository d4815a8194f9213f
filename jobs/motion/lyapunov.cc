// SPDX-License-Identifier: Apache-2.0
#include "jobs/motion/lyapunov.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/results/table_groups.h"
#include "jobs/statistics/estimate.h"
#include "jobs/statistics/replicate_statistics.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr double kFloor = 1e-5, kCeiling = 0.1;  ///< of the motion's size
constexpr std::size_t kFewestForSlope = 8;

/// Root mean square deviation from the mean, of all coordinates together.
double size_of(const std::vector<std::vector<double>>& run) {
  double squares = 0.0;
  for (const auto& column : run) {
    const auto spread = calc_replicate_statistics(column).spread.value_or(0.0);
    squares += spread * spread;
  }
  return std::sqrt(squares);
}

double distance(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b,
                std::size_t k) {
  double squares = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) squares += (a[c][k] - b[c][k]) * (a[c][k] - b[c][k]);
  return std::sqrt(squares);
}

/// Slope of the straight line through points, by least squares.
double slope_of(std::span<const double> x, std::span<const double> y) {
  const double x_mean = *calc_replicate_statistics(x).mean;
  const double y_mean = *calc_replicate_statistics(y).mean;
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    products += (x[k] - x_mean) * (y[k] - y_mean);
    squares += (x[k] - x_mean) * (x[k] - x_mean);
  }
  return products / squares;
}

using Columns = std::vector<std::vector<double>>;

/// t_s, and the journal's position.
std::optional<Columns> find_orbit(const json& job_id, const FindTrajectory& find) {
  auto run = find(job_id.get<std::string>(), {.channels = {"journal_x_mm", "journal_y_mm"}, .from = {},
                                              .to = {}});
  return run ? std::optional(std::move(run->columns)) : std::nullopt;
}

std::optional<Divergence> compare(const Columns& a, const Columns& b) {
  const std::size_t samples = std::min(a[0].size(), b[0].size());
  const auto cut = [&](const Columns& run) {
    Columns positions;
    for (std::size_t c = 1; c < run.size(); ++c)
      positions.emplace_back(run[c].begin(), run[c].begin() + static_cast<std::ptrdiff_t>(samples));
    return positions;
  };
  return measure_divergence(std::span(a[0]).first(samples), cut(a), cut(b));
}

std::vector<json> cells_of(std::size_t pairs, const std::vector<Divergence>& divergences) {
  std::vector<double> exponents;
  double from = 0.0;
  double to = 0.0;
  for (const Divergence& one : divergences) {
    exponents.push_back(one.exponent);
    from += one.from / static_cast<double>(divergences.size());
    to += one.to / static_cast<double>(divergences.size());
  }
  std::vector<json> cells{pairs, exponents.size()};
  if (exponents.empty()) return cells.resize(7), cells;
  if (exponents.size() > 1) {
    const Estimate mean = estimate_mean(exponents);
    cells.insert(cells.end(), {mean.value, mean.low, mean.high});
  } else {
    cells.insert(cells.end(), {exponents.front(), nullptr, nullptr});
  }
  cells.insert(cells.end(), {from, to});
  return cells;
}

}  // namespace

std::optional<Divergence> measure_divergence(std::span<const double> t, const Columns& a, const Columns& b) {
  const double size = size_of(a);
  std::vector<double> times;
  std::vector<double> logarithms;
  bool begun = false;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double apart = distance(a, b, k);
    if (apart > kCeiling * size && begun) break;
    begun |= apart > kFloor * size;
    if (!begun || apart == 0.0) continue;
    times.push_back(t[k]);
    logarithms.push_back(std::log(apart));
    if (k + 1 == t.size()) return std::nullopt;  // they have not parted
  }
  if (times.size() < kFewestForSlope) return std::nullopt;
  const double exponent = slope_of(times, logarithms);
  // They came closer, until one impact more or less threw them apart
  if (exponent <= 0.0) return std::nullopt;
  return Divergence{.exponent = exponent, .from = times.front(), .to = times.back()};
}

ResultTable make_lyapunov(const json& axes, const ResultTable& results, const FindTrajectory& find) {
  if (std::ranges::find(results.columns, "replicate") == results.columns.end())
    throw WrongState("the sweep has no replicates, which could part");
  if (results.rows.size() > kMostJobsOfDiagram) {
    throw WrongState("the sweep has " + std::to_string(results.rows.size()) +
                     " jobs; exponents are measured of " + std::to_string(kMostJobsOfDiagram) + " at most");
  }
  ResultTable table{.columns = axes.get<std::vector<std::string>>(), .rows = {}, .ended = results.ended};
  std::vector<std::size_t> swept;
  for (const std::string& path : table.columns) swept.push_back(find_column(results, path, ""));
  table.columns.insert(table.columns.end(), {"pairs", "pairs_diverged", "exponent_1_s", "exponent_low_1_s",
                                             "exponent_high_1_s", "from_s", "to_s"});
  const std::size_t job = find_column(results, "job_id", "");
  for (const RowGroup& set : group_rows(results, swept)) {
    const auto first = find_orbit(results.rows[set.rows.front()][job], find);
    std::vector<Divergence> divergences;
    std::size_t pairs = 0;
    for (std::size_t k = 1; k < set.rows.size(); ++k) {
      const auto other = find_orbit(results.rows[set.rows[k]][job], find);
      if (!first || !other) continue;
      ++pairs;
      if (const auto divergence = compare(*first, *other)) divergences.push_back(*divergence);
    }
    std::vector<json> cells = set.values;
    const auto measured = cells_of(pairs, divergences);
    cells.insert(cells.end(), measured.begin(), measured.end());
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
