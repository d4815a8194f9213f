// SPDX-License-Identifier: Apache-2.0
// One set of parameters has one canonical text, however it was written.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "jobs/base/content_id.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

/// A value that the parameter may have, near its default.
json any_value(const jobs::ParameterInfo& info) {
  if (info.kind == jobs::ParameterKind::kChoice) return *rc::gen::elementOf(info.choices);
  const double usual = jobs::default_value(info).get<double>();
  const double factor = 1.0 + *rc::gen::inRange(-1000, 1001) * 1e-4 + *rc::gen::inRange(0, 1'000'000) * 1e-15;
  const double value =
      info.kind == jobs::ParameterKind::kInteger ? std::round(usual * factor) : usual * factor;
  return info.range.contains(value) ? value : usual;
}

/// One of the ways to write a number so that it reads back as it is.
std::string written(double value) {
  char text[64];
  switch (*rc::gen::inRange(0, 4)) {
    case 0: std::snprintf(text, sizeof text, "%.17g", value); return text;
    case 1: std::snprintf(text, sizeof text, "%.25e", value); return text;
    case 2: std::snprintf(text, sizeof text, "%.17E", value); return text;
    default: return {text, std::to_chars(text, text + sizeof text, value).ptr};
  }
}

std::string text_of(std::vector<std::pair<std::string, json>> values) {
  std::shuffle(values.begin(), values.end(), std::mt19937_64(*rc::gen::arbitrary<std::uint64_t>()));
  std::string text;
  for (const auto& [key, value] : values) {
    text += (text.empty() ? "{\"" : " ,\n\"") + key +
            "\":" + (value.is_number() ? written(value.get<double>()) : value.dump());
  }
  return text.empty() ? "{}" : text + "}";
}

std::string canonical(const std::string& text) {
  return jobs::canonical_text(jobs::fill_in_defaults(json_of(text)));
}

RC_GTEST_PROP(CanonicalText, IsTheSameForEveryOrderAndEveryWayToWriteNumbers, ()) {
  std::vector<std::pair<std::string, json>> values;
  for (const jobs::ParameterInfo& info : jobs::parameter_table()) {
    if (*rc::gen::arbitrary<bool>()) values.emplace_back(info.key, any_value(info));
  }
  const std::string first = text_of(values), second = text_of(values);
  RC_ASSERT(jobs::find_value_faults(json_of(first)).empty());
  const std::string text = canonical(first);
  RC_ASSERT(canonical(second) == text);
  RC_ASSERT(canonical(text) == text);  // of itself, too
  const json completed = json_of(text);
  for (const auto& [key, value] : values) RC_ASSERT(completed.at(key) == value);
}

RC_GTEST_PROP(CanonicalText, TellsAnyTwoNumbersApart, (std::uint64_t bits)) {
  const double speed = 1.0 + static_cast<double>(bits >> 12U) * 0x1p-52;  // any of the doubles in [1, 2)
  const json one{{"crank_velocity_rad_s", speed}}, next{{"crank_velocity_rad_s", std::nextafter(speed, 3.0)}};
  RC_ASSERT(canonical(one.dump()) != canonical(next.dump()));
  RC_ASSERT(json_of(canonical(one.dump())).at("crank_velocity_rad_s").get<double>() == speed);
}

}  // namespace
}  // namespace jobs_tests
