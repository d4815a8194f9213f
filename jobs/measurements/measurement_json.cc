// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/measurement_json.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "jobs/base/optional_json.h"
#include "jobs/measurements/channel_unit.h"

namespace jobs {
namespace {

using nlohmann::json;

json channel_json(const MeasuredChannel& channel) {
  return {{"name", channel.name},       {"unit", find_unit(channel.name).value_or("")},
          {"column", channel.column},   {"sign", channel.sign > 0.0 ? 1 : -1},
          {"gain", channel.gain},       {"offset", channel.offset},
          {"delay_s", channel.delay_s}, {"low_pass_hz", value_or_null(channel.low_pass_hz)}};
}

MeasuredChannel channel_of(const json& given) {
  MeasuredChannel channel{.name = given.at("name"),
                          .column = given.at("column"),
                          .sign = given.at("sign"),
                          .gain = given.at("gain"),
                          .offset = given.at("offset"),
                          .delay_s = given.at("delay_s")};
  if (!given.at("low_pass_hz").is_null()) channel.low_pass_hz = given.at("low_pass_hz").get<double>();
  return channel;
}

/// Root mean square of the samples, each with the same weight. Scaled so that squares do not overflow.
double calc_rms(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double x : values) largest = std::max(largest, std::abs(x));
  if (largest == 0.0) return 0.0;
  double sum = 0.0;
  for (const double x : values) sum += (x / largest) * (x / largest);
  return largest * std::sqrt(sum / static_cast<double>(values.size()));
}

json sampling_json(const std::vector<double>& time_s) {
  double least = time_s.back() - time_s.front();
  double largest = 0.0;
  for (std::size_t k = 1; k < time_s.size(); ++k) {
    least = std::min(least, time_s[k] - time_s[k - 1]);
    largest = std::max(largest, time_s[k] - time_s[k - 1]);
  }
  const double rate = static_cast<double>(time_s.size() - 1) / (time_s.back() - time_s.front());
  return {{"rate_hz", rate}, {"least_step_s", least}, {"largest_step_s", largest}};
}

json run_json(const Measurement& measurement, const MeasuredRun& run) {
  json statistics = json::array();
  for (std::size_t c = 0; c < run.columns.size(); ++c) {
    const auto [least, largest] = std::ranges::minmax(run.columns[c]);
    statistics.push_back({{"channel", measurement.channels[c].name},
                          {"min", least},
                          {"max", largest},
                          {"rms", calc_rms(run.columns[c])}});
  }
  return {{"parameters", run.parameters},          {"samples", run.time_s.size()},
          {"start_s", run.time_s.front()},         {"end_s", run.time_s.back()},
          {"sampling", sampling_json(run.time_s)}, {"statistics", std::move(statistics)}};
}

}  // namespace

json measurement_json(const Measurement& measurement) {
  json channels = json::array();
  for (const MeasuredChannel& channel : measurement.channels) channels.push_back(channel_json(channel));
  json runs = json::array();
  std::size_t samples = 0;
  double duration = 0.0;
  for (const MeasuredRun& run : measurement.runs) {
    runs.push_back(run_json(measurement, run));
    samples += run.time_s.size();
    duration += run.time_s.back() - run.time_s.front();
  }
  return {{"samples", samples},
          {"duration_s", duration},
          {"channels", std::move(channels)},
          {"runs", std::move(runs)}};
}

Measurement measurement_of(const json& description) {
  Measurement measurement;
  for (const json& given : description.at("channels")) measurement.channels.push_back(channel_of(given));
  for (const json& given : description.at("runs")) {
    measurement.runs.emplace_back();
    measurement.runs.back().parameters = given.at("parameters");
  }
  return measurement;
}

}  // namespace jobs
