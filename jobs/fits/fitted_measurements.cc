// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fitted_measurements.h"

#include <algorithm>
#include <utility>

#include "jobs/parameters/parameter_value.h"

namespace jobs {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

/// Window of two ascending times.
std::optional<TimeWindow> window_of(const json& given) {
  const bool right = given.is_array() && given.size() == 2 && given[0].is_number() && given[1].is_number() &&
                     given[0].get<double>() < given[1].get<double>();
  if (!right) return std::nullopt;
  return TimeWindow{.from_s = given[0].get<double>(), .to_s = given[1].get<double>()};
}

}  // namespace

void FittedMeasurementsParser::read_measurements() {
  const json given = request_.value("measurements", ordered_json());
  if (!given.is_array() || given.empty() || given.size() > kMostFittedMeasurements)
    return fault("/measurements", "must be a list of 1 to " + std::to_string(kMostFittedMeasurements) +
                                      " objects, {\"id\": \"mea_...\"}, say");
  for (std::size_t k = 0; k < given.size(); ++k)
    read_measurement(given[k], "/measurements/" + std::to_string(k));
}

void FittedMeasurementsParser::read_measurement(const json& given, const std::string& pointer) {
  if (!given.is_object()) return fault(pointer, "must be an object with \"id\"");
  check_keys_of(given, pointer, kFittedMeasurementKeys);
  const json id = given.value("id", json());
  if (!id.is_string()) return fault(pointer + "/id", "must be the id of a measurement");
  auto found = find_measurement_(id.get<std::string>());
  if (!found) return fault(pointer + "/id", "there is no measurement " + id.get<std::string>());
  FittedMeasurement one;
  one.pointer = pointer;
  one.measurement = std::move(*found);
  one.id = id.get<std::string>();
  read_selection(given, one);
  read_channels(given, one);
  measurements_.push_back(std::move(one));
}

void FittedMeasurementsParser::read_selection(const json& given, FittedMeasurement& one) {
  const std::string& pointer = one.pointer;
  one.runs = read_runs(given, pointer, "runs", one.measurement.runs.size(), true);
  for (const std::size_t run :
       read_runs(given, pointer, "held_back_runs", one.measurement.runs.size(), false)) {
    if (std::ranges::find(one.runs, run) == one.runs.end())
      fault(pointer + "/held_back_runs", "has run " + std::to_string(run) + ", which is not among runs");
    one.held_back_runs.insert(run);
  }
  one.fitted = read_windows(given, pointer, "fitted");
  one.held_back = read_windows(given, pointer, "held_back");
  if (given.contains("time_shift_s") &&
      is_right(pointer + "/time_shift_s", describe_number_fault({}, "s", given.at("time_shift_s"))))
    one.time_shift_s = given.at("time_shift_s").get<double>();
}

std::vector<std::size_t> FittedMeasurementsParser::read_runs(const json& given, const std::string& pointer,
                                                            const char* key, std::size_t count, bool all) {
  std::vector<std::size_t> runs;
  if (!given.contains(key)) {
    for (std::size_t k = 0; all && k < count; ++k) runs.push_back(k);
    return runs;
  }
  const json& list = given.at(key);
  if (!list.is_array() || (all && list.empty())) {
    fault(pointer + "/" + key, "must be a list of numbers of runs, from 0 to " + std::to_string(count - 1));
    return runs;
  }
  return read_run_list(list, pointer + "/" + key, count);
}

std::vector<std::size_t> FittedMeasurementsParser::read_run_list(const json& list, const std::string& pointer,
                                                                 std::size_t count) {
  const Range range{.minimum = 0.0, .maximum = static_cast<double>(count - 1)};
  std::vector<std::size_t> runs;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string place = pointer + "/" + std::to_string(k);
    if (!is_right(place, describe_integer_fault(range, list[k]))) continue;
    const auto run = list[k].get<std::size_t>();
    if (std::ranges::find(runs, run) != runs.end()) fault(place, "is in the list already");
    runs.push_back(run);
  }
  return runs;
}

std::vector<TimeWindow> FittedMeasurementsParser::read_windows(const json& given, const std::string& pointer,
                                                              const char* key) {
  std::vector<TimeWindow> windows;
  if (!given.contains(key)) return windows;
  const json& list = given.at(key);
  if (!list.is_array()) {
    fault(pointer + "/" + key, "must be a list of windows, [[0, 2]], say");
    return windows;
  }
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (const auto window = window_of(list[k])) windows.push_back(*window);
    else fault(pointer + "/" + key + "/" + std::to_string(k), "must be two ascending times, [0, 2], say");
  }
  return windows;
}

void FittedMeasurementsParser::read_channels(const json& given, FittedMeasurement& one) {
  if (!given.contains("channels")) return;
  const std::string pointer = one.pointer + "/channels";
  const json& channels = given.at("channels");
  if (!channels.is_object() || channels.empty())
    return fault(pointer, "must be an object of channels, {\"slider_acceleration_m_s2\": {}}, say");
  std::vector<std::string_view> known;
  for (const MeasuredChannel& channel : one.measurement.channels) known.push_back(channel.name);
  for (const auto& [name, options] : channels.items()) {
    const std::string place = pointer + pointer_token(name);
    if (std::ranges::find(known, name) == known.end()) fault(place, describe_unknown_key(name, known));
    else if (!options.is_object()) fault(place, "must be an object of weight and noise");
    else read_channel(name, options, one);
  }
}

void FittedMeasurementsParser::read_channel(const std::string& name, const json& options,
                                            FittedMeasurement& one) {
  const std::string pointer = one.pointer + "/channels" + pointer_token(name);
  check_keys_of(options, pointer, kFittedChannelKeys);
  for (const std::string_view key : kFittedChannelKeys) {
    const Range above_0{.minimum = 0.0, .lower = Bound::kExclusive};
    if (options.contains(key))
      is_right(pointer + "/" + std::string(key), describe_number_fault(above_0, "", options.at(key)));
  }
  one.channels[name] = options;
}

}  // namespace jobs
