// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/read_measurement_json.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "jobs/measurements/check_measurement.h"
#include "jobs/measurements/sensor.h"
#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Reads one request; a member function a part of it.
class MeasurementParser {
 public:
  explicit MeasurementParser(const ordered_json& request) : request_(request) {}

  Measurement parse() {
    if (!request_.is_object()) refuse_body("must be an object");
    check_keys(request_, "", kMeasurementKeys);
    read_name();
    read_channels();
    throw_if_any(faults_);
    read_runs();
    throw_if_any(std::move(faults_));
    return std::move(measurement_);
  }

 private:
  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  void check_keys(const ordered_json& object, const std::string& pointer,
                  std::span<const std::string_view> known) {
    check_measured_keys(object, pointer, known, faults_);
  }

  void read_name() {
    if (!request_.contains("name")) return;
    const ordered_json& name = request_.at("name");
    const std::string text = name.is_string() ? name.get<std::string>() : "";
    const std::string detail = name.is_string() ? describe_measurement_name_fault(text) : "must be a string";
    if (!detail.empty()) return fault("/name", detail);
    measurement_.name = text;
  }

  /// List of 1 to `most` items under a key; null if there is none, which is a fault.
  const ordered_json* find_list(const std::string& key, std::size_t most) {
    const auto found = request_.find(key);
    const bool good =
        found != request_.end() && found->is_array() && !found->empty() && found->size() <= most;
    if (!good) fault("/" + key, "must be a list of 1 to " + std::to_string(most) + " items");
    return good ? &*found : nullptr;
  }

  void read_channels() {
    const ordered_json* const channels = find_list("channels", kMostMeasuredChannels);
    if (channels == nullptr) return;
    for (std::size_t c = 0; c < channels->size(); ++c)
      read_channel((*channels)[c], "/channels/" + std::to_string(c));
  }

  void read_channel(const ordered_json& given, const std::string& pointer) {
    if (!given.is_object()) return fault(pointer, "must be an object");
    check_keys(given, pointer, kMeasuredChannelKeys);
    MeasuredChannel channel;
    channel.name = text_of(given, "name", pointer);
    if (const std::string detail = describe_channel_name_fault(channel.name); !detail.empty())
      fault(pointer + "/name", quoted_text(channel.name) + " " + detail);
    const auto& others = measurement_.channels;
    if (std::ranges::find(others, channel.name, &MeasuredChannel::name) != others.end())
      fault(pointer + "/name", quoted_text(channel.name) + " stands twice");
    channel.column = given.contains("column") ? text_of(given, "column", pointer) : channel.name;
    read_sensor(given, pointer, channel, faults_);
    measurement_.channels.push_back(std::move(channel));
  }

  std::string text_of(const ordered_json& object, const char* key, const std::string& pointer) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_string()) {
      fault(pointer + "/" + key, "must be a string");
      return "";
    }
    std::string text = found->get<std::string>();
    if (std::string detail = describe_measurement_name_fault(text); !detail.empty())
      fault(pointer + "/" + key, std::move(detail));
    return text;
  }

  void read_runs() {
    const ordered_json* const runs = find_list("runs", kMostMeasuredRuns);
    if (runs == nullptr) return;
    for (std::size_t r = 0; r < runs->size() && faults_.size() < kMostFileFaults; ++r)
      read_run((*runs)[r], "/runs/" + std::to_string(r));
  }

  void read_run(const ordered_json& given, const std::string& pointer) {
    if (!given.is_object()) return fault(pointer, "must be an object");
    check_keys(given, pointer, kMeasuredRunKeys);
    MeasuredRun run;
    if (given.contains("parameters"))
      run.parameters = read_run_parameters(given.at("parameters"), pointer + "/parameters", faults_);
    const std::size_t before = faults_.size();
    run.time_s = numbers_of(given, kTimeColumn, pointer);
    if (faults_.size() == before) check_times(run.time_s, pointer + "/time_s");
    read_values(given, pointer + "/values", run);
    measurement_.runs.push_back(std::move(run));
  }

  void check_times(const std::vector<double>& time_s, const std::string& pointer) {
    add_time_faults(
        time_s,
        [&](std::size_t k, const std::string& text) {
          return Fault{pointer + "/" + std::to_string(k), text};
        },
        {pointer, "must be a list of " + std::to_string(kFewestMeasuredSamples) + " numbers or more"},
        faults_);
  }

  void read_values(const ordered_json& given, const std::string& pointer, MeasuredRun& run) {
    const auto values = given.find("values");
    if (values == given.end() || !values->is_object())
      return fault(pointer, "must be an object with a list of numbers for each channel");
    for (const auto& [key, value] : values->items())
      if (std::ranges::find(measurement_.channels, key, &MeasuredChannel::name) ==
          measurement_.channels.end())
        fault(pointer + pointer_token(key), "is no channel of this measurement");
    for (const MeasuredChannel& channel : measurement_.channels) {
      run.columns.push_back(numbers_of(*values, channel.name, pointer));
      if (run.columns.back().size() != run.time_s.size() && faults_.empty())
        fault(pointer + pointer_token(channel.name), "has " + std::to_string(run.columns.back().size()) +
                                                         " numbers, but time_s has " +
                                                         std::to_string(run.time_s.size()));
    }
  }

  /// Finite numbers of a list. Those that are none are faults.
  std::vector<double> numbers_of(const ordered_json& object, const std::string& key,
                                 const std::string& pointer) {
    const std::string here = pointer + pointer_token(key);
    const auto list = object.find(key);
    if (list == object.end() || !list->is_array()) {
      fault(here, "must be a list of numbers");
      return {};
    }
    check_value_count(values_ += list->size());
    return read_numbers(*list, here);
  }

  std::vector<double> read_numbers(const ordered_json& list, const std::string& pointer) {
    std::vector<double> numbers;
    numbers.reserve(list.size());
    for (const ordered_json& value : list) {
      numbers.push_back(value.is_number() ? value.get<double>() : 0.0);
      if (value.is_number() || faults_.size() >= kMostFileFaults) continue;
      fault(pointer + "/" + std::to_string(numbers.size() - 1),
            "must be a number" + (value.is_null() ? std::string("; ") + kNoGaps : ""));
    }
    return numbers;
  }

  const ordered_json& request_;
  Measurement measurement_;
  std::size_t values_ = 0;
  std::vector<Fault> faults_;
};

}  // namespace

Measurement read_measurement_json(const ordered_json& request) { return MeasurementParser(request).parse(); }

}  // namespace jobs
