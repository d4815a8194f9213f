// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/extend_request.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Makes the union of two requests; a member function a part of it.
class Union {
 public:
  Union(const ordered_json& former, const ordered_json& addition, std::size_t max_jobs)
      : former_(former), addition_(addition), max_jobs_(max_jobs), request_(former) {}

  ordered_json make() {
    check_shape();
    if (faults_.empty()) add_values();
    if (!faults_.empty()) throw InvalidRequest(std::move(faults_));
    return std::move(request_);
  }

  /// The faults of the union where they stand in the addition.
  [[nodiscard]] std::vector<Fault> in_addition(std::vector<Fault> faults) const {
    const std::size_t before = former_.contains("cases") ? former_.at("cases").size() : 0;
    for (Fault& fault : faults) {
      for (std::size_t k = 0; k < added_cases_.size(); ++k) {
        const std::string in_union = "/cases/" + std::to_string(before + k);
        if (fault.pointer != in_union && !fault.pointer.starts_with(in_union + "/")) continue;
        fault.pointer = "/cases/" + std::to_string(added_cases_[k]) + fault.pointer.substr(in_union.size());
        break;
      }
    }
    return faults;
  }

 private:
  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  void check_shape() {
    constexpr std::array<std::string_view, 2> kKeys{"sweep", "cases"};
    if (!addition_.is_object() || addition_.empty())
      return fault("", "must be an object with \"sweep\", \"cases\" or both");
    for (const auto& [key, value] : addition_.items()) {
      if (std::ranges::find(kKeys, key) == kKeys.end())
        fault(pointer_token(key), describe_unknown_key(key, kKeys));
    }
    if (addition_.contains("sweep") && !addition_.at("sweep").is_object())
      fault("/sweep", "must be an object of axes");
    if (!addition_.contains("cases")) return;
    const ordered_json& cases = addition_.at("cases");
    if (!cases.is_array() || cases.empty()) fault("/cases", "must be a list of one parameter object or more");
  }

  void add_values() {
    if (addition_.contains("sweep")) add_axis_values();
    if (addition_.contains("cases")) add_cases();
  }

  void add_axis_values() {
    for (const auto& [path, values] : addition_.at("sweep").items()) {
      const std::string pointer = "/sweep" + pointer_token(path);
      if (!former_.contains("sweep") || !former_.at("sweep").contains(path)) {
        fault(pointer, "is no axis of this sweep, and an extension does not add one; " + axes_text());
        continue;
      }
      const std::size_t before = faults_.size();
      const std::uint64_t count = count_axis_values(path, values, pointer, faults_);
      if (count > max_jobs_)
        fault(pointer, "has " + std::to_string(count) + " values; at most " + std::to_string(max_jobs_) +
                           " jobs are allowed");
      if (faults_.size() == before) add_to_axis(path, make_axis(path, values, pointer, faults_));
    }
  }

  /// An axis that is given as a range becomes a list, if there is something to add.
  void add_to_axis(const std::string& path, const Axis& added) {
    std::vector<Fault> none;
    Axis axis = make_axis(path, former_.at("sweep").at(path), "", none);
    std::set<std::string> known;
    for (const json& value : axis.values) known.insert(value_identity(path, value));
    const std::size_t before = axis.values.size();
    if (!faults_.empty()) return;
    for (const json& value : added.values) {
      if (!known.contains(value_identity(path, value))) axis.values.push_back(value);
    }
    if (axis.values.size() > before) request_["sweep"][path] = axis.values;
  }

  [[nodiscard]] std::string axes_text() const {
    std::string text;
    if (former_.contains("sweep")) {
      for (const auto& [path, values] : former_.at("sweep").items())
        text += (text.empty() ? "it has " : ", ") + path;
    }
    return text.empty() ? "it has none" : text;
  }

  void add_cases() {
    const auto& added = addition_.at("cases");
    if (added.size() > max_jobs_)
      return fault("/cases", "has " + std::to_string(added.size()) + " cases; at most " +
                                 std::to_string(max_jobs_) + " jobs are allowed");
    if (!former_.contains("cases"))
      return fault("/cases",
                   "this sweep has no cases, and an extension does not change what is swept; " + axes_text());
    std::set<std::string> swept;
    for (const auto& given : former_.at("cases")) {
      for (const std::string& path : paths_of(given)) swept.insert(path);
      known_cases_.insert(given);
    }
    for (std::size_t i = 0; i < added.size(); ++i) add_case(added[i], i, swept);
  }

  /// The parameters of a case that are whole: the union judges numbers inside a description.
  [[nodiscard]] static json without_description_numbers(const ordered_json& given) {
    json whole = given;
    if (!given.is_object()) return whole;
    for (const auto& [path, value] : given.items())
      if (is_path_in_description(path)) whole.erase(path);
    return whole;
  }

  void add_case(const ordered_json& given, std::size_t index, const std::set<std::string>& swept) {
    const std::string pointer = "/cases/" + std::to_string(index);
    const auto value_faults = find_value_faults(without_description_numbers(given),
                                                former_.value("parameters", ordered_json::object()));
    for (const Fault& found : value_faults) fault(pointer + found.pointer, found.detail);
    if (!value_faults.empty()) return;
    for (const std::string& path : paths_of(given)) {
      if (!swept.contains(path))
        fault(pointer + (is_path_in_description(path) ? pointer_token(path) : pointer_of_path(path)),
              "no case of this sweep has it, and an extension does not change what is swept");
    }
    if (!known_cases_.insert(given).second) return;
    request_["cases"].push_back(given);
    added_cases_.push_back(index);
  }

  const ordered_json& former_;
  const ordered_json& addition_;
  std::size_t max_jobs_;
  ordered_json request_;
  std::set<json> known_cases_;            ///< of the union
  std::vector<std::size_t> added_cases_;  ///< for each case at the end of the union its index in the addition
  std::vector<Fault> faults_;
};

/// Identity of a job within its sweep.
using JobName = std::pair<std::string, std::optional<std::uint64_t>>;

JobName name_of(const PlannedJob& job) { return {job.content_id, job.replicate}; }

/// Takes the jobs of one plan out of those of another that has them all.
std::vector<PlannedJob> without(std::vector<PlannedJob> jobs, const std::vector<PlannedJob>& known) {
  std::map<JobName, std::size_t> left;
  for (const PlannedJob& job : known) ++left[name_of(job)];
  std::size_t missing = known.size();
  std::erase_if(jobs, [&](const PlannedJob& job) {
    const auto found = left.find(name_of(job));
    if (found == left.end() || found->second == 0) return false;
    --found->second;
    --missing;
    return true;
  });
  if (missing > 0) {
    throw InvalidRequest(std::vector<Fault>{{"",
                                             "this extension would change jobs that the sweep already has; "
                                             "only values of existing axes, and new cases, "
                                             "can be added. Submit a new sweep instead"}});
  }
  return jobs;
}

}  // namespace

Extension plan_extension(const ordered_json& former, const ordered_json& addition, std::size_t max_jobs) {
  Union both(former, addition, max_jobs);
  ordered_json request = both.make();
  if (request == former) return {.request = std::move(request), .jobs = {}};
  try {
    SweepPlan plan = plan_sweep(request, max_jobs);
    auto jobs =
        without(std::move(plan.jobs), plan_sweep(former, std::numeric_limits<std::size_t>::max()).jobs);
    return {.request = std::move(request), .jobs = std::move(jobs)};
  } catch (const InvalidRequest& invalid) {
    throw InvalidRequest(both.in_addition(invalid.faults()));
  }
}

}  // namespace jobs
