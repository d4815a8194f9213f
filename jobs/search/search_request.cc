// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/search_request.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/span.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/metric_keys.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"
#include "jobs/requests/request_parser.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::array<std::string_view, 6> kKeysOfItsSweeps{"name",       "parameters", "sweep",
                                                           "replicates", "reuse",      "priority"};

/// Reader of one request; a member function a part of it.
class SearchParser : private RequestParser {
 public:
  SearchParser(const ordered_json& request, std::size_t max_jobs)
      : RequestParser(request), max_jobs_(max_jobs) {}

  SearchRequest parse() {
    check_keys_of(json(request_), "", kSearchRequestKeys);
    read_common();
    read_over();
    read_metric();
    read_rule();
    check_size();
    throw_if_faulty();
    return std::move(search_);
  }

 private:
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
    if (common_is_read_ && is_path_in_description(path) &&
        !is_right(pointer, describe_description_path_fault(search_.common.parameters, path)))
      return;
    search_.parameter = path;
    const auto& swept = search_.common.swept;
    if (std::ranges::find(swept, path) != swept.end()) fault(pointer, "is an axis of sweep, too");
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
    search_.interval = interval_of(*span, given);
    interval_is_valid_ = true;
  }

  [[nodiscard]] SearchInterval interval_of(const Span& span, const json& given) const {
    const bool in_ratios = span.logarithmic && !given.contains("tolerance");
    const double way = in_ratios ? std::log(span.to / span.from) : span.to - span.from;
    return {.from = span.from,
            .to = span.to,
            .logarithmic = span.logarithmic,
            .integer = is_integer(search_.parameter),
            .tolerance = given.value("tolerance", 0.01 * std::abs(way)),
            .in_ratios = in_ratios,
            .first = given.value("first", kDefaultFirst)};
  }

  template <typename Describe>
  void check_if_given(const json& given, const char* key, const std::string& pointer,
                      const Describe& describe) {
    if (given.contains(key)) (void)is_right(pointer + "/" + key, describe(given.at(key)));
  }

  void check_end(const json& end, const std::string& pointer) {
    for (const Fault& found : find_path_faults(search_.parameter, end)) fault(pointer, found.detail);
  }

  void read_metric() {
    const json metric = request_.value("metric", ordered_json());
    if (is_right("/metric", describe_metric_fault(metric, metrics_)))
      search_.metric = metric.get<std::string>();
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
    try {
      search_.common = parse_sweep_request(take_keys(request_, kKeysOfItsSweeps), max_jobs_);
      common_is_read_ = true;
      metrics_ = metric_keys_of(take_keys(request_, kPartsWithMetrics));
    } catch (const InvalidRequest& invalid) {
      add_faults(invalid);
      const bool is_described = request_.value("parameters", ordered_json()).contains(kLinkageKey);
      if (!is_described) metrics_ = metric_keys_of(json::object());
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

  std::size_t max_jobs_;
  SearchRequest search_;
  std::vector<std::string> metrics_;  ///< of the linkage; empty if it has faults
  bool common_is_read_ = false;
  bool interval_is_valid_ = false;
};

/// "/cases/3/clearance_mm" in the sweep as the place in the search's request that its value came from.
std::string pointer_in_search(const std::string& pointer, const SearchRequest& search) {
  if (!pointer.starts_with("/cases/")) return pointer;
  const std::string path = path_in_case(pointer);
  const bool is_over = path == search.parameter || search.common.axes.empty();
  return (is_over ? "/over" : "/sweep") + (path.empty() ? "" : pointer_token(path));
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
  for (std::size_t i = 0; i < combination.size(); ++i)
    set_in_case(made, search.common.axes[i].path, combination[i]);
  set_in_case(made, search.parameter, search.interval.integer ? json(std::llround(x)) : json(x));
  return made;
}

ordered_json common_sweep_of_search(const ordered_json& request) {
  ordered_json sweep = take_keys(request, kKeysOfItsSweeps);
  sweep.erase("sweep");
  return sweep;
}

ordered_json first_sweep_of(const ordered_json& request, const SearchRequest& search) {
  ordered_json sweep = common_sweep_of_search(request);
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
