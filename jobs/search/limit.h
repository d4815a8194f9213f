// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace jobs {

/// Interval of a parameter in which a limit is searched, from one end to the other; `to` may be the smaller
/// one.
struct SearchInterval {
  double from = 0.0;
  double to = 0.0;
  bool logarithmic = false;   ///< bisects ratios instead of differences; both ends are above 0 then
  bool integer = false;
  double tolerance = 0.0;     ///< largest width of the final bracket, > 0
  bool in_ratios = false;     ///< whether widths are logarithms of ratios, not differences
  std::uint64_t first = 2;    ///< values that are tried at first, both ends among them, >= 2
};

/// Results of the replicates at one value of the parameter.
struct Evaluation {
  double x = 0.0;
  std::size_t pending = 0;     ///< jobs that wait or run
  std::size_t lost = 0;        ///< jobs that have ended without a value
  std::optional<std::string> lost_reason{};  ///< of the first of them, in any words
  std::vector<double> values;  ///< of the others, in any order
};

/// Criterion of a limit: the given quantile of the replicates' metric is not above the bound.
struct LimitRule {
  double bound = 0.0;
  double quantile = 0.9;  ///< in (0, 1]; 1: all of them
};

enum class Verdict {
  kOpen,           ///< there is more to evaluate
  kFound,          ///< between `within` and `beyond`
  kNeverExceeded,  ///< within the bound at all values that were tried
  kAlwaysExceeded, ///< beyond it at the first value already
  kLost,           ///< a job without a value is in the way
};
[[nodiscard]] std::string_view verdict_name(Verdict verdict);

/// Part of the interval along which the metric falls.
struct Fall {
  double from = 0.0, to = 0.0;
  bool within_again = false;  ///< the bound, which was exceeded before
};

struct Limit {
  Verdict verdict = Verdict::kOpen;
  std::optional<double> within;   ///< the last value before the metric first exceeds its bound
  std::optional<double> beyond;   ///< the first value at which it does
  // Empty where each value has been run once
  std::optional<double> band_from;  ///< up to here every replicate stays within the bound
  std::optional<double> band_to;    ///< from here on none does
  std::optional<std::string> lost_reason{};  ///< of kLost: that of the evaluation in the way
  std::vector<Fall> falls;
  std::vector<double> next;       ///< values to evaluate now; empty while jobs are pending
};

/// Empirical quantile: the smallest of the values such that at least that part of them is not above it.
/// @param values  one or more
[[nodiscard]] double calc_quantile(std::vector<double> values, double quantile);

/// Values that are evaluated first: in equal steps or ratios, both ends exact, each once.
[[nodiscard]] std::vector<double> first_values(const SearchInterval& interval);

/// Largest number of evaluations of a search, those of first_values() among them.
[[nodiscard]] std::size_t most_evaluations(const SearchInterval& interval);

/// First crossing of the bound along the interval, by bisection: the first bracket between a value within the
/// bound and one beyond it is halved until it is not wider than the tolerance. Later crossings are reported
/// as falls but not refined. A fall counts if all replicates at its end lie below all at its beginning, or if
/// the bound holds again.
/// @param evaluations  in any order, each value once; those outside the interval do not count
[[nodiscard]] Limit find_limit(const SearchInterval& interval, const LimitRule& rule,
                               std::vector<Evaluation> evaluations);

}  // namespace jobs
