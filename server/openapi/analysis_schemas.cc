// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/analysis_schemas.h"

#include "engine/analysis/quantities.h"
#include "jobs/requests/parameter_path.h"
#include "server/openapi/quantity_schemas.h"

namespace server::openapi {

namespace {

const Json kNumberOrNull{{"type", {"number", "null"}}};

/// Rows that have what is swept beside these.
Json rows_of(Json properties) {
  add_parameters_of_row(properties);
  Json row = options_of(std::move(properties));
  row["patternProperties"][R"(^(linkage|crank_drive|rod_drive)\.)"] =
      described(kNumberOrNull, "a number inside a description, by its path");
  return list_of(std::move(row));
}

void add_morris_columns(Json& properties) {
  for (const char* const key :
       {"effect_mean", "effect_size", "effect_size_low", "effect_size_high", "effect_deviation"}) {
    properties[key] = described(kNumberOrNull,
                                "of a morris design: what the whole range of the parameter changes, in the "
                                "metric's unit; low and high: 95 %");
  }
}

void add_saltelli_columns(Json& properties) {
  for (const char* const key :
       {"first_order", "first_order_low", "first_order_high", "total", "total_low", "total_high"}) {
    properties[key] = described(kNumberOrNull,
                                "of a saltelli design: Sobol index, the fraction of the metric's variance "
                                "that the parameter makes, alone and in total; low and high: 95 %");
  }
}

Json make_sensitivity() {
  Json properties{
      {"metric", kText},
      {"parameter", kText},
      {"blocks", described(kCount, "of the design, those in which every point has a value")},
      {"blocks_missing", kCount},
      {"mean", kNumberOrNull},
      {"deviation", kNumberOrNull},
      {"noise", described(kNumberOrNull, "fraction of the variance that lies between replicates")}};
  add_morris_columns(properties);
  add_saltelli_columns(properties);
  return rows_of(std::move(properties));
}

Json make_flexibility() {
  Json properties{
      {"metric", kText},
      {"ratio", described(kNumberOrNull, "flexible over rigid mean")},
      {"ratio_least", described(kNumberOrNull, "least flexible over largest rigid value")},
      {"ratio_largest", kNumberOrNull},
      {"verdict", {{"enum", {"helps", "harms", "either", "one_run_each", nullptr}}}},
      {"along", described(or_null(kText), "first number that the sweep varies beside the link")},
      {"reverses_from", described(kNumberOrNull,
                                  "last value of `along` before this one with the opposite verdict, all else "
                                  "equal")},
      {"coupler_loss_j", described(kNumberOrNull,
                                   "energy lost in the dampers of flexible links and joints, and in motors, "
                                   "mean of the flexible jobs")},
      {"coupler_loss_part", described(kNumberOrNull, "its fraction of all losses")}};
  for (const std::string coupler : {"rigid", "flexible"}) {
    properties[coupler + "_count"] = kCount;
    for (const char* const part : {"_mean", "_spread", "_min", "_max"})
      properties[coupler + part] = kNumberOrNull;
  }
  return rows_of(std::move(properties));
}

Json make_paper() {
  Json row = object_of(
      {{"statement", kText},
       {"text", kText},
       {"number", described({{"type", {"integer", "null"}}},
                            "1 to 7; null: the same ratio at a velocity of which the paper says nothing")},
       {"paper", described(kNumberOrNull, "the paper's ratio; null: it says that the ratio is below 1")},
       {"found_least", described(kNumberOrNull,
                                 "least of the statement's ratios, of medians over replicates; over several "
                                 "settings their median")},
       {"found_largest", described(kNumberOrNull, "the largest one")},
       {"settings", described(kCount, "of what else the sweep varies, those that have every peak")},
       {"share", described(kNumberOrNull, "fraction of the settings in which the statement holds")},
       {"holds", or_null({{"type", "boolean"}})}});
  row["additionalProperties"] = described(
      kNumberOrNull,
      "index.PARAMETER: first-order sensitivity index of the ratio's logarithm, from 50 settings on");
  return list_of(std::move(row));
}

Json make_bifurcation() {
  Json properties{{"job_id", ref("Id")}};
  properties.update(channel_properties([](const engine::QuantityInfo&) { return kNumberOrNull; }));
  Json rows = rows_of(std::move(properties));
  rows["items"]["additionalProperties"] = kNumberOrNull;  // a flexible coupler has more poses
  return rows;
}

Json make_lyapunov() {
  return rows_of(
      {{"pairs", described(kCount, "of a perturbed run and the one that is not")},
       {"pairs_diverged", described(kCount, "those whose distance grew as far as the motion allows")},
       {"exponent_1_s", described(kNumberOrNull, "mean growth of the distance's logarithm; null if all pairs "
                                                 "had parted within the run-up")},
       {"exponent_low_1_s", described(kNumberOrNull, "lower end of the 95 % interval; above 0: chaotic")},
       {"exponent_high_1_s", described(kNumberOrNull, "upper end of the 95 % interval")},
       {"from_s", described(kNumberOrNull, "with to_s: where it was measured, on the mean")},
       {"to_s", kNumberOrNull}});
}

Json make_surrogate_input() {
  return object_of({{"parameter", kText},
                    {"from", kNumber},
                    {"to", kNumber},
                    {"scale", {{"type", "string"}, {"enum", {"linear", "log"}}}},
                    {"middle", kNumber}});
}

Json make_surrogate_point() {
  return {{"type", "object"},
          {"required", {"value", "left_out_prediction"}},
          {"additionalProperties", kNumberOrNull},
          {"description", "the inputs, the value there, and what is predicted from all other points"}};
}

Json make_surrogate_surface() {
  return object_of(
      {{"where", {{"type", "object"}}},
       {"points", kCount},
       {"degree", or_null(kCount)},
       {"terms", or_null(kCount)},
       {"cross_validation_error",
        described(kNumberOrNull,
                  "root mean square, each point predicted from all others; in the metric's unit")},
       {"predicted_part",
        described(kNumberOrNull, "fraction of the variance that these predictions explain, Q^2")},
       {"x_values", list_of(kNumber)},
       {"y_values", list_of(kNumber)},
       {"values", or_null(list_of(list_of(kNumberOrNull)))},
       {"at", list_of(make_surrogate_point())}});
}

Json make_surrogate() {
  return object_of({{"metric", kText},
                    {"x", kText},
                    {"y", or_null(kText)},
                    {"inputs", list_of(make_surrogate_input())},
                    {"surfaces", list_of(make_surrogate_surface())}});
}

Json make_wear() {
  Json properties{
      {"ring", kCount},
      {"position_mm", kNumber},
      {"angle_rad", kNumber},
      {"sliding_work_j", kNumber},
      {"depth_um", kNumber},
      {"rate_um_h", kNumber},
      {"life_h",
       described(
           kNumberOrNull,
           "until the clearance there is worn_clearance_mm; null without it, or where nothing is worn")}};
  return list_of(object_of(std::move(properties)));
}

Json make_columns() {
  return object_of({{"channels", described(list_of(kText), "the columns in their order")},
                    {"columns", {{"type", "object"}, {"additionalProperties", list_of(kNumberOrNull)}}}});
}

}  // namespace

Json make_analysis_schemas() {
  return {{"SensitivityRows", make_sensitivity()},
          {"Surrogate", make_surrogate()},
          {"FlexibilityRows", make_flexibility()},
          {"PaperRows", make_paper()},
          {"BifurcationRows", make_bifurcation()},
          {"LyapunovRows", make_lyapunov()},
          {"Columns", make_columns()},
          {"WearRows", make_wear()}};
}

}  // namespace server::openapi
