// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/expand.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/base/provenance.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"
#include "jobs/requests/plan_budget.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/statistics/splitmix64.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::string_view kStiffnessKey = "contact_stiffness_scale";

/// Position of a point in its sweep.
struct Position {
  std::size_t case_index = 0;
  std::size_t design_point = 0;
  std::vector<std::size_t> values;  ///< one index an axis

  [[nodiscard]] bool is_first_of_case() const {
    return design_point == 0 && std::ranges::all_of(values, [](std::size_t index) { return index == 0; });
  }

  /// Moves on to the next point. False after the last.
  bool advance(const SweepRequest& sweep) {
    for (std::size_t axis = values.size(); axis-- > 0;) {
      if (++values[axis] < sweep.axes[axis].values.size()) return true;
      values[axis] = 0;
    }
    if (++design_point < sweep.design.points.size()) return true;
    design_point = 0;
    return ++case_index < sweep.cases.size();
  }
};

std::uint64_t points_of_a_case(const SweepRequest& sweep) {
  std::uint64_t points = std::max<std::uint64_t>(1, sweep.design.points.size());
  for (const Axis& axis : sweep.axes) points *= axis.values.size();
  return points;
}

json parameters_at(const SweepRequest& sweep, const Position& position) {
  json given = sweep.cases.empty() ? sweep.parameters
                                   : parameters_of_case(sweep.parameters, sweep.cases[position.case_index]);
  for (std::size_t i = 0; i < sweep.design.paths.size(); ++i) {
    set_at_path(given, sweep.design.paths[i], sweep.design.points[position.design_point][i]);
  }
  for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis) {
    set_at_path(given, sweep.axes[axis].path, sweep.axes[axis].values[position.values[axis]]);
  }
  return given;
}

/// Name of a description, of its law or of its actuator.
/// @param name_key  member of a description that names it
std::string find_given_name(const json& described, const char* name_key) {
  if (!described.is_object()) return "";
  return described.value(name_key, described.value("actuator", std::string("described")));
}

/// Short form of a value in one line: of a worn bore the largest depth, of a described linkage its name, of a
/// drive its law or actuator, with a number where another one of the sweep has that name already.
class ShownValues {
 public:
  explicit ShownValues(const SweepRequest& sweep) {
    name_cases(sweep, kLinkageKey, "name", std::string(kRpsupName));
    for (const RpsupDrive& drive : rpsup_drives()) name_cases(sweep, drive.key, "law", json());
  }

  [[nodiscard]] json at(const json& completed, const std::string& path, std::size_t case_index) const {
    if (const auto names = names_.find(path); names != names_.end()) return names->second[case_index];
    const json& value = value_at_path(completed, path);
    return path == kWearKey && !value.is_null() ? json(deepest_wear(value)) : value;
  }

 private:
  /// Names the descriptions under a key that the cases give: numbers inside them may be swept beside them.
  /// @param name_key     see find_given_name()
  /// @param undescribed  value of a case that describes none
  void name_cases(const SweepRequest& sweep, std::string_view key, const char* name_key,
                  const json& undescribed) {
    std::map<json, json> names{{undescribed, undescribed}};
    std::set<json> taken{undescribed};
    std::map<std::string, int> namesakes;
    std::vector<json>& shown_names = names_[std::string(key)];
    for (const json& given : sweep.cases) {
      const json described = given.value(std::string(key), undescribed);
      const std::string name = find_given_name(described, name_key);
      const auto [shown, is_new] = names.try_emplace(described, name);
      while (is_new && !taken.insert(shown->second).second)
        shown->second = name + " #" + std::to_string(2 + namesakes[name]++);
      shown_names.push_back(shown->second);
    }
  }

  std::map<std::string, std::vector<json>, std::less<>> names_;  ///< by key, one a case
};

/// @returns whether a fault at a pointer is that of a path's value, or of the list that the value is in
bool is_fault_of_path(const std::string& path, const std::string& pointer) {
  const std::string own = pointer_of_path(path);
  return own == pointer ||
         (own.starts_with(pointer + "/") &&
          own.find_first_not_of("0123456789", pointer.size() + 1) == std::string::npos);
}

/// The place in a case, beneath it, that gave the parameter of the pointer its value.
std::optional<std::string> find_place_in_case(const json& given, const std::string& pointer) {
  if (given.contains(json::json_pointer(pointer))) return pointer;
  for (const auto& [key, value] : given.items())
    if (is_path_in_description(key) && is_fault_of_path(key, pointer)) return pointer_token(key);
  return std::nullopt;
}

