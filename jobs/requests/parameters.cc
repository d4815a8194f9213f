// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/parameters.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "engine/analysis/linkage_quantities.h"
#include "engine/errors.h"
#include "engine/simulate_linkage.h"
#include "engine/simulate_rpsup.h"
#include "jobs/linkages/linkage_actuator.h"
#include "jobs/linkages/linkage_drive.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/parameters/link_parameters.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/parameter_path.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr double kMostKeptSamples = 2e6;
constexpr double kMostStoredValues = 1.28e8;   // samples times channels: 1 GB while the job runs
constexpr double kLeastClearance_mm = 1e-6;    // 1 nm: below, a gap between atoms

std::vector<std::string_view> known_keys() {
  std::vector<std::string_view> keys{"links", kLinkageKey, kWearKey, kKeepKey};
  for (const RpsupDrive& drive : rpsup_drives()) keys.push_back(drive.key);
  for (const ParameterInfo& info : parameter_table()) keys.push_back(info.key);
  return keys;
}

/// The faults of what is given beside a described linkage.
void collect_faults_beside_linkage(const json& given, std::vector<Fault>& faults) {
  for (const auto& [key, value] : given.items()) {
    const ParameterInfo* info = find_parameter(key);
    if (key == kWearKey)
      faults.push_back({pointer_token(key), std::string(kWearOfDescribed)});
    else if (key == "links" || find_rpsup_drive(key) != nullptr ||
             (info != nullptr && info->scope == ParameterScope::kRpsup))
      faults.push_back({pointer_token(key),
                        "belongs to the linkage \"rpsup\"; a described linkage says it in its description"});
  }
}

/// The job's other parameters alone.
json without_linkage(json parameters) {
  parameters[kLinkageKey] = json::object();
  return parameters;
}

/// The faults of what is given beside a described linkage, and of the description with the job's other
/// parameters.
void collect_linkage_faults(const json& given, const json& beside, std::vector<Fault>& faults) {
  const json& linkage = given.at(kLinkageKey);
  if (!linkage.is_object()) {
    if (linkage != kRpsupName)
      faults.push_back({"/linkage", "must be \"rpsup\", or an object that describes a linkage"});
    return;
  }
  collect_faults_beside_linkage(given, faults);
  if (!faults.empty()) return;
  json others = beside;
  others.update(given);
  (void)read_linkage(linkage, to_job_spec(fill_in_defaults(without_linkage(others))).parameters, faults);
}

void add_clearance_faults(const json& completed, std::vector<Fault>& faults) {
  const double clearance = number_at(completed, "clearance_mm");
  const double bearing_radius = number_at(completed, "bearing_radius_mm");
  if (clearance >= bearing_radius) {
    faults.push_back({"/clearance_mm", "must be less than bearing_radius_mm, which is " +
                                           readable_number(bearing_radius) + " mm"});
  } else if (clearance > 0.0 && clearance < kLeastClearance_mm) {
    faults.push_back({"/clearance_mm", "must be 0 (the ideal joint) or at least " +
                                           readable_number(kLeastClearance_mm) + " mm"});
  }
}

constexpr double kLeastArm_mm = 1.0;           // as of the other lengths

/// Faults of drives that stand beside parameters which they replace.
void add_drive_faults(const json& completed, std::vector<Fault>& faults) {
  for (const RpsupDrive& drive : rpsup_drives()) {
    if (!completed.contains(drive.key)) continue;
    for (const std::string_view parameter : drive.replaced_by(completed.at(drive.key)))
      if (completed.contains(parameter))
        faults.push_back({pointer_token(parameter),
                          "cannot stand beside " + std::string(drive.key) + ", which replaces it"});
  }
}

/// Sections and lengths without which no default mass makes sense.
void add_link_faults(const json& completed, std::vector<Fault>& faults) {
  for (const std::string link : {"crank", "rod", "cross"}) {
    const double outer = number_at(completed, link + "_diameter_mm");
    if (number_at(completed, link + "_inner_diameter_mm") >= outer)
      faults.push_back(
          {"/" + link + "_inner_diameter_mm",
           "must be less than " + link + "_diameter_mm, which is " + readable_number(outer) + " mm"});
  }
  const double length = number_at(completed, "cross_length_mm");
  if (length > 0.0 && length < kLeastArm_mm)
    faults.push_back({"/cross_length_mm", "must be 0 (the joint is at the cross link's guide) or at least " +
                                              readable_number(kLeastArm_mm) + " mm"});
  if (length == 0.0 && completed.at("cross") == "flexible")
    faults.push_back({"/cross_length_mm", "must be at least " + readable_number(kLeastArm_mm) +
                                              " mm, as the cross link is flexible"});
}

