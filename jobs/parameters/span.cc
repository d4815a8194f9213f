// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/span.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;

std::string describe_end_fault(const json& span, const char* end, bool logarithmic) {
  if (!span.contains(end)) return "is missing";
  Range range;
  if (logarithmic) range = {.minimum = 0.0, .lower = Bound::kExclusive};
  return describe_number_fault(range, "", span.at(end)).empty() ? ""
         : logarithmic                                          ? "must be a number above 0"
                                                                : "must be a number";
}

/// Adds the faults of unknown keys.
void check_keys_of_span(const json& span, std::span<const std::string_view> other_keys,
                        const std::string& pointer, std::vector<Fault>& faults) {
  std::vector<std::string_view> keys{"from", "to", "scale"};
  keys.insert(keys.end(), other_keys.begin(), other_keys.end());
  for (const auto& [key, value] : span.items()) {
    if (std::ranges::find(keys, key) == keys.end())
      faults.push_back({pointer + pointer_token(key), describe_unknown_key(key, keys)});
  }
}

/// Adds the faults of a span's scale and ends.
void check_range_of_span(const json& span, const std::string& pointer, std::vector<Fault>& faults) {
  const json scale = span.value("scale", json("linear"));
  if (scale != "linear" && scale != "log")
    faults.push_back({pointer + "/scale", "must be \"linear\" or \"log\""});
  for (const char* end : {"from", "to"}) {
    std::string detail = describe_end_fault(span, end, scale == "log");
    if (!detail.empty()) faults.push_back({pointer + "/" + end, std::move(detail)});
  }
}

/// Place of the first digit: 0 of 1 to 9.99, -1 of 0.1 to 0.999. @param x  not 0
int first_place(double x) { return static_cast<int>(std::floor(std::log10(std::abs(x)))); }

/// Nearest decimal of at most 12 digits, none below the 15th place of a number of the given scale.
double nearest_decimal(double x, double scale) {
  constexpr int kDigits = 12;
  constexpr int kPlaces = 15;  // one less than a double has for certain
  if (x == 0.0 || !std::isfinite(x)) return x;
  const int digits = std::min(kDigits, kPlaces + first_place(x) - first_place(scale));
  if (digits < 1) return 0.0;
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), x,
                                     std::chars_format::scientific, digits - 1);
  double rounded = x;
  std::from_chars(text.data(), written.ptr, rounded);
  return rounded;
}

}  // namespace

double geometric_between(double from, double to, double part) { return from * std::pow(to / from, part); }

double decimal_between(const Span& span, long double part, double steps) {
  if (part <= 0.0L) return span.from;
  if (part >= 1.0L) return span.to;
  const auto x = static_cast<double>(
      span.logarithmic ? span.from * std::pow(static_cast<long double>(span.to / span.from), part)
                       : span.from * (1.0L - part) + span.to * part);
  const double scale = span.logarithmic ? x : std::max(std::abs(span.from), std::abs(span.to));
  const long double width = span.logarithmic
                                ? std::abs(static_cast<long double>(x) * std::log(span.to / span.from))
                                : std::abs(static_cast<long double>(span.to) - span.from);
  const double rounded = nearest_decimal(x, scale);
  const long double moved = std::abs(static_cast<long double>(rounded) - x);
  const auto [least, most] = std::minmax(span.from, span.to);
  return std::clamp(moved <= 1e-3L * width / steps ? rounded : x, least, most);
}

std::optional<Span> read_span(const json& span, std::span<const std::string_view> other_keys,
                              const std::string& pointer, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  check_keys_of_span(span, other_keys, pointer, faults);
  check_range_of_span(span, pointer, faults);
  if (faults.size() != before) return std::nullopt;
  const Span read{.from = span.at("from").get<double>(),
                  .to = span.at("to").get<double>(),
                  .logarithmic = span.value("scale", "linear") == "log"};
  if (read.logarithmic && !std::isnormal(read.to / read.from)) {
    faults.push_back({pointer + "/to", "must be 1e-307 to 1e308 times from, as the scale is \"log\""});
    return std::nullopt;
  }
  return read;
}

}  // namespace jobs
