// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/variable.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;

/// Faults of the place of a variable: a parameter has one, over, sweep or parameters; a number of a
/// description stands in one.
void check_place(const std::string& path, const std::string& pointer, const nlohmann::ordered_json& request,
                 const SweepRequest& common, std::vector<Fault>& faults) {
  if (std::ranges::find(common.swept, path) != common.swept.end())
    faults.push_back({pointer, "is an axis of sweep, too"});
  if (request.contains("parameters")) {
    const auto fixed = paths_of(request.at("parameters"));
    if (std::ranges::find(fixed, path) != fixed.end())
      faults.push_back({pointer, "stands in parameters, too"});
  }
  if (!is_path_in_description(path)) return;
  if (std::string fault = describe_description_path_fault(common.parameters, path); !fault.empty())
    faults.push_back({pointer, std::move(fault)});
}

void check_value(const std::string& path, const json& value, const std::string& pointer,
                 std::vector<Fault>& faults) {
  if (!value.is_number()) return faults.push_back({pointer, "must be a number"});
  for (const Fault& found : find_path_faults(path, value)) faults.push_back({pointer, found.detail});
}

}  // namespace

std::optional<Variable> read_variable(const std::string& path, const json& given, const std::string& pointer,
                                      const nlohmann::ordered_json& request, const SweepRequest& common,
                                      std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const auto refuse = [&](const std::string& place, std::string detail) {
    faults.push_back({place, std::move(detail)});
    return std::nullopt;
  };
  if (!is_known_path(path, pointer, faults)) return std::nullopt;
  if (!is_numeric(path)) return refuse(pointer, "must be a parameter whose values are numbers");
  check_place(path, pointer, request, common, faults);
  if (faults.size() > before) return std::nullopt;
  if (!given.is_object()) return refuse(pointer, "must be an object of from, to, scale and start");
  constexpr std::array<std::string_view, 1> kOthers{"start"};
  const auto span = read_span(given, kOthers, pointer, faults);
  if (!span || faults.size() > before) return std::nullopt;
  if (span->from >= span->to) return refuse(pointer + "/to", "must be above from");
  for (const char* const end : {"from", "to", "start"}) {
    if (given.contains(end)) check_value(path, given.at(end), pointer + "/" + end, faults);
  }
  if (faults.size() > before) return std::nullopt;
  Variable variable{.path = path, .span = *span, .integer = is_integer(path)};
  if (given.contains("start")) {
    variable.start = given.at("start").get<double>();
    if (*variable.start < span->from || *variable.start > span->to)
      return refuse(pointer + "/start", "must be between from and to");
  }
  return variable;
}

}  // namespace jobs
