// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/search_request.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/span.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::array<std::string_view, 6> kKeysOfItsSweeps{"name",       "parameters", "sweep",
                                                           "replicates", "reuse",      "priority"};

std::vector<std::string_view> metric_keys() {
  std::vector<std::string_view> keys;
  for (const engine::QuantityInfo& metric : engine::metric_table()) keys.push_back(metric.key);
  return keys;
}

/// Reads one request; a member function a part of it.
class SearchParser {
 public:
  SearchParser(const ordered_json& request, std::size_t max_jobs) : request_(request), max_jobs_(max_jobs) {}

  SearchRequest parse() {
    if (!request_.is_object()) throw InvalidRequest(std::vector<Fault>{{"", "must be an object"}});
    check_keys();
    read_over();
    read_metric();
    read_rule();
    read_common();
    check_size();
    if (!faults_.empty()) throw InvalidRequest(std::move(faults_));
    return std::move(search_);
  }

 private:
  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  void check_keys() {
    for (const auto& [key, value] : request_.items()) {
      if (std::ranges::find(kSearchRequestKeys, key) == kSearchRequestKeys.end()) fault(pointer_token(key),
          describe_unknown_key(key, kSearchRequestKeys));
    }
  }

  void read_over() {
    if (!request_.contains("over") || !request_.at("over").is_object() || request_.at("over").size() != 1) {
      return fault(
          "/over",
          "must be an object of one parameter, {\"clearance_mm\": {\"from\": 0.05, \"to\": 0.5}}, say");
    }
    const std::string& path = request_.at("over").begin().key();
    const std::string pointer = "/over" + pointer_token(path);
    if (!is_known_path(path, pointer, faults_)) return;
    if (!is_numeric(path)) return fault(pointer, "must be a parameter whose values are numbers");
    if (is_path_in_description(path)) {
      return fault(pointer, "must be a parameter of the job, no number inside a description");
    }
    search_.parameter = path;
    const json given = request_.at("over").begin().value();
    if (!given.is_object()) {
      return fault(pointer, "must be an object of from, to, scale, tolerance and first");
    }
    read_interval(given, pointer);
  }

  void read_interval(const json& given, const std::string& pointer) {
    const std::size_t before = faults_.size();
    constexpr std::array<std::string_view, 2> kOthers{"tolerance", "first"};
    const auto span = read_span(given, kOthers, pointer, faults_);
    check_if_given(given, "tolerance", pointer,
                   [](const json& value) { return describe_number_fault(kToleranceRange, "", value); });
    check_if_given(given, "first", pointer,
                   [](const json& value) { return describe_integer_fault(kFirstRange, value); });
    if (!span || faults_.size() > before) return;
    for (const char* const end : {"from", "to"}) check_end(given.at(end), pointer + "/" + end);
    if (span->from == span->to) fault(pointer + "/to", "must differ from from");
    if (faults_.size() > before) return;
    const ParameterInfo* const info = find_parameter(search_.parameter);
    search_.interval = {.from = span->from,
                        .to = span->to,
                        .logarithmic = span->logarithmic,
                        .integer = info != nullptr && info->kind == ParameterKind::kInteger,
                        .tolerance = given.value("tolerance", 0.01 * std::abs(span->to - span->from)),
                        .first = given.value("first", kDefaultFirst)};
    interval_is_valid_ = true;
  }

  template <typename Describe>
  void check_if_given(const json& given, const char* key, const std::string& pointer,
                      const Describe& describe) {
    if (!given.contains(key)) return;
    if (std::string detail = describe(given.at(key)); !detail.empty()) {
      fault(pointer + "/" + key, std::move(detail));
    }
  }

  void check_end(const json& end, const std::string& pointer) {
    json alone = json::object();
    set_at_path(alone, search_.parameter, end);
    for (const Fault& found : find_value_faults(alone)) fault(pointer, found.detail);
  }

  void read_metric() {
    const auto known = metric_keys();
    if (!request_.contains("metric") || !request_.at("metric").is_string()) return fault("/metric",
        "must be the name of a metric, peak_slider_acceleration_m_s2, say");
    search_.metric = request_.at("metric").get<std::string>();
    if (std::ranges::find(known, search_.metric) == known.end()) {
      fault("/metric", "\"" + search_.metric + "\": " + describe_unknown_key(search_.metric, known));
    }
  }

  void read_rule() {
    const json bound = request_.value("bound", ordered_json());
    if (const std::string detail = describe_number_fault({}, "", bound); !detail.empty()) {
      fault("/bound", "must be a number, in the unit of the metric");
    } else {
      search_.rule.bound = bound.get<double>();
    }
    if (!request_.contains("quantile")) return;
    if (const std::string detail = describe_number_fault(kQuantileRange, "", request_.at("quantile"));
        !detail.empty()) {
      return fault("/quantile", detail);
    }
    search_.rule.quantile = request_.at("quantile").get<double>();
  }

