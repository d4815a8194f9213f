// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/sweep_request.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "jobs/base/executor_names.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/parameters/link_parameters.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// @returns whether a pointer into parameters leads to one number or word. (Moments of inertia are three.)
bool takes_one_value(const std::string& pointer) {
  static const std::set<std::string> pointers = [] {
    std::set<std::string> found;
    for (const std::string& path : known_paths())
      if (!path.ends_with(kInertiaKey)) found.insert(pointer_of_path(path));
    return found;
  }();
  return pointers.contains(pointer);
}

constexpr const char* kExecutorFault = "must be \"local\" or \"slurm\"";

bool is_executor(const json& name) {
  return name.is_string() &&
         std::ranges::find(kExecutorNames, name.get_ref<const std::string&>()) != kExecutorNames.end();
}

/// Reads one request; a member function a part of it.
class SweepParser {
 public:
  SweepParser(const ordered_json& request, std::size_t max_jobs) : request_(request), max_jobs_(max_jobs) {}

  SweepRequest parse() {
    if (!request_.is_object()) throw InvalidRequest(std::vector<Fault>{{"", "must be an object"}});
    check_keys();
    read_name();
    read_reuse();
    read_priority();
    read_executor();
    read_replicates();
    find_first_values();
    read_parameters();
    check_cases_shape();
    check_size();
    read_cases();
    read_design();
    read_axes();
    check_places();
    check_linkage_paths();
    if (!faults_.empty()) throw InvalidRequest(std::move(faults_));
    return std::move(sweep_);
  }

 private:
  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  void check_keys() {
    for (const auto& [key, value] : request_.items()) {
      if (std::ranges::find(kSweepRequestKeys, key) != kSweepRequestKeys.end()) continue;
      const bool is_parameter =
          is_varied_by_cases(key) || std::ranges::find(known_paths(), key) != known_paths().end();
      fault(pointer_token(key), is_parameter ? "unknown key; parameters stand under \"parameters\""
                                             : describe_unknown_key(key, kSweepRequestKeys));
    }
  }

  void read_name() {
    if (!request_.contains("name")) return;
    const ordered_json& name = request_.at("name");
    if (!name.is_string() || name.get_ref<const std::string&>().size() > kLongestName) {
      fault("/name", "must be a string of at most " + std::to_string(kLongestName) + " bytes");
    } else {
      sweep_.name = name.get<std::string>();
    }
  }

  void read_reuse() {
    if (!request_.contains("reuse")) return;
    if (!request_.at("reuse").is_boolean()) return fault("/reuse", "must be true or false");
    sweep_.reuse = request_.at("reuse").get<bool>();
  }

  void read_priority() {
    if (!request_.contains("priority")) return;
    const json priority = request_.at("priority");
    const std::string detail = describe_integer_fault(kPriorityRange, priority);
    if (!detail.empty()) return fault("/priority", detail);
    sweep_.priority = priority.get<std::int64_t>();
  }

  void read_executor() {
    if (!request_.contains("executor")) return;
    if (!is_executor(request_.at("executor"))) return fault("/executor", kExecutorFault);
    sweep_.executor = request_.at("executor").get<std::string>();
  }

  void read_replicates() {
    if (!request_.contains("replicates")) return;
    const json replicates = request_.at("replicates");
    if (!replicates.is_object())
      return fault("/replicates",
                   "must be an object of count, perturbation, seed, only and tolerance_factor");
    const std::size_t before = faults_.size();
    for (const auto& [key, value] : replicates.items()) {
      const std::string detail = check_replicates_member(key, value);
      if (!detail.empty()) fault("/replicates" + pointer_token(key), detail);
    }
    if (!replicates.contains("count")) fault("/replicates/count", "is missing");
    if (faults_.size() == before) sweep_.replicates = replicates_of(replicates);
  }

