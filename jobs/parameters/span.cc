// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/span.h"

#include <algorithm>
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

}  // namespace

double geometric_between(double from, double to, double part) { return from * std::pow(to / from, part); }

std::optional<Span> read_span(const json& span, std::span<const std::string_view> other_keys,
                              const std::string& pointer, std::vector<Fault>& faults) {
  std::vector<std::string_view> keys{"from", "to", "scale"};
  keys.insert(keys.end(), other_keys.begin(), other_keys.end());
  const std::size_t before = faults.size();
  for (const auto& [key, value] : span.items()) {
    if (std::ranges::find(keys, key) == keys.end())
      faults.push_back({pointer + pointer_token(key), describe_unknown_key(key, keys)});
  }
  const json scale = span.value("scale", json("linear"));
  if (scale != "linear" && scale != "log")
    faults.push_back({pointer + "/scale", "must be \"linear\" or \"log\""});
  for (const char* end : {"from", "to"}) {
    std::string detail = describe_end_fault(span, end, scale == "log");
    if (!detail.empty()) faults.push_back({pointer + "/" + end, std::move(detail)});
  }
  if (faults.size() != before) return std::nullopt;
  const Span read{.from = span.at("from").get<double>(), .to = span.at("to").get<double>(),
                  .logarithmic = scale == "log"};
  if (read.logarithmic && !std::isnormal(read.to / read.from)) {
    faults.push_back({pointer + "/to", "must be 1e-307 to 1e308 times from, as the scale is \"log\""});
    return std::nullopt;
  }
  return read;
}

}  // namespace jobs
