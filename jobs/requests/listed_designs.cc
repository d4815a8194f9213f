// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/listed_designs.h"

#include <set>
#include <string>

#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::vector<Axis> make_axes(const ordered_json& design, Repeats repeats, std::vector<Fault>& faults) {
  std::vector<Axis> axes;
  for (const auto& [path, axis] : design.at("over").items())
    axes.push_back(make_axis(path, axis, pointer_of_axis(path), faults, repeats));
  return axes;
}

/// The centre, one value a path. @param design  its centre has no faults
std::vector<json> centre_of(const ordered_json& design, const json& parameters) {
  const json defaults = fill_in_defaults(parameters);
  const json given = design.value("centre", ordered_json::object());
  std::vector<json> centre;
  for (const auto& [path, axis] : design.at("over").items())
    centre.push_back(given.contains(path) ? given.at(path) : value_at_path(defaults, path));
  return centre;
}

void check_centre(const ordered_json& design, std::vector<Fault>& faults) {
  if (!design.contains("centre")) return;
  if (!design.at("centre").is_object())
    return faults.push_back({"/design/centre", "must be an object with a value for parameters of over"});
  for (const auto& [path, value] : design.at("centre").items()) {
    const std::string pointer = "/design/centre" + pointer_token(path);
    if (!is_known_path(path, pointer, faults)) continue;
    if (!design.at("over").contains(path)) {
      faults.push_back(
          {pointer,
           "is not in over; what all points have in common stands under \"parameters\" of the request"});
      continue;
    }
    for (const Fault& fault : find_path_faults(path, value)) faults.push_back({pointer, fault.detail});
  }
}

/// Text that differs from that of every other point.
std::string identify_point(const std::vector<Axis>& axes, std::size_t k) {
  std::string identity;
  for (const Axis& axis : axes) identity += value_identity(axis.path, axis.values[k]) + ' ';
  return identity;
}

/// Nothing is known of parameters with faults.
bool are_parameters_known(const std::vector<Fault>& faults) {
  return std::ranges::none_of(
      faults, [](const Fault& fault) { return fault.pointer.starts_with("/parameters"); });
}

/// Number of axes that have the centre among their values. Adds the faults of a centre that misses a value.
std::uint64_t count_axes_with_centre(const ordered_json& design, const json& parameters,
                                     std::vector<Fault>& faults) {
  const auto centre = centre_of(design, parameters);
  std::uint64_t count = 0;
  std::size_t next = 0;
  for (const auto& [path, axis] : design.at("over").items()) {
    const json& value = centre[next++];
    if (value.is_null() || (is_path_in_description(path) && !value.is_number())) {
      if (are_parameters_known(faults))
        faults.push_back({"/design/centre", "must have a value for " + path + ": the parameters have none"});
    } else {
      count += axis_contains(path, axis, value) ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

std::uint64_t count_zip(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const std::string& first = design.at("over").begin().key();
  std::uint64_t count = 0;
  for (const auto& [path, axis] : design.at("over").items()) {
    const std::uint64_t values = count_axis_values(path, axis, pointer_of_axis(path), faults);
    if (path == first) count = values;
    if (values == 0 || count == 0 || values == count) continue;
    faults.push_back({pointer_of_axis(path), "has " + std::to_string(values) + " values, and " + first +
                                                 " has " + std::to_string(count) +
                                                 ": a zip needs as many of each"});
  }
  return faults.size() == before ? count : 0;
}

DesignPoints make_zip(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const auto axes = make_axes(design, Repeats::kAllowed, faults);
  DesignPoints points(axes.front().values.size());
  if (faults.size() != before) return points;
  std::set<std::string> seen;
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const Axis& axis : axes) points[k].push_back(axis.values[k]);
    if (!seen.insert(identify_point(axes, k)).second)
      faults.push_back(
          {axes.front().pointers[k], "this value and those beside it are one of the points already"});
  }
  return points;
}

std::uint64_t count_one_at_a_time(const ordered_json& design, const json& parameters,
                                  std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  check_centre(design, faults);
  std::uint64_t count = 1;
  for (const auto& [path, axis] : design.at("over").items())
    count += count_axis_values(path, axis, pointer_of_axis(path), faults);
  if (faults.size() != before) return 0;
  count -= count_axes_with_centre(design, parameters, faults);
  return faults.size() == before ? count : 0;
}

DesignPoints make_one_at_a_time(const ordered_json& design, const json& parameters,
                                std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const auto axes = make_axes(design, Repeats::kRefused, faults);
  const std::vector<json> centre = centre_of(design, parameters);
  DesignPoints points{centre};
  if (faults.size() != before) return points;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (const json& value : axes[i].values) {
      if (value_identity(axes[i].path, value) == value_identity(axes[i].path, centre[i])) continue;
      points.push_back(centre);
      points.back()[i] = value;
    }
  }
  return points;
}

}  // namespace jobs