/// Gathers the faults of points: one entry for each place in the request, however many points share it.
class PointFaults {
 public:
  PointFaults(const SweepRequest& sweep, const ShownValues& shown) : sweep_(sweep), shown_(shown) {}

  void add(const Fault& fault, const Position& position, const json& completed) {
    const std::string pointer = pointer_in_request(fault.pointer, position);
    const auto [entry, is_new] = entries_.try_emplace(pointer);
    if (is_new) entry->second.detail = fault.detail + point_text(completed, position);
    ++entry->second.points;
  }

  void throw_if_any() const {
    if (entries_.empty()) return;
    std::vector<Fault> faults;
    for (const auto& [pointer, entry] : entries_) {
      const std::string others =
          entry.points > 1 ? "; likewise at " + std::to_string(entry.points - 1) + " more points" : "";
      faults.push_back({pointer, entry.detail + others});
    }
    throw InvalidRequest(std::move(faults));
  }

 private:
  struct Entry {
    std::string detail;
    std::size_t points = 0;
  };

  /// The place that gave the parameter its value; defaults stand nowhere, so theirs is where they could be
  /// given.
  [[nodiscard]] std::string pointer_in_request(const std::string& pointer, const Position& position) const {
    const std::string path = path_of_pointer(pointer);
    const auto is_it = [&](const std::string& one) { return one == path || is_fault_of_path(one, pointer); };
    if (const auto axis = std::ranges::find_if(sweep_.axes, is_it, &Axis::path); axis != sweep_.axes.end())
      return "/sweep" + pointer_token(axis->path);
    const auto designed = std::ranges::find_if(sweep_.design.paths, is_it);
    if (designed != sweep_.design.paths.end()) return "/design/over" + pointer_token(*designed);
    if (!sweep_.cases.empty()) {
      const auto place = find_place_in_case(sweep_.cases[position.case_index], pointer);
      if (place) return "/cases" + pointer_token(std::to_string(position.case_index)) + *place;
    }
    return "/parameters" + pointer;
  }

  [[nodiscard]] std::string point_text(const json& completed, const Position& position) const {
    std::string text;
    for (const std::string& path : sweep_.swept) {
      text += (text.empty() ? " (at " : ", ") + path + " = " +
              shown_.at(completed, path, position.case_index).dump();
    }
    return text.empty() ? "" : text + ")";
  }

  const SweepRequest& sweep_;
  const ShownValues& shown_;
  std::map<std::string, Entry> entries_;
};

/// Ideal joints cost a small part of what contact does, and rigid links of flexible ones.
std::string kind_of(const json& completed) {
  if (describes_linkage(completed)) return "described";
  std::string kind = completed.at("coupler").get<std::string>();
  for (const char* const link : {"crank", "rod", "cross"})
    if (completed.at(link) == "flexible") kind += std::string(" + ") + link;
  return kind + (completed.at("clearance_mm").get<double>() > 0.0 ? ", clearance" : ", ideal");
}

PlannedJob make_job(const json& completed, std::optional<std::uint64_t> replicate, std::string swept) {
  PlannedJob job;
  job.parameters = canonical_text(completed);
  job.content_id = content_id(job.parameters, engine_version());
  job.kind = kind_of(completed);
  job.replicate = replicate;
  job.swept = std::move(swept);
  return job;
}

/// Number of runs of a point: one, unless the point has one of the values that replicates are for.
std::uint64_t count_replicates(const json& completed, const Replicates& replicates) {
  for (const auto& [path, values] : replicates.only.items())
    if (std::ranges::find(values, value_at_path(completed, path)) == values.end()) return 1;
  return replicates.count;
}

/// A contact stiffness times the factor of a replicate. @throws InvalidRequest if that is out of its range
double perturbed(const json& scale, double factor) {
  const double moved = factor * scale.get<double>();
  if (const std::string detail = describe_fault(*find_parameter(kStiffnessKey), moved); !detail.empty())
    throw InvalidRequest(std::vector<Fault>{
        {"/replicates/perturbation", "moves contact_stiffness_scale out of its range: it " + detail}});
  return moved;
}

/// Gives the k-th replicate the contact stiffness of the point, perturbed, also in the joints of a described
/// linkage that have their own. @throws InvalidRequest if one is out of its range
void perturb(const json& completed, const Replicates& replicates, std::uint64_t k, json& replicate) {
  const double factor = replicate_factor(replicates.seed, k, replicates.perturbation);
  replicate[kStiffnessKey] = perturbed(completed.at(kStiffnessKey), factor);
  if (k == 0 || !describes_linkage(completed)) return;
  for (const auto& [name, joint] : completed[kLinkageKey].at("joints").items())
    if (joint.contains("clearance") && joint["clearance"].contains(kStiffnessKey))
      replicate[kLinkageKey]["joints"][name]["clearance"][kStiffnessKey] =
          perturbed(joint["clearance"][kStiffnessKey], factor);
}