  /// Reads the keys that a search has in common with a sweep.
  void read_common() {
    ordered_json common = ordered_json::object();
    for (const std::string_view key : kKeysOfItsSweeps) {
      if (request_.contains(key)) common[std::string(key)] = request_.at(key);
    }
    try {
      search_.common = parse_sweep_request(common, max_jobs_);
    } catch (const InvalidRequest& invalid) {
      faults_.insert(faults_.end(), invalid.faults().begin(), invalid.faults().end());
      return;
    }
    const auto& swept = search_.common.swept;
    if (std::ranges::find(swept, search_.parameter) != swept.end()) {
      fault("/over" + pointer_token(search_.parameter), "is an axis of sweep, too");
    }
  }

  void check_size() {
    if (!faults_.empty() || !interval_is_valid_) return;
    std::uint64_t jobs = most_evaluations(search_.interval) * search_.common.replicates.count;
    bool overflow = false;
    for (const Axis& axis : search_.common.axes) {
      overflow |= __builtin_mul_overflow(jobs, axis.values.size(), &jobs);
    }
    if (overflow || jobs > max_jobs_) {
      fault("/over" + pointer_token(search_.parameter), "the search may need " + std::to_string(jobs) +
                                                            " jobs; at most " + std::to_string(max_jobs_) +
                                                            " are allowed");
    }
  }

  const ordered_json& request_;
  std::size_t max_jobs_;
  SearchRequest search_;
  bool interval_is_valid_ = false;
  std::vector<Fault> faults_;
};

/// "/cases/3/clearance_mm" in the sweep as the place in the search's request that its value came from.
std::string pointer_in_search(const std::string& pointer, const SearchRequest& search) {
  constexpr std::string_view kCases = "/cases/";
  if (!pointer.starts_with(kCases)) return pointer;
  const auto slash = pointer.find('/', kCases.size());
  const std::string path = slash == std::string::npos ? "" : path_of_pointer(pointer.substr(slash));
  return (path == search.parameter ? "/over" : "/sweep") + (path.empty() ? "" : pointer_token(path));
}

}  // namespace

SearchRequest parse_search_request(const ordered_json& request, std::size_t max_jobs) {
  return SearchParser(request, max_jobs).parse();
}

std::vector<std::vector<json>> combinations_of(const SearchRequest& search) {
  std::vector<std::vector<json>> combinations{{}};
  for (const Axis& axis : search.common.axes) {
    std::vector<std::vector<json>> longer;
    for (const auto& combination : combinations) {
      for (const json& value : axis.values) {
        longer.push_back(combination);
        longer.back().push_back(value);
      }
    }
    combinations = std::move(longer);
  }
  return combinations;
}

ordered_json case_at(const SearchRequest& search, const std::vector<json>& combination, double x) {
  ordered_json made = ordered_json::object();
  const auto add = [&](const std::string& path, const json& value) {
    json alone = json::object();
    set_at_path(alone, path, value);
    made.merge_patch(ordered_json(alone));
  };
  for (std::size_t i = 0; i < combination.size(); ++i) add(search.common.axes[i].path, combination[i]);
  add(search.parameter, search.interval.integer ? json(std::llround(x)) : json(x));
  return made;
}

ordered_json first_sweep_of(const ordered_json& request, const SearchRequest& search) {
  ordered_json sweep = ordered_json::object();
  for (const std::string_view key : kKeysOfItsSweeps) {
    if (key != "sweep" && request.contains(key)) sweep[std::string(key)] = request.at(key);
  }
  sweep["cases"] = ordered_json::array();
  for (const auto& combination : combinations_of(search)) {
    for (const double x : first_values(search.interval)) {
      sweep["cases"].push_back(case_at(search, combination, x));
    }
  }
  return sweep;
}

SweepPlan plan_first_sweep(const ordered_json& sweep, const SearchRequest& search, std::size_t max_jobs) {
  try {
    return plan_sweep(sweep, max_jobs);
  } catch (const InvalidRequest& invalid) {
    std::vector<Fault> faults;
    std::set<std::string> told;
    for (const Fault& fault : invalid.faults()) {
      const std::string pointer = pointer_in_search(fault.pointer, search);
      if (told.insert(pointer + fault.detail).second) faults.push_back({pointer, fault.detail});
    }
    throw InvalidRequest(std::move(faults));
  }
}

}  // namespace jobs
