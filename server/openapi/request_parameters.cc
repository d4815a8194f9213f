// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/request_parameters.h"

#include <vector>

#include "jobs/motion/spectrum.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/results/page_query.h"
#include "jobs/trajectories/decimate.h"
#include "jobs/wear/wear.h"
#include "server/messages/formats.h"

namespace server::openapi {

namespace {

const Json kNames{{"type", "array"}, {"minItems", 1}, {"items", kText}};

Json format_enum(DataShape shape) { return {{"type", "string"}, {"enum", format_words(shape)}}; }

Json make_metric() {
  Json names = Json::array();
  for (const engine::QuantityInfo& metric : engine::metric_table()) names.push_back(metric.key);
  return {
      {"anyOf", Json::array({Json{{"type", "string"}, {"enum", std::move(names)}},
                             Json{{"type", "string"},
                                  {"description", "of a described linkage, by the names of its joints"}}})}};
}

std::vector<RequestParameter> make_query_parameters() {
  return {
      {"state", "query", "state", "Only those in this state", ref("State")},
      {"search_state", "query", "state", "Only those in this state", ref("SearchState")},
      {"limit",
       "query",
       "limit",
       "How many at most",
       {{"type", "integer"},
        {"minimum", 1},
        {"maximum", jobs::PageQuery::kLargestLimit},
        {"default", jobs::PageQuery{}.limit}}},
      {"row_limit",
       "query",
       "limit",
       "How many rows at most; all if left out",
       {{"type", "integer"}, {"minimum", 0}}},
      {"cursor", "query", "cursor", "next_cursor of the page before; without it the newest", kText},
      {"fields", "query", "fields", "Only these keys, in this order; all if left out", kNames},
      {"order_by", "query", "order_by", "Columns to order by; after a '-' the largest first, and null last",
       kNames},
      {"filters",
       "query",
       "filters",
       "Any column, parameter, error_reason or error_detail as a key: key=value, key_gt=, key_lt=, key_ge=, "
       "key_le=. A row stays if all of them hold",
       {{"type", "object"}, {"additionalProperties", kText}}},
      {"columns",
       "query",
       "filters",
       "Any column as a key: key=value, key_gt=, key_lt=, key_ge=, key_le=. A row stays if all of them hold",
       {{"type", "object"}, {"additionalProperties", kText}}},
      {"row_format", "query", "format", "Instead of the Accept header", format_enum(DataShape::kRows)},
      {"column_format", "query", "format", "Instead of the Accept header", format_enum(DataShape::kColumns)},
      {"export_format", "query", "format", "Instead of the Accept header",
       format_enum(DataShape::kTrajectories)},
      {"dry_run",
       "query",
       "dry_run",
       "true: nothing is submitted; the answer is what it would cost",
       {{"type", "string"}, {"enum", {"false", "true"}}, {"default", "false"}}},
      {"metric", "query", "metric",
       "The metric; if left out the peak of the slider's acceleration, or the first acceleration of a "
       "described linkage that varies and that no drive prescribes, or else the first other metric that "
       "varies",
       make_metric()},
      {"report_x", "query", "x", "The number along the charts; the first that the sweep varies if left out",
       kText},
      {"report_rows",
       "query",
       "rows",
       "true: an appendix lists all jobs",
       {{"type", "string"}, {"enum", {"false", "true"}}, {"default", "false"}}},
      {"surrogate_x", "query", "x", "The number along x; the first that the sweep varies if left out", kText},
      {"surrogate_y", "query", "y", "The number along y; the next that the sweep varies if left out", kText},
      {"channel", "query", "channel",
       "The channel; if left out, the journal's or the first freedom's in sections, and "
       "slider_acceleration_m_s2 in spectra",
       kText},
      {"angle", "query", "angle",
       "The channel in rad whose passages make the section; if left out, crank_angle_rad or the first "
       "freedom of a described linkage that turns",
       kText},
      {"phase_rad",
       "query",
       "phase_rad",
       "The value of the angle at which a turn is looked at",
       {{"type", "number"}, {"default", 0}}},
      {"section_from",
       "query",
       "from",
       "Only from this time on, in s; from the end of the run-up if left out",
       {{"type", "number"}}},
      {"window",
       "query",
       "window",
       "hann tells frequencies apart, flat_top measures amplitudes between the lines",
       {{"type", "string"}, {"enum", jobs::kWindowNames}, {"default", jobs::kWindowNames[0]}}},
      {"wear_joint", "query", "joint", "Joint with a bore, of a described linkage; the first one if left out",
       kText},
      {"wear_coefficient_m2_n",
       "query",
       "wear_coefficient_m2_n",
       "Worn volume over normal force and sliding distance",
       {{"type", "number"},
        {"exclusiveMinimum", jobs::kWearCoefficientRange.minimum},
        {"maximum", jobs::kWearCoefficientRange.maximum},
        {"default", jobs::WearQuery{}.wear_coefficient}}},
      {"sectors",
       "query",
       "sectors",
       "Around the circumference",
       {{"type", "integer"},
        {"minimum", static_cast<int>(jobs::kMapSectorsRange.minimum)},
        {"maximum", static_cast<int>(jobs::kMapSectorsRange.maximum)},
        {"default", jobs::WearQuery{}.sectors}}},
      {"worn_clearance_mm",
       "query",
       "worn_clearance_mm",
       "The clearance whose life is asked for",
       {{"type", "number"}}},
      {"channels", "query", "channels", "These columns, after t_s; all if left out", kNames},
      {"measurement_name",
       "query",
       "name",
       "Name of the measurement; of CSV and NPZ",
       {{"type", "string"}, {"maxLength", jobs::kLongestName}}},
      {"measurement_time", "query", "time",
       "Column of the time, in s; of CSV and NPZ. If left out time_s, t_s, or the first column of CSV",
       kText},
      {"measurement_channels", "query", "channels",
       "COLUMN:CHANNEL, or the name of both; of CSV and NPZ. If left out each other column is a channel",
       kNames},
      {"measurement_sensors", "query", "sensors",
       "JSON object of corrections by channel, as those of the channels of a JSON body: sign, gain, offset, "
       "delay_s, low_pass_hz; of CSV and NPZ",
       kText},
      {"measurement_parameters", "query", "parameters",
       "JSON object of parameters that are known of the run; of CSV and NPZ", kText},
      {"run", "query", "run", "Number of the run, from 0; of a measurement of one run it may be left out",
       kCount},
      {"from", "query", "from", "Only samples from this time on, in s", {{"type", "number"}}},
      {"to", "query", "to", "Only samples up to this time, in s", {{"type", "number"}}},
      {"points",
       "query",
       "points",
       "Thinned out to so many samples at most, the smallest and the largest of each channel in each stretch "
       "of time among them; two for each channel at least",
       {{"type", "integer"}, {"minimum", jobs::fewest_points(0)}}},
  };
}

std::vector<RequestParameter> make_header_parameters() {
  return {
      {"idempotency_key",
       "header",
       "Idempotency-Key",
       "The same key with the same request is answered as before; nothing is made twice",
       {{"type", "string"}, {"minLength", 1}, {"maxLength", 255}, {"pattern", "^[!-~]+$"}}},
      {"if_match",
       "header",
       "If-Match",
       "An ETag: 412, and nothing done, if anything has changed since",
       {{"type", "string"}, {"minLength", 1}}},
      {"if_none_match", "header", "If-None-Match", "An ETag: 304 if nothing has changed", kText},
      {"range", "header", "Range",
       "bytes=N-: the rest of the file, to go on with a download; several ranges get all of it", kText},
      {"if_range", "header", "If-Range",
       "The ETag of the part that has come: all of the file if its bytes have changed", kText},
      {"last_event_id", "header", "Last-Event-ID", "The id of the last event that was received", kText},
      {"prefer", "header", "Prefer",
       "wait=N: the answer waits for the end of the job, sweep or study, N s at most", kText},
  };
}

}  // namespace

std::span<const RequestParameter> request_parameters() {
  static const std::vector<RequestParameter> parameters = [] {
    auto all = make_query_parameters();
    for (auto& header : make_header_parameters()) all.push_back(std::move(header));
    return all;
  }();
  return parameters;
}

}  // namespace server::openapi
