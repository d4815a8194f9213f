// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/request_schemas.h"

#include "engine/analysis/quantities.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/design_kinds.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameter_schema.h"
#include "jobs/requests/sampled_designs.h"
#include "jobs/requests/sweep_description.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/base/executor_names.h"
#include "jobs/search/search_request.h"

namespace server::openapi {

namespace {

const Json kScale{{"type", "string"}, {"enum", {"linear", "log"}}, {"default", "linear"}};

Json integer_in(const jobs::Range& range) {
  return {{"type", "integer"},
          {"minimum", static_cast<std::int64_t>(range.minimum)},
          {"maximum", static_cast<std::int64_t>(range.maximum)}};
}

Json make_span() {
  Json span = object_of({{"from", {{"type", "number"}}},
                         {"to", {{"type", "number"}}},
                         {"count", integer_in(jobs::kCountRange)},
                         {"scale", kScale}},
                        {"scale"});
  span["description"] = "count values in equal steps, or in equal ratios, both ends included";
  return span;
}

Json make_range() {
  Json range =
      object_of({{"from", {{"type", "number"}}}, {"to", {{"type", "number"}}}, {"scale", kScale}}, {"scale"});
  range["description"] = "what lies between two values; of integers both ends, too";
  return range;
}

/// The keys of a parameter each, and of numbers inside descriptions of a linkage and of drives.
Json by_paths(Json properties, Json of_description) {
  Json schema = options_of(std::move(properties));
  schema["patternProperties"] = {
      {"^(linkage|crank_drive|rod_drive)\\.",
       described(std::move(of_description), "a number inside a description that parameters give")}};
  return schema;
}

/// An object with a key a parameter, each of which has a list of values, or what stands for one.
/// @param instead  the schema that numbers may have in the place of a list, "" for none
Json make_lists(std::string_view instead) {
  Json properties = Json::object();
  const auto list_or_instead = [&](Json list, bool numeric) {
    list["minItems"] = 1;
    if (!numeric || instead.empty()) return list;
    return Json{{"anyOf", Json::array({std::move(list), ref(instead)})}};
  };
  for (const std::string& path : jobs::known_paths())
    properties[path] = list_or_instead(list_of(parameter_ref(path)), jobs::is_numeric(path));
  return by_paths(std::move(properties), list_or_instead(list_of({{"type", "number"}}), true));
}

Json make_values() {
  Json properties = Json::object();
  for (const std::string& path : jobs::known_paths()) properties[path] = parameter_ref(path);
  return by_paths(std::move(properties), {{"type", "number"}});
}

/// Schema of a key of a design.
Json make_design_key(std::string_view key) {
  if (key == "count") return integer_in(jobs::kCountRange);
  if (key == "trajectories") return integer_in(jobs::kBlocksRange);
  if (key == "levels") {
    Json levels = integer_in(jobs::kLevelsRange);
    levels["multipleOf"] = 2;
    levels["default"] = jobs::kDefaultLevels;
    return levels;
  }
  if (key == "seed") return integer_in(jobs::kSeedRange);
  return ref("Values");
}

Json make_design(const jobs::DesignKind& kind) {
  const bool sampled = std::ranges::find(kind.keys, "seed") != kind.keys.end();
  Json over = ref(sampled ? "Ranges" : "Axes");
  Json properties{{"type", {{"const", kind.type}}}, {"over", {{"allOf", {over}}, {"minProperties", 1}}}};
  for (const std::string_view key : kind.keys) properties[std::string(key)] = make_design_key(key);
  Json design = object_of(std::move(properties), {"seed", "centre", "levels"});
  design["title"] = kind.type;
  design["description"] = kind.help;
  return design;
}

Json make_designs() {
  Json designs = Json::array();
  for (const jobs::DesignKind& kind : jobs::design_kinds()) designs.push_back(make_design(kind));
  return {{"oneOf", std::move(designs)}};
}

Json make_replicates() {
  const jobs::Replicates defaults;
  Json seed = integer_in(jobs::kSeedRange);
  seed["default"] = defaults.seed;
  const jobs::Range& perturbation = jobs::kPerturbationRange;
  Json replicates = object_of(
      {{"count", integer_in(jobs::kCountRange)},
       {"perturbation",
        {{"type", "number"},
         {"exclusiveMinimum", perturbation.minimum},
         {"maximum", perturbation.maximum},
         {"default", defaults.perturbation}}},
       {"seed", std::move(seed)},
       {"tolerance_factor",
        described({{"type", "number"},
                   {"exclusiveMinimum", jobs::kToleranceFactorRange.minimum},
                   {"maximum", jobs::kToleranceFactorRange.maximum},
                   {"default", defaults.tolerance_factor}},
                  "factor of both tolerances in all replicates but the first")},
       {"only",
        described({{"allOf", Json::array({ref("Lists")})}},
                  "lists of values by parameter: sets without one of them are run once")}},
      {"perturbation", "seed", "only", "tolerance_factor"});
  replicates["description"] =
      "count runs of each set: run 0 is unperturbed, every other one has its contact stiffness changed by a "
      "random fraction of perturbation, up or down";
  return replicates;
}

Json make_case() {
  Json properties = Json::object();
  const Json parameters = jobs::parameter_schema();
  for (const auto& [key, schema] : parameters.at("properties").items())
    properties[key] = openapi::ref("Parameters/properties/" + key);  // not std::ref
  return by_paths(std::move(properties), {{"type", "number"}});
}

Json make_cases() {
  Json cases = list_of(ref("Case"));
  cases["minItems"] = 1;
  cases["description"] = "sets listed one by one";
  return cases;
}

Json make_priority() {
  Json priority = integer_in(jobs::kPriorityRange);
  priority["default"] = jobs::SweepRequest{}.priority;
  priority["description"] = "sweeps of a higher one go first, those of the same take turns";
  return priority;
}

Json make_executor() {
  return {{"type", "string"},
          {"enum", jobs::kExecutorNames},
          {"description", "who computes it; whichever the service has chosen if left out"}};
}

Json make_move() { return object_of({{"executor", make_executor()}}); }

Json make_sweep_description() {
  Json tags = list_of({{"type", "string"}, {"minLength", 1}, {"maxLength", jobs::kLongestTag}});
  tags["maxItems"] = jobs::kMostTags;
  Json changes = options_of({{"name", {{"type", "string"}, {"maxLength", jobs::kLongestName}}},
                             {"notes", {{"type", "string"}, {"maxLength", jobs::kLongestNotes}}},
                             {"tags", std::move(tags)}});
  changes["minProperties"] = 1;
  changes["examples"] = Json::array({{{"notes", "bearing B, dry"}, {"tags", {"rig 2", "dry"}}}});
  return changes;
}

Json make_extension() {
  Json extension = options_of({{"sweep", ref("Axes")}, {"cases", make_cases()}});
  extension["minProperties"] = 1;
  extension["description"] = "More values for axes that the sweep has, more cases of a sweep that has cases";
  extension["examples"] = Json::array({{{"sweep", {{"clearance_mm", {0.3}}}}}});
  return extension;
}

Json make_sweep_request() {
  Json request =
      options_of({{"name", {{"type", "string"}, {"maxLength", jobs::kLongestName}}},
                  {"parameters", ref("Parameters")},
                  {"sweep", ref("Axes")},
                  {"design", ref("Design")},
                  {"cases", make_cases()},
                  {"replicates", make_replicates()},
                  {"priority", make_priority()},
                  {"executor", make_executor()},
                  {"keep",
                   {{"type", "string"},
                    {"enum", jobs::kKeepWords},
                    {"default", jobs::kKeepAll},
                    {"description", "The parameter keep of all jobs. metrics: no trajectories are stored"}}},
                  {"reuse",
                   {{"type", "boolean"},
                    {"default", true},
                    {"description", "whether what was computed before is taken from the store"}}}});
  request["description"] =
      "A job for every combination of the cases, the points of the design, the values of the axes and the "
      "replicates";
  request["examples"] =
      Json::array({{{"name", "first look"},
                    {"parameters", {{"duration_s", 0.6}, {"run_up_s", 0.3}}},
                    {"sweep", {{"clearance_mm", {0, 0.25}}, {"coupler", {"rigid", "flexible"}}}}}});
  return request;
}

/// Schema of the path along which a search looks for a limit.
Json make_search_path() {
  Json first = integer_in(jobs::kFirstRange);
  first["default"] = jobs::kDefaultFirst;
  first["description"] = "how many values are tried before the first crossing is looked at closely";
  Json path = object_of(
      {{"from", {{"type", "number"}}},
       {"to", {{"type", "number"}}},
       {"scale", kScale},
       {"tolerance",
        {{"type", "number"},
         {"exclusiveMinimum", jobs::kToleranceRange.minimum},
         {"description",
          "how exact the limit has to be, in the parameter's unit; if left out a hundredth of the way, with "
          "the scale log the hundredth root of its ratio"}}},
       {"first", std::move(first)}},
      {"scale", "tolerance", "first"});
  path["description"] =
      "from the value where the metric is expected within its bound to the farthest one of interest, which "
      "may be the smaller one";
  return path;
}

Json make_search_request() {
  Json paths = Json::object();
  Json metrics = Json::array();
  for (const std::string& path : jobs::known_paths()) {
    if (jobs::is_numeric(path)) paths[path] = ref("SearchPath");
  }
  for (const engine::QuantityInfo& metric : engine::metric_table()) metrics.push_back(metric.key);
  Json over = options_of(std::move(paths));
  over["patternProperties"] = {{"^(linkage|crank_drive|rod_drive)\\.", ref("SearchPath")}};
  over["minProperties"] = over["maxProperties"] = 1;
  const Json all = make_sweep_request().at("properties");
  Json request =
      object_of({{"name", all.at("name")},
                 {"parameters", all.at("parameters")},
                 {"over", std::move(over)},
                 {"metric",
                  {{"type", "string"},
                   {"description", "of the linkage; the examples are those of RPSUP"},
                   {"examples", std::move(metrics)}}},
                 {"bound", {{"type", "number"}, {"description", "in the unit of the metric"}}},
                 {"quantile",
                  {{"type", "number"},
                   {"exclusiveMinimum", jobs::kQuantileRange.minimum},
                   {"maximum", jobs::kQuantileRange.maximum},
                   {"default", jobs::LimitRule{}.quantile},
                   {"description", "smallest fraction of the replicates that must not be above the bound"}}},
                 {"sweep", all.at("sweep")},
                 {"replicates", all.at("replicates")},
                 {"priority", all.at("priority")},
                 {"reuse", all.at("reuse")}},
                {"name", "parameters", "quantile", "sweep", "replicates", "priority", "reuse"});
  request["description"] =
      "How far a parameter may go, for each combination of the axes, until a metric exceeds its bound";
  request["examples"] =
      Json::array({{{"parameters", {{"duration_s", 0.6}, {"run_up_s", 0.3}}},
                    {"over", {{"clearance_mm", {{"from", 0.05}, {"to", 0.5}, {"tolerance", 0.01}}}}},
                    {"metric", "peak_slider_acceleration_m_s2"},
                    {"bound", 100}}});
  return request;
}

}  // namespace

Json make_request_schemas() {
  Json parameters = jobs::parameter_schema();
  parameters.erase("$schema");
  return {{"Parameters", std::move(parameters)},
          {"Case", make_case()},
          {"SweepRequest", make_sweep_request()},
          {"Extension", make_extension()},
          {"Move", make_move()},
          {"SweepDescription", make_sweep_description()},
          {"AssemblyRequest", object_of({{"parameters", ref("Parameters")}})},
          {"Axes", make_lists("Span")},
          {"Lists", make_lists("")},
          {"Span", make_span()},
          {"Design", make_designs()},
          {"Ranges", make_lists("Range")},
          {"Range", make_range()},
          {"Values", make_values()},
          {"SearchRequest", make_search_request()},
          {"SearchPath", make_search_path()}};
}

}  // namespace server::openapi
