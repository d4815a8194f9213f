// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear_request.h"

#include <algorithm>
#include <utility>

#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/parameters.h"
#include "jobs/requests/request_parser.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kKeysOfItsSweep{"name", "parameters", "reuse", "priority"};

/// Parameter with which a bearing cannot be worn from new.
std::optional<Fault> find_unfit_parameter(const json& given) {
  if (describes_linkage(given))
    return Fault{"/parameters/linkage", "must be \"rpsup\": the bearing that is worn is that linkage's"};
  if (given.contains(kWearKey))
    return Fault{"/parameters" + pointer_token(kWearKey),
                 "must be left out: a study begins with a round bore"};
  if (keeps_metrics_alone(given))
    return Fault{"/parameters" + pointer_token(kKeepKey), std::string(kNeedsTrajectories)};
  return std::nullopt;
}

/// Reads one request; a member function a part of it.
class WearParser : public RequestParser {
 public:
  WearParser(const ordered_json& request, std::size_t max_jobs)
      : RequestParser(request), max_jobs_(max_jobs) {}

  WearStudyRequest parse() {
    check_keys_of(request_, "", kWearStudyKeys);
    read_rule();
    read_common();
    throw_if_faulty();
    return std::move(study_);
  }

 private:
  template <typename T>
  void take_number(const char* key, const Range& range, std::string_view unit, T& value) {
    if (!request_.contains(key)) return;
    const json given = request_.at(key);
    if (is_right(pointer_token(key), describe_number_fault(range, unit, given))) value = given.get<double>();
  }

  void take_count(const char* key, const Range& range, std::size_t& value) {
    if (!request_.contains(key)) return;
    const json given = request_.at(key);
    if (is_right(pointer_token(key), describe_integer_fault(range, given))) value = given.get<std::size_t>();
  }

  void read_rule() {
    take_number("wear_coefficient_m2_n", kWearCoefficientRange, "m^2/N", study_.query.wear_coefficient);
    take_count("sectors", kBoreSectorsRange, study_.query.sectors);
    take_number("hours", kPositiveRange, "h", study_.rule.hours);
    take_number("worn_clearance_mm", kPositiveRange, "mm", study_.query.worn_clearance);
    take_number("max_depth_step_um", kDepthStepRange, "um", study_.rule.depth_step_um);
    take_number("max_rate_change", kPositiveRange, "", study_.rule.rate_change);
    take_count("max_cycles", kCyclesRange, study_.rule.cycles);
    if (!request_.contains("hours") && !request_.contains("worn_clearance_mm")) {
      fault("/hours", "is missing: hours, worn_clearance_mm or both say how far the bearing is worn");
    }
  }

  void read_common() {
    try {
      study_.common = parse_sweep_request(take_keys(request_, kKeysOfItsSweep), max_jobs_);
      const json& given = study_.common.parameters;
      if (auto unfit = find_unfit_parameter(given)) return faults_.push_back(std::move(*unfit));
      study_.completed = complete_parameters(given, "/parameters");
    } catch (const InvalidRequest& invalid) {
      return add_faults(invalid);
    }
    check_joint();
    check_window();
  }

  void check_joint() {
    const double clearance = study_.clearance_mm();
    if (!(clearance > 0.0)) {
      fault("/parameters/clearance_mm", "must be above 0 mm: the ideal joint does not slide");
    }
    if (study_.completed.at("contact") != "continuum") {
      fault("/parameters/contact", "must be \"continuum\": a worn bore is for that form of the contact");
    }
    if (study_.query.worn_clearance) set_deepest(clearance, *study_.query.worn_clearance);
  }

  /// Sets the depth that ends the study. Both clearances in mm.
  void set_deepest(double clearance, double worn_clearance) {
    const double most = clearance + 0.1 * study_.completed.at("bearing_radius_mm").get<double>();
    if (const Range range{clearance, most, Bound::kExclusive, Bound::kExclusive};
        !range.contains(worn_clearance)) {
      fault("/worn_clearance_mm",
            "must be " + range.text() +
                " mm: more than the clearance, by less than a tenth of the bearing's radius");
    }
    study_.rule.deepest_um = 1e3 * (worn_clearance - clearance);
  }

  /// The rate of wear is taken from the steady motion.
  void check_window() {
    const double steady =
        study_.completed.at("duration_s").get<double>() - study_.completed.at("run_up_s").get<double>();
    if (!(steady * study_.completed.at("output_rate_hz").get<double>() >= 2.0)) {
      fault("/parameters/duration_s",
            "must be above run_up_s, by two samples or more: the rate of wear is that of the steady motion");
    }
  }

  std::size_t max_jobs_;
  WearStudyRequest study_;
};

}  // namespace

WearStudyRequest parse_wear_request(const ordered_json& request, std::size_t max_jobs) {
  return WearParser(request, max_jobs).parse();
}

ordered_json case_of(const WearGrid& depth_um) { return {{std::string(kWearKey), depth_um}}; }

ordered_json first_sweep_of(const ordered_json& request, const WearStudyRequest& study) {
  ordered_json sweep = take_keys(request, kKeysOfItsSweep);
  sweep["cases"] = ordered_json::array({case_of(study.round_bore())});
  return sweep;
}

}  // namespace jobs