void add_material_faults(const json& completed, std::vector<Fault>& faults) {
  const double most = 3.0 * number_at(completed, "shear_modulus_pa");
  // Poisson's ratio E/(2G) - 1 of a stable isotropic material is at most 1/2.
  if (number_at(completed, "youngs_modulus_pa") > most) {
    faults.push_back({"/youngs_modulus_pa", "must be at most 3 times shear_modulus_pa, " +
                                                readable_number(most) +
                                                " Pa: Poisson's ratio is at most 0.5"});
  }
}

void add_sample_faults(const JobSpec& spec, std::vector<Fault>& faults) {
  const double samples = spec.options.duration * spec.options.output_rate;
  if (samples > kMostKeptSamples) {
    faults.push_back({"/output_rate_hz", "duration_s times output_rate_hz is " +
                                             readable_number(std::floor(samples)) + " samples; at most " +
                                             readable_number(kMostKeptSamples) + " are kept"});
  } else if (has_more_channels(spec, kMostStoredValues / samples)) {
    const double values = samples * static_cast<double>(channel_table(spec).size());
    faults.push_back({"/output_rate_hz", "the trajectory would have " + readable_number(std::floor(values)) +
                                             " values; at most " + readable_number(kMostStoredValues) +
                                             " are kept"});
  }
}

void add_step_faults(const json& completed, const JobSpec& spec, std::vector<Fault>& faults) {
  if (std::string detail = describe_run_up_fault(spec.parameters.run_up); !detail.empty())
    faults.push_back({"/run_up_s", std::move(detail)});
  const double steps = spec.options.duration / number_at(completed, "step_s");
  if (spec.options.integrator == engine::Integrator::kRk4 &&
      steps > static_cast<double>(spec.options.step_limit)) {
    faults.push_back({"/step_s", "duration_s over step_s is " + readable_number(std::floor(steps)) +
                                     " steps; at most " + std::to_string(spec.options.step_limit) +
                                     " are taken"});
  }
}

/// "c_r" -> "/clearance_mm", "links.1,3.inertia" -> "/links/1,3/inertia_kg_m2"; empty if the engine's name is
/// no parameter.
std::string pointer_of_member(const std::string& member) {
  for (const ParameterInfo& info : parameter_table()) {
    if (info.member == member) return pointer_token(info.key);
  }
  if (member == "wear_depth") return pointer_token(kWearKey);
  for (const std::string_view link : kLinkNames) {
    const std::string prefix = "links." + std::string(link);
    if (member == prefix + ".mass") return "/links" + pointer_token(link) + pointer_token(kMassKey);
    if (member.starts_with(prefix)) return "/links" + pointer_token(link) + pointer_token(kInertiaKey);
  }
  return "";
}

/// The parameter to name for a linkage that cannot be assembled or locks: many decide it, and one that is not
/// at its default is the likeliest cause.
std::string pointer_of_geometry(const json& completed, std::string_view otherwise) {
  if (completed.contains(kRodDriveKey)) return pointer_token(kRodDriveKey);
  for (const std::string_view key : {"guide_offset_z_m", "guide_offset_y_m", "guide_angle_deg",
                                     "coupler_length_m", "rod_start_m", "rod_stroke_mm", "crank_start_rad"}) {
    if (completed.contains(key) &&
        completed.at(key) != canonical_value(*find_parameter(key), default_value(*find_parameter(key))))
      return pointer_token(key);
  }
  return pointer_token(completed.contains(kCrankDriveKey) ? kCrankDriveKey : otherwise);
}

/// The fault of a linkage whose names make one key twice.
void add_key_fault(const engine::Linkage& linkage, const json& description, std::vector<Fault>& faults) {
  const engine::BuiltLinkage built = engine::build_linkage(linkage);
  const auto clash = engine::LinkageQuantities(linkage, built, 0.0).find_key_clash();
  if (clash) faults.push_back({pointer_of_linkage_field(clash->field, description), clash->detail});
}

void add_engine_fault(const json& completed, const JobSpec& spec, std::vector<Fault>& faults) {
  try {
    if (spec.linkage) {
      (void)engine::check_linkage(*spec.linkage, spec.options.integrator);
      return;
    }
    engine::check_parameters(spec.parameters, spec.options);
  } catch (const engine::InvalidInput& fault) {
    const std::string& field = fault.field();
    std::string pointer = spec.linkage       ? pointer_of_linkage_field(field, completed.at(kLinkageKey))
                          : field == "reach" ? pointer_of_geometry(completed, "coupler_length_m")
                          : field == "yoke"  ? pointer_of_geometry(completed, "guide_offset_z_m")
                                             : pointer_of_member(field);
    faults.push_back({pointer, pointer.empty() ? fault.what() : fault.detail()});
  }
}

