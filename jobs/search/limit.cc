// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/limit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "jobs/parameters/span.h"

namespace jobs {
namespace {

/// @returns whether a comes before b from one end of the interval to the other
bool comes_before(const SearchInterval& interval, double a, double b) {
  return interval.from <= interval.to ? a < b : a > b;
}

double value_between(const SearchInterval& interval, double a, double b, long double part, double steps) {
  const double x = decimal_between({.from = a, .to = b, .logarithmic = interval.logarithmic}, part, steps);
  return interval.integer ? std::round(x) : x;
}

/// Part of a number below which a bracket around the number is not halved any more
constexpr double kNarrowestPart = 4.0 * std::numeric_limits<double>::epsilon();

/// Largest width that still counts as the tolerance: 0.26 - 0.245 as doubles is a little more than 0.015.
double largest_width(const SearchInterval& interval) { return interval.tolerance * (1.0 + 1e-9); }

bool is_narrow(const SearchInterval& interval, double a, double b) {
  const double width = interval.in_ratios ? std::abs(std::log(b / a)) : std::abs(b - a);
  const double scale = interval.in_ratios ? 1.0 : std::max(std::abs(a), std::abs(b));
  if (width <= std::max(largest_width(interval), kNarrowestPart * scale)) return true;
  const double middle = value_between(interval, a, b, 0.5L, 1.0);
  return !(comes_before(interval, a, middle) &&
           comes_before(interval, middle, b));  // no integer, or no double, lies between
}

/// Verdict of the rule on an evaluation that has ended.
struct Judged {
  double x = 0.0;
  bool within = false;
  double least = 0.0, most = 0.0;  ///< of the replicates
  std::size_t count = 0;           ///< of the replicates
};

Judged judge(const Evaluation& evaluation, const LimitRule& rule) {
  const auto [least, most] = std::ranges::minmax(evaluation.values);
  return {.x = evaluation.x,
          .within = calc_quantile(evaluation.values, rule.quantile) <= rule.bound,
          .least = least,
          .most = most,
          .count = evaluation.values.size()};
}

/// Lost evaluation that decides the bracket: the first one up to the first value beyond the bound. Null:
/// none.
const Evaluation* find_lost(const std::vector<Evaluation>& evaluations, const LimitRule& rule) {
  for (const Evaluation& evaluation : evaluations) {
    if (evaluation.lost > 0) return &evaluation;
    if (!judge(evaluation, rule).within) return nullptr;
  }
  return nullptr;
}

/// One run of each value says nothing of the scatter: there is no band then.
void set_bands(const std::vector<Judged>& judged, const LimitRule& rule, Limit& limit) {
  if (std::ranges::none_of(judged, [](const Judged& at) { return at.count > 1; })) return;
  for (const Judged& at : judged) {
    if (at.most > rule.bound) break;
    limit.band_from = at.x;
  }
  for (auto at = judged.rbegin(); at != judged.rend() && at->least > rule.bound; ++at) limit.band_to = at->x;
}

void collect_falls(const std::vector<Judged>& judged, Limit& limit) {
  for (std::size_t i = 1; i < judged.size(); ++i) {
    const bool again = judged[i].within && !judged[i - 1].within;
    if (again || judged[i].most < judged[i - 1].least) {
      limit.falls.push_back({judged[i - 1].x, judged[i].x, again});
    }
  }
}

/// Relative error of a middle that decimal_between() rounds to 12 digits
constexpr double kDecimalError = 5e-12;

/// Bound of the halvings of a bracket. Each leaves at most half of its width and the error of its middle: at
/// most a thousandth of the width for the decimal, an eighth for the double.
std::size_t most_halvings_of_widths(const SearchInterval& interval, double a, double b) {
  if (is_narrow(interval, a, b)) return 0;
  const double largest = std::max(std::abs(a), std::abs(b));
  const double least = (a < 0.0) != (b < 0.0) ? 0.0 : std::min(std::abs(a), std::abs(b));
  const double end = std::max(largest_width(interval), kNarrowestPart * least);
  double width = std::abs(b - a);
  std::size_t halvings = 0;
  for (; width > end && width > 0.0; ++halvings) {
    width = width / 2.0 + std::min(width / 1000.0, kDecimalError * largest) +
            std::min(width / 8.0, std::numeric_limits<double>::epsilon() * largest);
  }
  return halvings;
}

/// The same by the ratio of the ends: of all brackets with one ratio that at the larger end is the widest.
std::size_t most_halvings_of_ratios(const SearchInterval& interval, double a, double b) {
  if (is_narrow(interval, a, b)) return 0;
  const double largest = std::max(a, b);
  const double end = std::max(largest_width(interval) / (interval.in_ratios ? 1.0 : largest), kNarrowestPart);
  double log_ratio = std::abs(std::log(b / a));
  std::size_t halvings = 0;
  for (; (interval.in_ratios ? log_ratio : -std::expm1(-log_ratio)) > end; ++halvings) {
    log_ratio = log_ratio / 2.0 + std::min(log_ratio / 1000.0, kDecimalError) +
                std::min(log_ratio / 8.0, std::numeric_limits<double>::epsilon());
  }
  return halvings;
}

/// The number itself: integers of parameters are few.
std::size_t most_halvings_of_integers(const SearchInterval& interval, double a, double b) {
  if (is_narrow(interval, a, b)) return 0;
  const double middle = value_between(interval, a, b, 0.5L, 1.0);
  return 1 + std::max(most_halvings_of_integers(interval, a, middle),
                      most_halvings_of_integers(interval, middle, b));
}

/// @returns whether a first value has been evaluated. Versions before this one did not round it to a decimal.
bool is_evaluated(const SearchInterval& interval, double x, const std::vector<Evaluation>& evaluations) {
  const double width = interval.logarithmic ? std::abs(x * std::log(interval.to / interval.from))
                                            : std::abs(interval.to - interval.from);
  return std::ranges::any_of(evaluations,
                             [&](const Evaluation& at) { return std::abs(at.x - x) <= 1e-9 * width; });
}

/// Keeps the evaluations in the interval, in their order along it.
void sort_inside(const SearchInterval& interval, std::vector<Evaluation>& evaluations) {
  std::erase_if(evaluations, [&](const Evaluation& at) {
    return comes_before(interval, at.x, interval.from) || comes_before(interval, interval.to, at.x);
  });
  std::ranges::sort(evaluations, [&](const Evaluation& a, const Evaluation& b) {
    return comes_before(interval, a.x, b.x);
  });
}

/// Verdicts on the evaluations that have ended.
std::vector<Judged> judge_ended(const std::vector<Evaluation>& evaluations, const LimitRule& rule) {
  std::vector<Judged> judged;
  for (const Evaluation& at : evaluations) {
    if (at.pending == 0 && at.lost == 0 && !at.values.empty()) judged.push_back(judge(at, rule));
  }
  return judged;
}

std::vector<double> list_unevaluated(const SearchInterval& interval,
                                     const std::vector<Evaluation>& evaluations) {
  std::vector<double> unevaluated;
  for (const double x : first_values(interval)) {
    if (!is_evaluated(interval, x, evaluations)) unevaluated.push_back(x);
  }
  return unevaluated;
}

void set_lost(const Evaluation& lost, Limit& limit) {
  limit.verdict = Verdict::kLost;
  limit.lost_reason = lost.lost_reason;
}

/// Sets the bracket of the limit, and its middle to be evaluated next if it is still wide.
void set_bracket(const SearchInterval& interval, const std::vector<Judged>& judged, Limit& limit) {
  const auto beyond = std::ranges::find(judged, false, &Judged::within);
  if (beyond != judged.end()) limit.beyond = beyond->x;
  if (beyond != judged.begin()) limit.within = std::prev(beyond)->x;
  if (!limit.beyond || !limit.within) {
    limit.verdict = limit.within ? Verdict::kNeverExceeded : Verdict::kAlwaysExceeded;
  } else if (is_narrow(interval, *limit.within, *limit.beyond)) {
    limit.verdict = Verdict::kFound;
  } else {
    limit.next = {value_between(interval, *limit.within, *limit.beyond, 0.5L, 1.0)};
  }
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  constexpr std::array<std::string_view, 5> kNames{"open", "found", "never_exceeded", "always_exceeded",
                                                   "lost"};
  return kNames[static_cast<std::size_t>(verdict)];
}

double calc_quantile(std::vector<double> values, double quantile) {
  std::ranges::sort(values);
  // 0.9 of ten values are nine of them, although 0.9 as a double is a little more.
  const double wanted = std::ceil(quantile * static_cast<double>(values.size()) * (1.0 - 1e-12));
  return values[static_cast<std::size_t>(std::max(wanted, 1.0)) - 1];
}

std::vector<double> first_values(const SearchInterval& interval) {
  std::vector<double> values;
  for (std::uint64_t k = 0; k < interval.first; ++k) {
    const auto steps = static_cast<double>(interval.first - 1);
    const double x = k == 0                    ? interval.from
                     : k + 1 == interval.first ? interval.to
                                               : value_between(interval, interval.from, interval.to,
                                                               static_cast<long double>(k) / steps, steps);
    if (values.empty() || values.back() != x) values.push_back(x);
  }
  return values;
}

std::size_t most_evaluations(const SearchInterval& interval) {
  const auto values = first_values(interval);
  std::size_t halvings = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double a = values[i - 1];
    const double b = values[i];
    halvings = std::max(halvings, interval.integer       ? most_halvings_of_integers(interval, a, b)
                                  : interval.logarithmic ? most_halvings_of_ratios(interval, a, b)
                                                         : most_halvings_of_widths(interval, a, b));
  }
  return values.size() + halvings;
}

Limit find_limit(const SearchInterval& interval, const LimitRule& rule, std::vector<Evaluation> evaluations) {
  sort_inside(interval, evaluations);
  Limit limit;
  const std::vector<Judged> judged = judge_ended(evaluations, rule);
  set_bands(judged, rule, limit);
  collect_falls(judged, limit);
  if (std::ranges::any_of(evaluations, [](const Evaluation& at) { return at.pending > 0; })) return limit;
  limit.next = list_unevaluated(interval, evaluations);
  if (!limit.next.empty()) return limit;
  if (const Evaluation* const lost = find_lost(evaluations, rule)) set_lost(*lost, limit);
  else set_bracket(interval, judged, limit);
  return limit;
}

}  // namespace jobs
