// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/measurement_schemas.h"

#include <cstddef>
#include <utility>

#include "jobs/measurements/measurement.h"
#include "jobs/requests/sweep_request.h"

namespace server::openapi {

namespace {

Json positive_number(std::string_view description) {
  return described({{"type", "number"}, {"exclusiveMinimum", 0}}, description);
}

Json list_between(Json items, std::size_t least, std::size_t most) {
  Json list = list_of(std::move(items));
  list["minItems"] = least;
  list["maxItems"] = most;
  return list;
}

Json correction_properties() {
  return {{"sign", described({{"enum", {1, -1}}}, "direction of the sensor's axis")},
          {"gain", positive_number("factor of the samples")},
          {"offset", described(kNumber, "summand, in the unit of the channel")},
          {"delay_s", described(kNumber, "time by which the signal is behind the motion, in s")},
          {"low_pass_hz", described(or_null({{"type", "number"}, {"exclusiveMinimum", 0}}),
                                    "cut-off frequency of the sensor; null: unknown or none")}};
}

Json make_channel_request() {
  Json properties{{"name", described({{"type", "string"}, {"pattern", "^[A-Za-z0-9_]{1,200}$"}},
                                     "channel of a trajectory; the end is the unit")},
                  {"column", described({{"type", "string"}, {"maxLength", jobs::kLongestName}},
                                       "name in the lab's file; that of the channel if left out")}};
  properties.update(correction_properties());
  return object_of(std::move(properties), {"column", "sign", "gain", "offset", "delay_s", "low_pass_hz"});
}

Json make_run_request() {
  const Json samples = list_between(kNumber, jobs::kFewestMeasuredSamples, jobs::kMostMeasuredValues);
  return object_of({{"parameters", ref("Parameters")},
                    {"time_s", described(samples, "strictly increasing; steps may differ")},
                    {"values", described({{"type", "object"}, {"additionalProperties", samples}},
                                         "a list for each channel, as long as time_s")}},
                   {"parameters"});
}

Json make_measurement_request() {
  Json request =
      object_of({{"name", {{"type", "string"}, {"maxLength", jobs::kLongestName}}},
                 {"channels", list_between(make_channel_request(), 1, jobs::kMostMeasuredChannels)},
                 {"runs", list_between(make_run_request(), 1, jobs::kMostMeasuredRuns)}},
                {"name"});
  request["description"] =
      "Measured signals. The corrected signal at time t is sign * gain * x(t + delay_s) + offset; samples "
      "are "
      "kept as they are sent";
  request["examples"] = Json::array(
      {{{"channels", {{{"name", "slider_acceleration_m_s2"}}}},
        {"runs", {{{"time_s", {0, 0.001}}, {"values", {{"slider_acceleration_m_s2", {0.5, 0.75}}}}}}}}});
  return request;
}

Json make_measured_channel() {
  Json properties{{"name", kText}, {"unit", kText}, {"column", kText}};
  properties.update(correction_properties());
  return object_of(std::move(properties));
}

Json make_measured_run() {
  return object_of(
      {{"parameters", described({{"type", "object"}}, "those of a job that are known of the run")},
       {"samples", kCount},
       {"start_s", kNumber},
       {"end_s", kNumber},
       {"sampling", object_of({{"rate_hz", described(kNumber, "mean")},
                               {"least_step_s", kNumber},
                               {"largest_step_s", kNumber}})},
       {"statistics",
        list_of(object_of({{"channel", kText}, {"min", kNumber}, {"max", kNumber}, {"rms", kNumber}}))}});
}

Json measurement_properties() {
  return {{"id", ref("Id")},
          {"name", kText},
          {"created_at", kText},
          {"samples", described(kCount, "of all runs")},
          {"duration_s", described(kNumber, "of all runs together")},
          {"bytes", described(kCount, "that the samples take in the store")},
          {"channels", list_of(make_measured_channel())},
          {"links", texts_of({"self", "data"})}};
}

Json make_measurement() {
  Json properties = measurement_properties();
  properties["runs"] = list_of(make_measured_run());
  return object_of(std::move(properties));
}

}  // namespace

Json make_measurement_schemas() {
  // Items of a page may lack keys that ?fields= leaves out.
  return {{"MeasurementRequest", make_measurement_request()},
          {"Measurement", make_measurement()},
          {"MeasurementSummary", options_of(measurement_properties())},
          {"MeasurementPage",
           object_of({{"items", list_of(ref("MeasurementSummary"))}, {"next_cursor", kText}})}};
}

}  // namespace server::openapi