  /// @returns the fault of a member of "replicates"; empty if it has none
  std::string check_replicates_member(const std::string& key, const json& value) {
    constexpr std::array<std::string_view, 5> kKeys{"count", "perturbation", "seed", "only",
                                                    "tolerance_factor"};
    if (key == "count") return describe_integer_fault(kCountRange, value);
    if (key == "perturbation") return describe_number_fault(kPerturbationRange, "", value);
    if (key == "seed") return describe_integer_fault(kSeedRange, value);
    if (key == "only") return check_replicated_values(value);
    if (key == "tolerance_factor") return describe_number_fault(kToleranceFactorRange, "", value);
    return describe_unknown_key(key, kKeys);
  }

  /// @param given  has no faults
  [[nodiscard]] static Replicates replicates_of(const json& given) {
    return {.requested = true,
            .count = given.at("count").get<std::uint64_t>(),
            .only = given.value("only", json::object()),
            .perturbation = given.value("perturbation", Replicates{}.perturbation),
            .seed = given.value("seed", Replicates{}.seed),
            .tolerance_factor = given.value("tolerance_factor", Replicates{}.tolerance_factor)};
  }

  /// The lists of values of which points are replicated. @returns a fault of their object
  std::string check_replicated_values(const json& only) {
    if (!only.is_object()) return "must be an object of lists of values, by the names of parameters";
    for (const auto& [path, values] : only.items()) check_replicated_list(path, values);
    return "";
  }

  void check_replicated_list(const std::string& path, const json& values) {
    const std::string pointer = "/replicates/only" + pointer_token(path);
    if (is_varied_by_cases(path) || path == "links")
      return fault(pointer,
                   "must name a parameter with one value: not a drive, a linkage, links or a worn bore");
    if (!is_known_path(path, pointer, faults_)) return;
    if (!values.is_array() || values.empty()) return fault(pointer, "must be a list of one value or more");
    for (std::size_t i = 0; i < values.size(); ++i)
      for (const Fault& each : find_path_faults(path, values[i]))
        fault(pointer + pointer_token(std::to_string(i)), each.detail);
  }

  /// Finds the first values of the job's parameters that the sweep varies, but for those with faults.
  void find_first_values() {
    const auto take = [this](const std::string& key, const json& value) {
      if (find_parameter(key) != nullptr && find_path_faults(key, value).empty()) one_job_[key] = value;
    };
    const auto take_first = [&](const ordered_json& varied) {
      if (!varied.is_object()) return;
      for (const auto& [key, values] : varied.items()) {
        if (values.is_array() && !values.empty()) take(key, values[0]);
        else if (values.is_object() && values.contains("from")) take(key, values.at("from"));
      }
    };
    take_first(request_.value("sweep", ordered_json()));
    const ordered_json design = request_.value("design", ordered_json());
    if (design.is_object()) take_first(design.value("over", ordered_json()));
    const ordered_json cases = request_.value("cases", ordered_json());
    if (!cases.is_array() || cases.empty() || !cases[0].is_object()) return;
    for (const auto& [key, value] : cases[0].items()) take(key, value);
  }

  void read_parameters() {
    if (request_.contains("parameters")) sweep_.parameters = request_.at("parameters");
    // The steps below rely on parameters without faults.
    if (!check_values(sweep_.parameters, "/parameters")) sweep_.parameters = json::object();
    one_job_.update(sweep_.parameters);
    if (!request_.contains(kKeepKey)) return;
    const json keep = request_.at(kKeepKey);
    if (std::string detail = describe_keep_fault(keep); !detail.empty())
      return fault(pointer_token(kKeepKey), std::move(detail));
    if (sweep_.parameters.contains(kKeepKey) && sweep_.parameters.at(kKeepKey) != keep)
      return fault(pointer_token(kKeepKey), "differs from /parameters/keep");
    sweep_.parameters[kKeepKey] = keep;
  }

  /// Faults of the parameters at a pointer, which stand beside those of all points. The fault of a parameter
  /// with several values tells where those stand.
  /// @returns true if there are none
  bool check_values(const json& given, const std::string& pointer) {
    const std::vector<Fault> found = find_value_faults(given, one_job_);
    for (const Fault& each : found) {
      const bool several =
          takes_one_value(each.pointer) && given.at(json::json_pointer(each.pointer)).is_structured();
      fault(pointer + each.pointer, each.detail + (several ? "; several values stand under \"sweep\"" : ""));
    }
    return found.empty();
  }

