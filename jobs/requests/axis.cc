// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/axis.h"

#include <algorithm>
#include <array>
#include <set>

#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/span.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;

/// Bytes; the names of bodies, joints and springs have at most 32
constexpr std::size_t kLongestLinkagePath = 200;

/// Adds the faults of {"from", "to", "count", "scale"}. Returns whether there are none.
bool check_span(const json& axis, const std::string& pointer, std::vector<Fault>& faults) {
  constexpr std::array<std::string_view, 1> kCount{"count"};
  const std::size_t before = faults.size();
  (void)read_span(axis, kCount, pointer, faults);
  std::string detail =
      axis.contains("count") ? describe_integer_fault(kCountRange, axis.at("count")) : "is missing";
  if (detail.empty() && axis.at("count") == 1 && axis.value("from", json()) != axis.value("to", json())) {
    detail = "must be 2 or more, since from and to differ";
  }
  if (!detail.empty()) faults.push_back({pointer + "/count", std::move(detail)});
  return faults.size() == before;
}

/// The values of a span that has no faults, each made when it is asked for.
class SpanValues {
 public:
  explicit SpanValues(const json& span)
      : ends_{.from = span.at("from").get<double>(),
              .to = span.at("to").get<double>(),
              .logarithmic = span.value("scale", "linear") == "log"},
        count_(span.at("count").get<std::uint64_t>()) {}

  [[nodiscard]] std::uint64_t size() const { return count_; }

  [[nodiscard]] double operator[](std::uint64_t k) const {
    if (k == 0) return ends_.from;
    const auto steps = static_cast<double>(count_ - 1);
    return decimal_between(ends_, static_cast<long double>(k) / steps, steps);
  }

  /// They rise or fall, so that a billion of them need not be looked at.
  [[nodiscard]] bool contains(double x) const {
    const bool rises = ends_.from <= ends_.to;
    std::uint64_t first = 0;
    for (std::uint64_t end = count_; first < end;) {
      const std::uint64_t middle = first + (end - first) / 2;
      if (rises ? (*this)[middle] < x : (*this)[middle] > x) first = middle + 1;
      else end = middle;
    }
    return first < count_ && (*this)[first] == x;
  }

 private:
  Span ends_;
  std::uint64_t count_;
};

void add_span_values(const SpanValues& span, const std::string& pointer, Axis& axis) {
  for (std::uint64_t k = 0; k < span.size(); ++k) {
    axis.values.emplace_back(span[k]);
    axis.pointers.push_back(k == 0 ? pointer + "/from" : k + 1 == span.size() ? pointer + "/to" : pointer);
  }
}

void add_list_values(const json& list, const std::string& pointer, Axis& axis) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    axis.values.push_back(list[k]);
    axis.pointers.push_back(pointer + pointer_token(std::to_string(k)));
  }
}

void collect_axis_value_faults(const Axis& axis, bool is_span, Repeats repeats, std::vector<Fault>& faults) {
  std::set<std::string> seen;
  for (std::size_t k = 0; k < axis.values.size(); ++k) {
    const auto value_faults = find_path_faults(axis.path, axis.values[k]);
    const std::string which = is_span ? "value " + axis.values[k].dump() + ": " : "";
    for (const Fault& fault : value_faults) faults.push_back({axis.pointers[k], which + fault.detail});
    if (repeats == Repeats::kRefused && value_faults.empty() &&
        !seen.insert(value_identity(axis.path, axis.values[k])).second) {
      faults.push_back({axis.pointers[k], which + "is in this axis already"});
    }
  }
}

/// Fault of a path that is not known, and so cannot be swept.
std::string describe_path_fault(const std::string& path) {
  if (is_path_in_description(path))
    return "is longer than any place in a description: at most " + std::to_string(kLongestLinkagePath) +
           " bytes";
  if (path == kLinkageKey)
    return "the numbers of a description are swept one by one: \"linkage.bodies.rod.mass_kg\", say; whole "
           "linkages are cases";
  if (path == kKeepKey) return "is the same for all jobs of a sweep; it stands beside \"sweep\"";
  if (path == kWearKey) return "worn bores are cases, each with its lists";
  if (is_varied_by_cases(path))
    return "drives are cases; the numbers of one are swept one by one: \"crank_drive.voltage_v\", say";
  if (path == "links") return "the parts of links are swept one by one: \"links.1,3.mass_kg\", say";
  const std::vector<std::string_view> known(known_paths().begin(), known_paths().end());
  return describe_unknown_key(path, known, "GET /v1/parameters");
}

}  // namespace

bool is_known_path(const std::string& path, const std::string& pointer, std::vector<Fault>& faults) {
  const auto& known = known_paths();
  if (std::find(known.begin(), known.end(), path) != known.end() ||
      (is_path_in_description(path) && path.size() <= kLongestLinkagePath))
    return true;
  faults.push_back({pointer, describe_path_fault(path)});
  return false;
}

bool is_numeric(const std::string& path) {
  const ParameterInfo* info = find_parameter(path);
  return info != nullptr ? info->kind != ParameterKind::kChoice
                         : is_path_in_description(path) || path.ends_with("mass_kg");
}

bool is_integer(const std::string& path) { return find_whole_range(path).has_value(); }

std::string value_identity(const std::string& path, const json& value) {
  const ParameterInfo* info = find_parameter(path);
  if (info != nullptr) return canonical_value(*info, value).dump();
  return value.is_number() ? json(value.get<double>()).dump() : value.dump();
}

std::uint64_t count_axis_values(const std::string& path, const json& axis, const std::string& pointer,
                                std::vector<Fault>& faults) {
  if (!is_known_path(path, pointer, faults)) return 0;
  if (axis.is_array() && !axis.empty()) return axis.size();
  if (axis.is_object() && is_numeric(path))
    return check_span(axis, pointer, faults) ? axis.at("count").get<std::uint64_t>() : 0;
  faults.push_back(
      {pointer, is_numeric(path)
                    ? "must be a list of one value or more, or {\"from\", \"to\", \"count\", \"scale\"}"
                    : "must be a list of one value or more"});
  return 0;
}

std::string pointer_of_axis(std::string_view path) { return "/design/over" + pointer_token(path); }

bool axis_contains(const std::string& path, const json& axis, const json& value) {
  if (axis.is_object()) return SpanValues(axis).contains(value.get<double>());
  return std::ranges::any_of(axis, [&](const json& other) {
    return find_path_faults(path, other).empty() &&
           value_identity(path, other) == value_identity(path, value);
  });
}

Axis make_axis(const std::string& path, const json& axis, const std::string& pointer,
               std::vector<Fault>& faults, Repeats repeats) {
  Axis made{.path = path, .values = {}, .pointers = {}};
  if (axis.is_array()) {
    add_list_values(axis, pointer, made);
  } else {
    add_span_values(SpanValues(axis), pointer, made);
  }
  collect_axis_value_faults(made, axis.is_object(), repeats, faults);
  return made;
}

}  // namespace jobs
