// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/search_schemas.h"

#include "jobs/requests/parameter_path.h"
#include "jobs/search/limit.h"
#include "jobs/base/states.h"

namespace server::openapi {

namespace {

Json make_verdict() {
  Json names = Json::array();
  for (int i = 0; i <= static_cast<int>(jobs::Verdict::kLost); ++i)
    names.push_back(jobs::verdict_name(static_cast<jobs::Verdict>(i)));
  return {{"type", "string"}, {"enum", std::move(names)},
          {"description", "open: not known yet; found; never_exceeded: within the bound at all values tried; "
                          "always_exceeded: beyond it at the first already; "
                          "lost: a job without a value is in the way, see lost_reason"}};
}

Json make_lost_reason() {
  return described(or_null(kText),
                   "the error_reason of a failed job, cancelled, no_value: the job succeeded and the metric "
                   "does not apply to it, or invalid_parameters: the value does not fit the others");
}

Json make_limit() {
  return {{"verdict", make_verdict()},
          {"limit", described(or_null(kNumber), "the last value before the metric first exceeds its bound")},
          {"limit_beyond", described(or_null(kNumber), "the first value at which it does")},
          {"band_from", described(or_null(kNumber), "up to here every replicate stays within the bound")},
          {"band_to", described(or_null(kNumber), "from here on none does")},
          {"evaluations", kCount},
          {"lost_reason", make_lost_reason()},
          {"monotonic", described({{"type", "boolean"}}, "whether the metric never falls along the way")}};
}

Json with_axes(Json properties) {
  add_parameters_of_row(properties);
  return options_of(std::move(properties));
}

Json make_point() {
  return object_of({{"value", kNumber},
                    {"count", described(kCount, "replicates that have a value")},
                    {"pending", kCount},
                    {"lost", kCount},
                    {"lost_reason", make_lost_reason()},
                    {"quantile", described(or_null(kNumber), "of the metric over the replicates")},
                    {"min", or_null(kNumber)},
                    {"max", or_null(kNumber)},
                    {"within", described(or_null(kCount), "replicates that stay within the bound")},
                    {"part_within_low", described(or_null(kNumber),
                                                  "with part_within_high: which part of all replicates that "
                                                  "there could be does, with 90 % confidence")},
                    {"part_within_high", or_null(kNumber)},
                    {"job_ids", list_of(ref("Id"))}});
}

Json make_full_limit() {
  Json properties = make_limit();
  properties["falls"] = described(
      list_of(object_of({{"from", kNumber}, {"to", kNumber}, {"within_again", {{"type", "boolean"}}}})),
      "where the metric falls: all replicates at the end are below all at the beginning, or the bound holds "
      "again");
  properties["points"] = list_of(ref("SearchPoint"));
  return with_axes(std::move(properties));
}

Json make_limit_row() {
  Json properties{{"parameter", kText}, {"metric", kText}, {"bound", kNumber}, {"quantile", kNumber}};
  properties.update(make_limit());
  return described(with_axes(std::move(properties)),
                   "Every key stands in every row, and those of the axes, unless fields leaves it out");
}

Json make_search_summary() {
  return {{"id", ref("Id")},
          {"name", kText},
          {"state", ref("SearchState")},
          {"error", described(or_null(kText), "why it could not go on")},
          {"sweep_id", ref("Id")},
          {"parameter", kText},
          {"metric", kText},
          {"bound", kNumber},
          {"quantile", kNumber},
          {"axes", list_of(kText)},
          {"created_at", kText},
          {"ended_at", or_null(kText)},
          {"links", texts_of({"self", "results", "cancel", "retry", "events", "sweep"})}};
}

Json make_search() {
  Json properties = make_search_summary();
  properties.update({{"counts", Json{{"$ref", "#/components/schemas/Sweep/properties/counts"}}},
                     {"progress", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
                     {"most_evaluations", described(kCount, "of all combinations together")},
                     {"limits", list_of(ref("Limit"))},
                     {"request", ref("SearchRequest")}});
  return object_of(std::move(properties));
}

}  // namespace

Json make_search_schemas() {
  return {{"SearchState", {{"type", "string"}, {"enum", jobs::kStudyStates}}},
          {"Search", make_search()},
          {"SearchSummary", options_of(make_search_summary())},
          {"SearchPage", object_of({{"items", list_of(ref("SearchSummary"))}, {"next_cursor", kText}})},
          {"SearchPoint", make_point()},
          {"Limit", make_full_limit()},
          {"LimitRow", make_limit_row()},
          {"LimitRows", list_of(ref("LimitRow"))}};
}

}  // namespace server::openapi