/// Gives a replicate the tolerances of the point times the factor. @throws InvalidRequest if one is too small
void tighten(const json& completed, double factor, json& replicate) {
  for (const char* const key : {"relative_tolerance", "absolute_tolerance"}) {
    replicate[key] = factor * completed.at(key).get<double>();
    if (const std::string detail = describe_fault(*find_parameter(key), replicate[key]); !detail.empty())
      throw InvalidRequest(std::vector<Fault>{
          {"/replicates/tolerance_factor", std::string("moves ") + key + " out of its range: it " + detail}});
  }
}

/// Adds a point's job, or its replicates. Contact stiffness is in no rule with another parameter, so the
/// point's checks hold for them.
/// @param swept  the point's values in all of them, the stiffness too where it is swept: their rows are told
///     apart by `replicate` alone
/// @throws InvalidRequest if there are more than max_jobs with them
void add_jobs(const json& completed, const SweepRequest& sweep, const json& swept, std::size_t max_jobs,
              PlanBudget& budget, SweepPlan& plan) {
  json replicate = completed;
  const std::uint64_t count = count_replicates(completed, sweep.replicates);
  if (count > max_jobs || plan.jobs.size() > max_jobs - count)
    throw InvalidRequest(std::vector<Fault>{
        {"/replicates/count",
         "the sweep would have more than " + std::to_string(max_jobs) + " jobs with its replicates"}});
  for (std::uint64_t k = 0; k < count; ++k) {
    perturb(completed, sweep.replicates, k, replicate);
    if (k == 1) tighten(completed, sweep.replicates.tolerance_factor, replicate);
    plan.jobs.push_back(
        make_job(replicate, sweep.replicates.requested ? std::optional(k) : std::nullopt, swept.dump()));
    budget.add_job(plan.jobs.back().parameters.size() + plan.jobs.back().swept.size());
  }
}

SweepPlan plan_points(const SweepRequest& sweep, std::size_t max_jobs) {
  SweepPlan plan{.name = sweep.name, .swept = sweep.swept, .replicated = sweep.replicates.requested,
                 .reuse = sweep.reuse,
                 .priority = sweep.priority, .executor = sweep.executor, .jobs = {}};
  const ShownValues shown(sweep);
  PointFaults faults(sweep, shown);
  PlanBudget budget(max_jobs);
  Position position{.values = std::vector<std::size_t>(sweep.axes.size(), 0)};
  do {
    const json completed = fill_in_defaults(parameters_at(sweep, position));
    if (position.is_first_of_case())
      budget.take(completed, points_of_a_case(sweep),
                  sweep.replicates.only.empty() ? sweep.replicates.count : 1);
    const auto found = find_combination_faults(completed);
    for (const Fault& fault : found) faults.add(fault, position, completed);
    json swept = json::array();
    for (const std::string& path : plan.swept)
      swept.push_back(shown.at(completed, path, position.case_index));
    if (found.empty()) add_jobs(completed, sweep, swept, max_jobs, budget, plan);
  } while (position.advance(sweep));
  faults.throw_if_any();
  return plan;
}

}  // namespace

double replicate_factor(std::uint64_t seed, std::uint64_t k, double perturbation) {
  if (k == 0) return 1.0;
  const double u = static_cast<double>(splitmix64(seed, k) >> 11U) * 0x1p-52 - 1.0;
  return 1.0 + perturbation * u;
}

SweepPlan plan_sweep(const nlohmann::ordered_json& request, std::size_t max_jobs) {
  const SweepRequest sweep = parse_sweep_request(request, max_jobs);
  SweepPlan plan = plan_points(sweep, max_jobs);
  const bool replicates_some =
      std::ranges::any_of(plan.jobs, [](const PlannedJob& job) { return job.replicate.value_or(0) > 0; });
  if (!sweep.replicates.only.empty() && sweep.replicates.count > 1 && !replicates_some)
    throw InvalidRequest(std::vector<Fault>{
        {"/replicates/only", "must name values that a set of the sweep has; none has all of these"}});
  return plan;
}

std::vector<PlannedJob> plan_cases(nlohmann::ordered_json common, const nlohmann::ordered_json& cases) {
  common["cases"] = cases;
  constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
  return plan_points(parse_sweep_request(common, kNoLimit), kNoLimit).jobs;
}

PlannedJob plan_job(const json& parameters) {
  return make_job(complete_parameters(parameters, ""), std::nullopt, "[]");
}

}  // namespace jobs
