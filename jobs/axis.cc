#include "jobs/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "jobs/parameter_path.h"
#include "jobs/parameter_table.h"
#include "jobs/parameter_value.h"
#include "jobs/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr Range kCountRange{.minimum = 1, .maximum = 1e9};

/// Adds the fault of an axis that is no parameter. Returns whether it is one.
bool is_known_path(const std::string& path, const std::string& pointer, std::vector<Fault>& faults) {
  const auto& known = known_paths();
  if (std::find(known.begin(), known.end(), path) != known.end()) return true;
  if (path == "links") {
    faults.push_back({pointer, "the parts of links are swept one by one: \"links.1,3.mass_kg\", say"});
  } else {
    const std::vector<std::string_view> views(known.begin(), known.end());
    faults.push_back({pointer, describe_unknown_key(path, views)});
  }
  return false;
}

bool is_numeric(const std::string& path) {
  const ParameterInfo* info = find_parameter(path);
  return info != nullptr ? info->kind != ParameterKind::kChoice : path.ends_with("mass_kg");
}

std::string describe_end_fault(const json& axis, const char* end, bool logarithmic) {
  if (!axis.contains(end)) return "is missing";
  Range range;
  if (logarithmic) range = {.minimum = 0.0, .lower = Bound::kExclusive};
  return describe_number_fault(range, "", axis.at(end)).empty() ? "" : logarithmic ? "must be a number above 0" : "must be a number";
}

/// Adds the faults of {"from", "to", "count", "scale"}. Returns whether there are none.
bool check_span(const json& axis, const std::string& pointer, std::vector<Fault>& faults) {
  constexpr std::array<std::string_view, 4> kKeys{"from", "to", "count", "scale"};
  const std::size_t before = faults.size();
  for (const auto& [key, value] : axis.items()) {
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) faults.push_back({pointer + pointer_token(key), describe_unknown_key(key, kKeys)});
  }
  const json scale = axis.value("scale", json("linear"));
  if (scale != "linear" && scale != "log") faults.push_back({pointer + "/scale", "must be \"linear\" or \"log\""});
  for (const char* end : {"from", "to"}) {
    std::string detail = describe_end_fault(axis, end, scale == "log");
    if (!detail.empty()) faults.push_back({pointer + "/" + end, std::move(detail)});
  }
  std::string detail = axis.contains("count") ? describe_integer_fault(kCountRange, axis.at("count")) : "is missing";
  if (detail.empty() && axis.at("count") == 1 && axis.value("from", json()) != axis.value("to", json())) {
    detail = "must be 2 or more, since from and to differ";
  }
  if (!detail.empty()) faults.push_back({pointer + "/count", std::move(detail)});
  return faults.size() == before;
}

double span_value(double from, double to, std::uint64_t k, std::uint64_t last, bool logarithmic) {
  if (k == 0) return from;
  if (k == last) return to;
  const auto a = static_cast<double>(last - k);
  const auto b = static_cast<double>(k);
  const auto n = static_cast<double>(last);
  return logarithmic ? from * std::pow(to / from, b / n) : (from * a + to * b) / n;
}

void add_span_values(const json& span, const std::string& pointer, Axis& axis) {
  const auto count = span.at("count").get<std::uint64_t>();
  const auto from = span.at("from").get<double>();
  const auto to = span.at("to").get<double>();
  const bool logarithmic = span.value("scale", "linear") == "log";
  for (std::uint64_t k = 0; k < count; ++k) {
    axis.values.emplace_back(span_value(from, to, k, count - 1, logarithmic));
    axis.pointers.push_back(k == 0 ? pointer + "/from" : k + 1 == count ? pointer + "/to" : pointer);
  }
}

void add_list_values(const json& list, const std::string& pointer, Axis& axis) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    axis.values.push_back(list[k]);
    axis.pointers.push_back(pointer + pointer_token(std::to_string(k)));
  }
}

void find_axis_value_faults(const Axis& axis, bool is_span, std::vector<Fault>& faults) {
  std::set<std::string> seen;
  for (std::size_t k = 0; k < axis.values.size(); ++k) {
    json alone = json::object();
    set_at_path(alone, axis.path, axis.values[k]);
    const auto value_faults = find_value_faults(alone);
    const std::string which = is_span ? "value " + axis.values[k].dump() + ": " : "";
    for (const Fault& fault : value_faults) faults.push_back({axis.pointers[k], which + fault.detail});
    if (value_faults.empty() && !seen.insert(value_identity(axis.path, axis.values[k])).second) {
      faults.push_back({axis.pointers[k], which + "is in this axis already"});
    }
  }
}

}  // namespace

std::uint64_t count_axis_values(const std::string& path, const json& axis, const std::string& pointer, std::vector<Fault>& faults) {
  if (!is_known_path(path, pointer, faults)) return 0;
  if (axis.is_array() && !axis.empty()) return axis.size();
  if (axis.is_object() && is_numeric(path)) return check_span(axis, pointer, faults) ? axis.at("count").get<std::uint64_t>() : 0;
  faults.push_back({pointer, is_numeric(path) ? "must be a list of one value or more, or {\"from\", \"to\", \"count\", \"scale\"}"
                                              : "must be a list of one value or more"});
  return 0;
}

Axis make_axis(const std::string& path, const json& axis, const std::string& pointer, std::vector<Fault>& faults) {
  Axis made{.path = path, .values = {}, .pointers = {}};
  if (axis.is_array()) {
    add_list_values(axis, pointer, made);
  } else {
    add_span_values(axis, pointer, made);
  }
  find_axis_value_faults(made, axis.is_object(), faults);
  return made;
}

std::string value_identity(const std::string& path, const json& value) {
  const ParameterInfo* info = find_parameter(path);
  if (info != nullptr) return canonical_value(*info, value).dump();
  return value.is_number() ? json(value.get<double>()).dump() : value.dump();
}

}  // namespace jobs