/// As many channels as a job of "rpsup" has at most: that of links in as many parts and of as many worn rings
/// as there may be.
std::size_t count_most_channels() {
  JobSpec spec = to_job_spec(fill_in_defaults({{"coupler", "flexible"}, {"crank", "flexible"},
                                               {"rod", "flexible"}, {"cross", "flexible"},
                                               {"cross_length_mm", 100}}));
  for (const std::string_view key :
       {"rigid_elements", "crank_elements", "rod_elements", "cross_elements", "radial_levels"}) {
    const ParameterInfo& info = *find_parameter(key);
    info.write(spec, static_cast<int>(info.range.maximum));
  }
  constexpr std::size_t kSectors = 8;
  spec.parameters.wear_depth.assign(static_cast<std::size_t>(spec.parameters.radial_levels),
                                    std::vector<double>(kSectors, 0.0));
  return channel_table(spec).size();
}

/// Text for a key that would be right elsewhere.
std::string describe_misplaced(const std::string& key) {
  if (key == "parameters") return "unknown key; parameters stand in this object itself";
  if (key == "sweep" || key == "cases" || key == "design" || key == "replicates")
    return "unknown key; in a sweep (POST /v1/sweeps, rpsup sweep) it stands beside \"parameters\", not "
           "among them";
  if (key.starts_with("links."))
    return "unknown key; here it is written as an object: {\"links\": {\"1,1\": {\"mass_kg\": 0.5}}}";
  return "";
}

/// Fault of a key that cannot have the value, or cannot stand here; empty if there is none. Values with parts
/// are not looked at.
std::string describe_value_fault(const std::string& key, const json& value) {
  if (key == kLinkageKey) return "";
  if (key == kKeepKey) return describe_keep_fault(value);
  if (const ParameterInfo* info = find_parameter(key)) return describe_fault(*info, value);
  const std::string misplaced = describe_misplaced(key);
  return misplaced.empty() ? describe_unknown_key(key, known_keys(), "GET /v1/parameters") : misplaced;
}

/// Drives with faults are left as they are given.
void fill_in_drives(const json& given, json& completed) {
  for (const RpsupDrive& drive : rpsup_drives()) {
    if (!given.contains(drive.key)) continue;
    std::vector<Fault> faults;  // of numbers inside that a sweep varies; find_combination_faults() tells them
    check_drive(given.at(drive.key), drive.motion, "", faults);
    completed[drive.key] =
        faults.empty() ? canonical_drive(given.at(drive.key), drive.motion) : given.at(drive.key);
  }
}

std::vector<Fault> find_description_faults(const json& completed) {
  std::vector<Fault> faults;
  const json& description = completed.at(kLinkageKey);
  const auto linkage = read_linkage(description, to_job_spec(without_linkage(completed)).parameters, faults);
  if (linkage) add_key_fault(*linkage, description, faults);
  return faults;
}

std::vector<Fault> find_drive_faults(const json& completed) {
  std::vector<Fault> faults;
  for (const RpsupDrive& drive : rpsup_drives())
    if (completed.contains(drive.key))
      check_drive(completed.at(drive.key), drive.motion, pointer_token(drive.key), faults);
  return faults;
}

/// Faults that only jobs of "rpsup" have. (Joints of a description are judged one by one.)
void add_rpsup_faults(const json& completed, std::vector<Fault>& faults) {
  add_drive_faults(completed, faults);
  add_link_faults(completed, faults);
  if (faults.empty()) faults = find_inertia_faults(completed);
  add_clearance_faults(completed, faults);
}

void write_drives(const json& completed, engine::RpsupParameters& parameters) {
  for (const RpsupDrive& drive : rpsup_drives()) {
    if (!completed.contains(drive.key)) continue;
    const json& given = completed.at(drive.key);
    if (is_actuator(given))
      parameters.*drive.actuator = read_actuator(given, drive.motion, parameters);
    else
      parameters.*drive.law = read_drive(given, drive.motion, parameters);
  }
}

/// Parameters that only jobs of "rpsup" have.
void write_rpsup(const json& completed, engine::RpsupParameters& parameters) {
  write_links(completed.at("links"), parameters);
  if (completed.contains(kWearKey)) parameters.wear_depth = to_wear_depth(completed.at(kWearKey));
  write_drives(completed, parameters);
}

void write_description(const json& description, JobSpec& spec) {
  std::vector<Fault> faults;
  spec.linkage = read_linkage(description, spec.parameters, faults);
  if (!spec.linkage) throw InvalidRequest(std::move(faults));
}

}  // namespace

