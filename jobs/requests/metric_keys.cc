// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/metric_keys.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::string_view kClearanceEnding = ".clearance.clearance_mm";
constexpr double kAnyClearance_mm = 1e-6;  // the least of a joint: it fits into any bore

/// @param values  a number, a list of them or a range
bool has_positive(const json& values) {
  return values.is_structured() ? std::ranges::any_of(values, has_positive)
                                : values.is_number() && values.get<double>() > 0.0;
}

/// Gives joints of the described linkage that have clearance by one of the values alone the least one: only
/// joints with clearance have metrics of contact.
/// @param values  by their paths
void add_clearances(const json& values, json& parameters) {
  for (const auto& [path, given] : values.items())
    if (is_path_in_description(path) && path.ends_with(kClearanceEnding) && has_positive(given) &&
        !has_positive(value_at_path(parameters, path)) &&
        describe_description_path_fault(parameters, path).empty())
      set_at_path(parameters, path, kAnyClearance_mm);
}

/// Adds the metrics of the jobs with these parameters that are not there already.
void add_keys(const json& request, json parameters, std::vector<std::string>& keys) {
  for (const char* const varied : {"/sweep", "/over", "/design/over"})
    if (const json::json_pointer place(varied); request.contains(place))
      add_clearances(request.at(place), parameters);
  for (const engine::QuantityInfo& metric : metric_table(parameters))
    if (std::ranges::find(keys, metric.key) == keys.end()) keys.push_back(metric.key);
}

}  // namespace

std::vector<std::string> metric_keys_of(const json& request) {
  const json common = request.value("parameters", json::object());
  const json cases = request.value("cases", json::array());
  json shared = common;  // by the cases without a linkage of their own
  bool is_shared = cases.empty();
  std::vector<std::string> keys;
  for (const json& each : cases) {
    const bool has_own = each.contains(kLinkageKey);
    json own = has_own ? whole_parameters_of(common, each) : json();
    add_clearances(each, has_own ? own : shared);
    if (has_own) add_keys(request, std::move(own), keys);
    else is_shared = true;
  }
  if (is_shared) add_keys(request, std::move(shared), keys);
  return keys;
}

std::string describe_metric_fault(const json& metric, const std::vector<std::string>& known) {
  if (!metric.is_string()) return "must be the name of a metric, peak_slider_acceleration_m_s2, say";
  const auto name = metric.get<std::string>();
  if (known.empty() || std::ranges::find(known, name) != known.end()) return "";
  const std::vector<std::string_view> names(known.begin(), known.end());
  return "\"" + name + "\": " + describe_unknown_key(name, names);
}

}  // namespace jobs
