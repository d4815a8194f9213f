// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace jobs {

/// The metric that replicates of a parameter set are compared by, unless another one is chosen.
inline constexpr std::string_view kReplicateMetric = "peak_slider_acceleration_m_s2";

/// Statistics of a metric over the replicates of one parameter set, in its unit.
struct ReplicateStatistics {
  std::size_t count = 0;         ///< replicates that have a value: those that have succeeded
  std::optional<double> mean;    ///< empty if count is 0
  std::optional<double> spread;  ///< sample standard deviation (divisor count - 1); empty if count is below 2
  std::optional<double> min;     ///< empty if count is 0
  std::optional<double> max;     ///< empty if count is 0
};

/// Two passes, the first over differences from the first value: equal values have themselves as mean, and
/// spread 0.
/// @param values  finite
[[nodiscard]] ReplicateStatistics calc_replicate_statistics(std::span<const double> values);

/// One run as the grouping sees it.
struct ReplicateValue {
  std::size_t replicate = 0;    ///< 0: the unperturbed one, with which a set begins
  std::optional<double> value;  ///< empty: failed, cancelled or not yet ended
};

/// Statistics of the set that each row belongs to, one a row. A set is a row of replicate 0 and those that
/// follow it up to the next one, so that two equal sets (a case listed twice in two ways) are two samples,
/// not one.
/// @param rows  in the order in which the sweep was expanded: the replicates of a set together
[[nodiscard]] std::vector<ReplicateStatistics> calc_statistics_by_row(std::span<const ReplicateValue> rows);

}  // namespace jobs
