// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/wear_schemas.h"

#include "jobs/parameters/wear_depth.h"
#include "jobs/base/states.h"
#include "jobs/wear/wear_request.h"

namespace server::openapi {

namespace {

Json above_zero(std::string_view description) {
  return described({{"type", "number"}, {"exclusiveMinimum", 0}}, description);
}

Json count_in(const jobs::Range& range, std::size_t otherwise, std::string_view description) {
  return described({{"type", "integer"},
                    {"minimum", static_cast<int>(range.minimum)},
                    {"maximum", static_cast<int>(range.maximum)},
                    {"default", otherwise}},
                   description);
}

Json with_default(Json schema, double value) {
  schema["default"] = value;
  return schema;
}

/// A property of another schema.
Json as_in(std::string_view schema, std::string_view property) {
  return {{"$ref", "#/components/schemas/" + std::string(schema) + "/properties/" + std::string(property)}};
}

Json make_request() {
  const jobs::WearRule rule;
  const jobs::WearQuery query;
  Json coefficient =
      with_default(above_zero("worn volume over normal force and sliding distance"), query.wear_coefficient);
  coefficient["maximum"] = jobs::kWearCoefficientRange.maximum;
  Json step = with_default(above_zero("what a step wears off at most, anywhere, in um"), rule.depth_step_um);
  step["maximum"] = jobs::kDepthStepRange.maximum;
  Json request = options_of(
      {{"name", as_in("SweepRequest", "name")},
       {"parameters", ref("Parameters")},
       {"wear_coefficient_m2_n", std::move(coefficient)},
       {"sectors", count_in(jobs::kBoreSectorsRange, query.sectors, "around the circumference")},
       {"hours", above_zero("how long the linkage runs; this, worn_clearance_mm or both")},
       {"worn_clearance_mm", above_zero("the clearance at the deepest place that ends the study")},
       {"max_depth_step_um", std::move(step)},
       {"max_rate_change", with_default(above_zero("after a step the rate of wear may differ anywhere by "
                                                   "this part of the largest rate before it; "
                                                   "otherwise the step is halved, up to three times"),
                                        rule.rate_change)},
       {"max_cycles", count_in(jobs::kCyclesRange, rule.cycles, "the study ends after so many")},
       {"reuse", as_in("SweepRequest", "reuse")},
       {"priority", as_in("SweepRequest", "priority")}});
  request["description"] =
      "How the bearing is worn by the motion that its own wear changes; hours, worn_clearance_mm or both are "
      "needed";
  request["examples"] =
      Json::array({{{"parameters", {{"duration_s", 0.6}, {"run_up_s", 0.3}}}, {"worn_clearance_mm", 0.252}}});
  return request;
}

Json make_study_summary() {
  return {{"id", ref("Id")},
          {"name", kText},
          {"state", ref("SearchState")},
          {"error", described(or_null(kText), "why it could not go on")},
          {"sweep_id", ref("Id")},
          {"hours", or_null(kNumber)},
          {"worn_clearance_mm", or_null(kNumber)},
          {"created_at", kText},
          {"ended_at", or_null(kText)},
          {"links", texts_of({"self", "results", "cancel", "retry", "events", "sweep"})}};
}

/// jobs::kWearColumns.
Json make_cycle() {
  return {{"cycle", described(kCount, "1: the round bore")},
          {"job_id", ref("Id")},
          {"hours", described(kNumber, "since the bore was round")},
          {"step_hours", described(kNumber, "to the next cycle; 0 if there is none")},
          {"deepest_um", described(kNumber, "the largest depth")},
          {"deepest_position_mm", described(or_null(kNumber), "where that is along the bearing")},
          {"deepest_angle_rad", described(or_null(kNumber), "where that is around it")},
          {"clearance_mm", described(kNumber, "at that place")},
          {"rate_um_h", described(kNumber, "the largest rate of wear")},
          {"rate_change",
           described(or_null(kNumber), "of the rate anywhere since the cycle before, over its largest rate")},
          {"worn_volume_mm3", described(kNumber, "of the whole bore")}};
}

Json make_full_cycle() {
  Json properties = make_cycle();
  properties[std::string(jobs::kWearKey)] =
      described(list_of(list_of(kNumber)), "the bore of the job: for each ring the depth in each sector");
  return object_of(std::move(properties));
}

Json make_cycle_row() {
  return described(
      Json{{"type", "object"}, {"properties", make_cycle()}, {"additionalProperties", or_null(kNumber)}},
      "Every key stands in every row, and so does every metric, unless fields leaves it out");
}

Json make_study() {
  Json properties = make_study_summary();
  properties.update({{"counts", as_in("Sweep", "counts")},
                     {"progress", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
                     {"verdict", described({{"type", "string"}, {"enum", jobs::kWearVerdicts}},
                                           "open: not ended yet; hours_reached; clearance_reached; no_wear: "
                                           "nothing slides; cycle_limit; lost: a job "
                                           "that has failed is in the way")},
                     {"rejected_steps", described(kCount, "that were too long, and were halved")},
                     {"cycles", list_of(ref("WearCycle"))},
                     {"request", ref("WearStudyRequest")}});
  return object_of(std::move(properties));
}

}  // namespace

Json make_wear_schemas() {
  return {{"WearStudyRequest", make_request()},
          {"WearStudy", make_study()},
          {"WearStudySummary", options_of(make_study_summary())},
          {"WearStudyPage", object_of({{"items", list_of(ref("WearStudySummary"))}, {"next_cursor", kText}})},
          {"WearCycle", make_full_cycle()},
          {"WearCycleRow", make_cycle_row()},
          {"WearCycleRows", list_of(ref("WearCycleRow"))}};
}

}  // namespace server::openapi
