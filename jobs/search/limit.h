// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace jobs {

/// The way along which a limit is looked for: from one value of a parameter to another, which may be the smaller one.
struct SearchPath {
  double from = 0.0;
  double to = 0.0;
  bool logarithmic = false;   ///< halves ratios instead of differences; then both ends are above 0
  bool integer = false;
  double tolerance = 0.0;     ///< how far the ends of the bracket may be apart, > 0
  std::uint64_t first = 2;    ///< values that are tried at first, both ends among them, >= 2
};

/// What the replicates at one value of the parameter have shown.
struct Evaluation {
  double x = 0.0;
  std::size_t pending = 0;     ///< jobs that wait or run
  std::size_t lost = 0;        ///< jobs that have ended without a value
  std::optional<std::string> lost_reason{};  ///< of the first of them, in any words
  std::vector<double> values;  ///< of the others, in any order
};

/// When a metric stays below a bound: a part of the replicates that is at least `quantile` must not be above it.
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

/// A stretch along which the metric falls although the parameter goes on.
struct Fall {
  double from = 0.0, to = 0.0;
  bool within_again = false;  ///< the bound, which was exceeded before
};

struct Limit {
  Verdict verdict = Verdict::kOpen;
  std::optional<double> within;   ///< the last value before the metric first exceeds its bound
  std::optional<double> beyond;   ///< the first value at which it does
  std::optional<double> band_from;  ///< up to here every replicate stays within the bound
  std::optional<double> band_to;    ///< from here on none does
  std::optional<std::string> lost_reason{};  ///< of kLost: that of the evaluation in the way
  std::vector<Fall> falls;
  std::vector<double> next;       ///< values to evaluate now; empty while jobs are pending
};

/// The smallest of the values such that at least that part of them is not above it (the inverse of their distribution function).
/// @param values  one or more
[[nodiscard]] double calc_quantile(std::vector<double> values, double quantile);

/// The values that are tried first: in equal steps or ratios, both ends exact, each once.
[[nodiscard]] std::vector<double> first_values(const SearchPath& path);

/// How many evaluations a search along the path takes at most, those of first_values() among them.
[[nodiscard]] std::size_t most_evaluations(const SearchPath& path);

/// Where the metric first exceeds its bound along the path, as far as the evaluations tell: the first stretch between a value within it and
/// one beyond it is halved until it is no longer than the tolerance. Where a metric rises and falls, what comes after the first crossing is
/// told as a fall but not refined. A fall counts if all replicates at its end lie below all at its beginning, or if the bound holds again.
/// @param evaluations  in any order, each value once; those beyond the path's ends do not count
[[nodiscard]] Limit find_limit(const SearchPath& path, const LimitRule& rule, std::vector<Evaluation> evaluations);

}  // namespace jobs
