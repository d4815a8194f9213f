// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/replicate_statistics.h"

#include <algorithm>
#include <cmath>

namespace jobs {
namespace {

double calc_mean(std::span<const double> values) {
  double excess = 0.0;  // over the first value
  for (const double x : values) excess += x - values.front();
  return values.front() + excess / static_cast<double>(values.size());
}

}  // namespace

ReplicateStatistics calc_replicate_statistics(std::span<const double> values) {
  ReplicateStatistics statistics;
  statistics.count = values.size();
  if (values.empty()) return statistics;
  const auto [min, max] = std::ranges::minmax(values);
  const double mean = calc_mean(values);
  statistics.mean = mean;
  statistics.min = min;
  statistics.max = max;
  if (values.size() < 2) return statistics;
  double squares = 0.0;
  for (const double x : values) squares += (x - mean) * (x - mean);
  statistics.spread = std::sqrt(squares / (static_cast<double>(values.size()) - 1.0));
  return statistics;
}

std::vector<ReplicateStatistics> calc_statistics_by_row(std::span<const ReplicateValue> rows) {
  std::vector<ReplicateStatistics> by_row;
  by_row.reserve(rows.size());
  std::vector<double> values;
  for (auto set = rows.begin(); set != rows.end();) {
    const auto end =
        std::find_if(set + 1, rows.end(), [](const ReplicateValue& row) { return row.replicate == 0; });
    values.clear();
    for (const ReplicateValue& row : std::span(set, end)) {
      if (row.value) values.push_back(*row.value);
    }
    by_row.insert(by_row.end(), static_cast<std::size_t>(end - set), calc_replicate_statistics(values));
    set = end;
  }
  return by_row;
}

}  // namespace jobs