std::vector<Fault> find_value_faults(const json& given, const json& beside) {
  if (!given.is_object()) return {{"", "must be an object of parameters"}};
  std::vector<Fault> faults;
  for (const auto& [key, value] : given.items()) {
    if (key == "links")
      std::ranges::move(find_link_faults(value), std::back_inserter(faults));
    else if (key == kWearKey)
      std::ranges::move(find_wear_faults(value), std::back_inserter(faults));
    else if (const RpsupDrive* drive = find_rpsup_drive(key))
      check_drive(value, drive->motion, pointer_token(key), faults);
    else if (std::string detail = describe_value_fault(key, value); !detail.empty())
      faults.push_back({pointer_token(key), std::move(detail)});
  }
  if (faults.empty() && given.contains(kLinkageKey)) collect_linkage_faults(given, beside, faults);
  return faults;
}

std::vector<Fault> find_path_faults(const std::string& path, const json& value) {
  if (is_path_in_description(path)) {
    const auto whole = find_whole_range(path);
    std::string detail = whole               ? describe_integer_fault(*whole, value)
                         : value.is_number() ? ""
                                             : "must be a number";
    return detail.empty() ? std::vector<Fault>{}
                          : std::vector<Fault>{{pointer_of_path(path), std::move(detail)}};
  }
  json alone = json::object();
  set_at_path(alone, path, value);
  return find_value_faults(alone);
}

json fill_in_defaults(const json& given) {
  json completed = json::object();
  const bool described = describes_linkage(given);
  for (const ParameterInfo& info : parameter_table()) {
    if (described && info.scope == ParameterScope::kRpsup) continue;
    const auto found = given.find(info.key);
    if (found == given.end() && find_replacing_drive(given, info.key) != nullptr) continue;
    completed[info.key] = canonical_value(info, found == given.end() ? default_value(info) : *found);
  }
  completed[kLinkageKey] = described ? canonical_description(given.at(kLinkageKey)) : json(kRpsupName);
  if (!described) completed["links"] = complete_links(given.value("links", json::object()), completed);
  if (given.contains(kWearKey)) completed[kWearKey] = canonical_wear(given.at(kWearKey));
  if (keeps_metrics_alone(given)) completed[kKeepKey] = kKeepMetrics;
  fill_in_drives(given, completed);
  return completed;
}

std::vector<Fault> find_combination_faults(const json& completed) {
  const bool described = describes_linkage(completed);
  std::vector<Fault> faults = described ? find_description_faults(completed) : find_drive_faults(completed);
  if (!faults.empty()) return faults;
  if (!described) add_rpsup_faults(completed, faults);
  const JobSpec spec = to_job_spec(completed);
  add_material_faults(completed, faults);
  add_sample_faults(spec, faults);
  add_step_faults(completed, spec, faults);
  // The engine may rely on what has been checked so far.
  if (faults.empty()) add_engine_fault(completed, spec, faults);
  return faults;
}

json complete_parameters(const json& given, const std::string& pointer) {
  std::vector<Fault> faults = find_value_faults(given);
  json completed;
  if (faults.empty()) {
    completed = fill_in_defaults(given);
    faults = find_combination_faults(completed);
  }
  if (faults.empty()) return completed;
  for (Fault& fault : faults) fault.pointer.insert(0, pointer);
  throw InvalidRequest(std::move(faults));
}

JobSpec to_job_spec(const json& completed_parameters) {
  JobSpec spec;
  spec.keeps_trajectory = !keeps_metrics_alone(completed_parameters);
  const bool described = describes_linkage(completed_parameters);
  for (const ParameterInfo& info : parameter_table()) {
    if (described && info.scope == ParameterScope::kRpsup) continue;
    if (find_replacing_drive(completed_parameters, info.key) == nullptr)
      info.write(spec, completed_parameters.at(info.key));
  }
  if (!described)
    write_rpsup(completed_parameters, spec.parameters);
  else if (const json& linkage = completed_parameters.at(kLinkageKey); !linkage.empty())
    write_description(linkage, spec);
  return spec;
}

std::vector<engine::QuantityInfo> metric_table(const json& given) {
  if (describes_linkage(given))
    return engine::linkage_tables(*to_job_spec(fill_in_defaults(given)).linkage).metrics;
  const auto table = engine::metric_table();
  return {table.begin(), table.end()};
}

std::vector<engine::QuantityInfo> channel_table(const JobSpec& spec) {
  return spec.linkage ? engine::linkage_tables(*spec.linkage).channels
                      : engine::channel_table(spec.parameters);
}

bool has_more_channels(const JobSpec& spec, double most) {
  static const auto most_of_any = static_cast<double>(count_most_channels());
  return (spec.linkage || most < most_of_any) && static_cast<double>(channel_table(spec).size()) > most;
}

}  // namespace jobs