  void check_cases_shape() {
    if (!request_.contains("cases")) return;
    const ordered_json& cases = request_.at("cases");
    if (!cases.is_array() || cases.empty())
      return fault("/cases", "must be a list of one parameter object or more");
    case_count_ = cases.size();
  }

  /// Counts the jobs, and the points of the design; adds the faults of axes and design. "sweep" is an object.
  /// None if the jobs are too large a number.
  std::optional<std::uint64_t> count_jobs() {
    std::uint64_t jobs = case_count_;
    // Replicates of some sets only are counted as they are made.
    bool overflow =
        sweep_.replicates.only.empty() && __builtin_mul_overflow(jobs, sweep_.replicates.count, &jobs);
    if (request_.contains("sweep"))
      for (const auto& [path, axis] : request_.at("sweep").items()) {
        const std::uint64_t values = count_axis_values(path, axis, "/sweep" + pointer_token(path), faults_);
        overflow |= values > 0 && __builtin_mul_overflow(jobs, values, &jobs);
      }
    if (request_.contains("design")) {
      design_points_ = count_design_points(request_.at("design"), sweep_.parameters, faults_);
      overflow |= design_points_ > 0 && __builtin_mul_overflow(jobs, design_points_, &jobs);
    }
    return overflow ? std::nullopt : std::optional(jobs);
  }

  /// Ends here if the jobs would be too many.
  void check_size() {
    if (request_.contains("sweep") && !request_.at("sweep").is_object())
      return fault("/sweep", "must be an object of axes");
    const std::optional<std::uint64_t> jobs = count_jobs();
    if (jobs && *jobs <= max_jobs_) return;
    const std::string size =
        jobs ? std::to_string(*jobs)
             : "more than " + std::to_string(std::numeric_limits<std::uint64_t>::max());
    const char* const pointer = request_.contains("sweep")    ? "/sweep"
                                : request_.contains("design") ? "/design"
                                : request_.contains("cases")  ? "/cases"
                                                              : "/replicates/count";
    fault(pointer,
          "the sweep would have " + size + " jobs; at most " + std::to_string(max_jobs_) + " are allowed");
    throw InvalidRequest(std::move(faults_));
  }

  void read_cases() {
    if (!request_.contains("cases") || !request_.at("cases").is_array()) return;
    std::set<std::string> seen;
    for (std::size_t i = 0; i < request_.at("cases").size(); ++i) {
      json given = request_.at("cases")[i];
      const std::string pointer = "/cases" + pointer_token(std::to_string(i));
      check_case(given, pointer);
      if (!seen.insert(given.dump()).second) fault(pointer, "is in the list already");
      sweep_.cases.push_back(std::move(given));
    }
  }

  /// Faults of a case, which may have numbers inside a description beside whole parameters.
  void check_case(const json& given, const std::string& pointer) {
    json whole = given;
    if (given.is_object()) {
      for (const auto& [path, value] : given.items()) {
        if (!is_path_in_description(path)) continue;
        whole.erase(path);
        const std::string place = pointer + pointer_token(path);
        if (is_known_path(path, place, faults_) && !value.is_number()) fault(place, "must be a number");
      }
    }
    check_values(whole, pointer);
  }

  void read_design() {
    if (design_points_ == 0) return;
    sweep_.design = make_design(request_.at("design"), sweep_.parameters, faults_);
    sweep_.swept = sweep_.design.paths;
  }

  void read_axes() {
    if (!request_.contains("sweep") || !request_.at("sweep").is_object()) return;
    for (const auto& [path, axis] : request_.at("sweep").items()) {
      const std::string pointer = "/sweep" + pointer_token(path);
      std::vector<Fault> known;  // those that counting has reported already
      if (count_axis_values(path, axis, pointer, known) == 0) continue;
      sweep_.axes.push_back(make_axis(path, axis, pointer, faults_));
      sweep_.swept.push_back(path);
    }
  }

