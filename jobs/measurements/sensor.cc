// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/range.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr Range kAnyNumber;
constexpr Range kAboveZero = above(0.0, std::numeric_limits<double>::max());

/// Reads a number in a range; one that is not given stays as it is.
void read_number(const ordered_json& object, const char* key, const std::string& pointer, const Range& range,
                 double& number, std::vector<Fault>& faults) {
  if (!object.contains(key)) return;
  const json value = object.at(key);
  const std::string detail = describe_number_fault(range, "", value);
  if (detail.empty()) number = value.get<double>();
  else faults.push_back({pointer + "/" + key, detail});
}

}  // namespace

void check_measured_keys(const ordered_json& object, const std::string& pointer,
                         std::span<const std::string_view> known, std::vector<Fault>& faults) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(known, key) == known.end())
      faults.push_back({pointer + pointer_token(key), describe_unknown_key(key, known)});
}

void read_sensor(const ordered_json& given, const std::string& pointer, MeasuredChannel& channel,
                 std::vector<Fault>& faults) {
  read_number(given, "sign", pointer, kAnyNumber, channel.sign, faults);
  if (std::abs(channel.sign) != 1.0) faults.push_back({pointer + "/sign", "must be 1 or -1"});
  read_number(given, "gain", pointer, kAboveZero, channel.gain, faults);
  read_number(given, "offset", pointer, kAnyNumber, channel.offset, faults);
  read_number(given, "delay_s", pointer, kAnyNumber, channel.delay_s, faults);
  if (given.contains("low_pass_hz") && !given.at("low_pass_hz").is_null())
    read_number(given, "low_pass_hz", pointer, kAboveZero, channel.low_pass_hz.emplace(1.0), faults);
}

json read_run_parameters(const ordered_json& given, const std::string& pointer, std::vector<Fault>& faults) {
  if (!given.is_object()) {
    faults.push_back({pointer, "must be an object"});
    return json::object();
  }
  json parameters = given;
  try {
    static_cast<void>(complete_parameters(parameters, pointer));
  } catch (const InvalidRequest& invalid) {
    faults.insert(faults.end(), invalid.faults().begin(), invalid.faults().end());
  }
  return parameters;
}

}  // namespace jobs
