// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/fit_schemas.h"

#include <string>
#include <string_view>
#include <utility>

#include "jobs/fits/fit_request.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameter_path.h"

namespace server::openapi {

namespace {

Json choice_of(std::initializer_list<const char*> values, std::string_view description) {
  return described({{"type", "string"}, {"enum", Json(values)}}, description);
}

Json make_parameters_of_fit() {
  Json parameters = Json::object();
  for (const std::string& path : jobs::known_paths()) {
    if (jobs::is_numeric(path)) parameters[path] = ref("Variable");
  }
  Json over = options_of(std::move(parameters));
  over["patternProperties"] = {{"^(linkage|crank_drive|rod_drive|runs|sensor)\\.", ref("Variable")}};
  over["minProperties"] = 1;
  over["maxProperties"] = jobs::kMostFitParameters;
  return described(
      std::move(over),
      "parameters of jobs; runs.1.PATH: of one run; sensor.CHANNEL.gain, offset or delay_s: of a "
      "sensor");
}

Json make_windows(std::string_view description) {
  Json window = list_of(kNumber);
  window["minItems"] = 2;
  window["maxItems"] = 2;
  return described(list_of(std::move(window)), description);
}

Json make_fitted_channel() {
  Json positive = {{"type", "number"}, {"exclusiveMinimum", 0}};
  return options_of({{"weight", described(positive, "of its residuals")},
                     {"noise", described(positive,
                                         "standard deviation, in the unit of the channel; estimated "
                                         "from more than 50 fitted samples if left out")}});
}

Json make_fitted_measurement() {
  return object_of(
      {{"id", ref("Id")},
       {"runs", described(list_of(kCount), "that are compared; all if left out")},
       {"held_back_runs", described(list_of(kCount), "of those, the ones that are not fitted but predicted")},
       {"channels", described({{"type", "object"}, {"additionalProperties", ref("FittedChannel")}},
                              "that are compared; all that the jobs have, too, if left out")},
       {"fitted", make_windows("from and to, in s of the measurement; from run_up_s on if left out")},
       {"held_back", make_windows("samples that are predicted, not fitted")},
       {"time_shift_s", described(kNumber, "time of the job at the measurement's time 0")}},
      {"runs", "held_back_runs", "channels", "fitted", "held_back", "time_shift_s"});
}

Json make_fit_request() {
  Json measurements = list_of(ref("FittedMeasurement"));
  measurements["minItems"] = 1;
  measurements["maxItems"] = jobs::kMostFittedMeasurements;
  Json request = object_of(
      {{"name", as_in_sweep("name")},
       {"parameters", ref("Parameters")},
       {"over", make_parameters_of_fit()},
       {"measurements", std::move(measurements)},
       {"basis",
        choice_of({"by_divergence", "point_wise", "features"},
                  "what is compared: samples, features of the signals, or whichever suits motions that "
                  "diverge or do not")},
       {"intervals", choice_of({"profile", "linearised"}, "how sure the values are")},
       {"replicates",
        integer_between(jobs::kFitReplicatesRange, "jobs a point and run, in least squares by features")},
       {"samples", integer_between(jobs::kFitSamplesRange,
                                   "most samples that are compared; others are left out evenly")},
       {"budget", integer_between(jobs::kFitBudgetRange, "most points")},
       {"population",
        integer_between(jobs::kFitPopulationRange, "points of a generation of the population search")},
       {"seed", integer_between(jobs::kFitSeedRange, "of the random numbers")},
       {"priority", as_in_sweep("priority")},
       {"executor", as_in_sweep("executor")},
       {"reuse", as_in_sweep("reuse")}},
      {"name", "parameters", "basis", "intervals", "replicates", "samples", "budget", "population", "seed",
       "priority", "executor", "reuse"});
  request["description"] =
      "Values of parameters with which jobs give measured signals. A point has a job for each run of the "
      "measurements";
  return request;
}

Json make_interval() { return or_null(object_of({{"low", or_null(kNumber)}, {"high", or_null(kNumber)}})); }

Json make_fitted_parameter() {
  return object_of(
      {{"path", kText},
       {"value", or_null(kNumber)},
       {"linearised", described(make_interval(),
                                "95 % interval by the derivatives at the best point; an end "
                                "is null if there is none")},
       {"profile", described(make_interval(), "95 % interval by the profile likelihood")},
       {"range",
        described(make_interval(), "of the points about as good as the best, where there is no profile")},
       {"identified", described(or_null({{"type", "boolean"}}), "whether the signals tell its value")},
       {"from", kNumber},
       {"to", kNumber}});
}

Json make_signal_error() {
  return object_of({{"samples", kCount},
                    {"rms", kNumber},
                    {"relative_rms", described(or_null(kNumber),
                                               "over the RMS of the measured samples about their mean; null "
                                               "if they do not vary")},
                    {"measured_peak", kNumber},
                    {"predicted_peak", kNumber}});
}

Json make_fit_signal() {
  return object_of({{"measurement_id", ref("Id")},
                    {"run", kCount},
                    {"channel", kText},
                    {"fitted", or_null(ref("FitSignalError"))},
                    {"held_back", or_null(ref("FitSignalError"))}});
}

Json make_fit_summary() {
  return {{"id", ref("Id")},
          {"name", kText},
          {"state", ref("SearchState")},
          {"error", described(or_null(kText), "why it could not go on")},
          {"sweep_id", ref("Id")},
          {"variables", list_of(kText)},
          {"measurement_ids", list_of(ref("Id"))},
          {"created_at", kText},
          {"ended_at", or_null(kText)},
          {"links", texts_of({"self", "results", "cancel", "retry", "events", "sweep", "signals"})}};
}

Json make_fit() {
  Json properties = make_fit_summary();
  properties.update(
      {{"budget", kCount},
       {"thinning", described(kCount, "one of so many measured samples is compared")},
       {"counts", Json{{"$ref", "#/components/schemas/Sweep/properties/counts"}}},
       {"progress", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
       {"stage", choice_of({"design", "divergence", "scatter", "global", "local", "scan", "profile",
                            "prediction", "ended"},
                           "points that fill the space; points beside good ones; the scatter of features; "
                           "CMA-ES; least squares; parameters over their spans; profile likelihood; runs "
                           "that are held back")},
       {"points", object_of({{"pending", kCount}, {"succeeded", kCount}, {"lost", kCount}})},
       {"basis", or_null(choice_of({"point_wise", "features"}, "what is compared"))},
       {"divergence",
        described(or_null(object_of({{"ratio", or_null(kNumber)}, {"message", kText}})),
                  "of motions from slightly different parameters; null if it was not measured")},
       {"best",
        or_null(object_of(
            {{"point", kCount}, {"sum_of_squares", or_null(kNumber)}, {"job_ids", list_of(ref("Id"))}}))},
       {"parameters", list_of(ref("FittedParameter"))},
       {"correlation", or_null(list_of(list_of(or_null(kNumber))))},
       {"signals", described(list_of(ref("FitSignal")), "errors with the best values")},
       {"local_end", described(or_null(kText), "how the least squares ended")},
       {"remarks", described(list_of(kText), "what the signals do not tell, and what to mind")},
       {"request", ref("FitRequest")}});
  return object_of(std::move(properties));
}

Json make_fit_point_row() {
  Json row = options_of({{"point", kCount},
                         {"stage", kText},
                         {"state", choice_of({"pending", "succeeded", "lost"}, "of its jobs")},
                         {"lost_reason", or_null(kText)},
                         {"sum_of_squares", or_null(kNumber)},
                         {"job_id", or_null(ref("Id"))}});
  row["additionalProperties"] = or_null(kNumber);
  return described(std::move(row), "Beside these, the parameters by their paths");
}

Json make_fit_signal_row() {
  return options_of({{"measurement_id", ref("Id")},
                     {"run", kCount},
                     {"channel", kText},
                     {"use", choice_of({"fitted", "held_back", "unused"}, "of the sample")},
                     {"t_s", described(kNumber, "of the job")},
                     {"measured", kNumber},
                     {"predicted", kNumber},
                     {"residual", described(kNumber, "predicted less measured")}});
}

}  // namespace

Json make_fit_schemas() {
  return {{"FitRequest", make_fit_request()},
          {"FittedMeasurement", make_fitted_measurement()},
          {"FittedChannel", make_fitted_channel()},
          {"Fit", make_fit()},
          {"FittedParameter", make_fitted_parameter()},
          {"FitSignal", make_fit_signal()},
          {"FitSignalError", make_signal_error()},
          {"FitSummary", options_of(make_fit_summary())},
          {"FitPage", object_of({{"items", list_of(ref("FitSummary"))}, {"next_cursor", kText}})},
          {"FitPointRows", list_of(make_fit_point_row())},
          {"FitSignalRows", list_of(make_fit_signal_row())}};
}

}  // namespace server::openapi