  /// Every value has one place: parameters, the design, an axis, or the cases.
  void check_places() {
    std::set<std::string> fixed;
    for (const std::string& path : paths_of(request_.value("parameters", ordered_json::object())))
      fixed.insert(path);
    const std::set<std::string> design(sweep_.design.paths.begin(), sweep_.design.paths.end());
    for (const std::string& path : design) {
      if (fixed.contains(path)) fault("/design/over" + pointer_token(path), "stands in parameters, too");
    }
    std::set<std::string> axes;
    for (const Axis& axis : sweep_.axes) {
      axes.insert(axis.path);
      if (fixed.contains(axis.path)) fault("/sweep" + pointer_token(axis.path), "stands in parameters, too");
      if (design.contains(axis.path)) fault("/sweep" + pointer_token(axis.path), "stands in the design, too");
    }
    check_places_of_cases(fixed, axes, design);
  }

  void check_places_of_cases(const std::set<std::string>& fixed, const std::set<std::string>& axes,
                             const std::set<std::string>& design) {
    for (std::size_t i = 0; i < sweep_.cases.size(); ++i) {
      for (const std::string& path : paths_of(request_.at("cases")[i])) {
        const std::string place = is_path_in_description(path) ? pointer_token(path) : pointer_of_path(path);
        const std::string pointer = "/cases" + pointer_token(std::to_string(i)) + place;
        if (fixed.contains(path)) fault(pointer, "stands in parameters, too");
        if (axes.contains(path)) fault(pointer, "is an axis of sweep, too");
        if (design.contains(path)) fault(pointer, "stands in the design, too");
        if (std::ranges::find(sweep_.swept, path) == sweep_.swept.end()) sweep_.swept.push_back(path);
      }
    }
  }

  /// @returns whether there is a description that has the path. A missing one is a fault.
  bool has_number_at(const std::string& path, const json& given, const std::string& pointer) {
    const std::string detail = describe_description_path_fault(given, path);
    if (!detail.empty()) fault(pointer, detail);
    return detail.empty();
  }

  /// Looks at the descriptions of all cases, up to the first without the path.
  void check_swept_path(const std::string& path, const std::string& pointer) {
    if (!is_path_in_description(path)) return;
    bool right = sweep_.cases.empty() ? has_number_at(path, sweep_.parameters, pointer) : true;
    for (const json& each : sweep_.cases)
      right = right && has_number_at(path, whole_parameters_of(sweep_.parameters, each), pointer);
  }

  /// Numbers inside a description can only be swept where there is one that has them.
  void check_linkage_paths() {
    for (const Axis& axis : sweep_.axes) check_swept_path(axis.path, "/sweep" + pointer_token(axis.path));
    for (const std::string& path : sweep_.design.paths)
      check_swept_path(path, "/design/over" + pointer_token(path));
    for (std::size_t i = 0; i < sweep_.cases.size() && sweep_.cases[i].is_object(); ++i) {
      for (const auto& [path, value] : sweep_.cases[i].items()) {
        if (is_path_in_description(path))
          has_number_at(path, whole_parameters_of(sweep_.parameters, sweep_.cases[i]),
                        "/cases/" + std::to_string(i) + pointer_token(path));
      }
    }
  }

  const ordered_json& request_;
  std::size_t max_jobs_;
  std::uint64_t case_count_ = 1;
  std::uint64_t design_points_ = 0;  ///< 0: there is no design, or it has faults
  SweepRequest sweep_;
  /// Parameters of one of the jobs. Descriptions are judged beside them.
  json one_job_ = json::object();
  std::vector<Fault> faults_;
};

}  // namespace

SweepRequest parse_sweep_request(const ordered_json& request, std::size_t max_jobs) {
  return SweepParser(request, max_jobs).parse();
}

std::string parse_move_request(const json& request) {
  if (!request.is_object())
    throw InvalidRequest(std::vector<Fault>{{"", "must be an object with \"executor\""}});
  std::vector<Fault> faults;
  constexpr std::array<std::string_view, 1> kKeys{"executor"};
  for (const auto& [key, value] : request.items()) {
    if (key != kKeys.front()) faults.push_back({pointer_token(key), describe_unknown_key(key, kKeys)});
  }
  if (!is_executor(request.value("executor", json()))) faults.push_back({"/executor", kExecutorFault});
  if (!faults.empty()) throw InvalidRequest(std::move(faults));
  return request.at("executor");
}

}  // namespace jobs
