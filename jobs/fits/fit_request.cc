// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_request.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "jobs/fits/fit_cases.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"
#include "jobs/requests/request_parser.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/requests/variable.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Keys that a fit has in common with the sweep of its jobs.
constexpr std::array<std::string_view, 5> kSweepKeys{"name", "parameters", "reuse", "priority", "executor"};
constexpr std::string_view kSensorPrefix = "sensor.";
constexpr std::string_view kRunPrefix = "runs.";
constexpr std::array<std::pair<std::string_view, SensorQuantity>, 3> kSensorQuantities{
    {{"gain", SensorQuantity::kGain},
     {"offset", SensorQuantity::kOffset},
     {"delay_s", SensorQuantity::kDelay}}};
/// Samples of jobs per second: at least so many, and so many where the measured ones are not evenly spaced.
constexpr double kLeastRate = 1000.0;
constexpr double kUnevenRate = 5000.0;
/// Cycles in a signal whose drive has no period.
constexpr double kCyclesOfOther = 8.0;

/// Samples that tell their noise.
constexpr std::size_t kFewestForNoise = 50;

/// Entry of "measurements" as it was read.
struct ReadMeasurement {
  std::string pointer;
  Measurement measurement;
  std::vector<std::size_t> runs;
  std::set<std::size_t> held_back_runs;
  std::vector<TimeWindow> fitted, held_back;
  double time_shift_s = 0.0;
  std::map<std::string, json> channels;  ///< options by name; empty: all that the jobs have, too
};

/// Samples per second of a measured time axis; 0 if they are not evenly spaced.
double even_rate(const std::vector<double>& time_s) {
  const double step = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  for (std::size_t k = 1; k < time_s.size(); ++k)
    if (std::abs(time_s[k] - time_s.front() - step * static_cast<double>(k)) > 1e-3 * step) return 0.0;
  return std::stod(number_text(std::round(1e6 / step) / 1e6));
}

/// Reader of one request; a member function a part of it.
class FitParser : private RequestParser {
 public:
  FitParser(const ordered_json& request, const FindMeasurement& find_measurement, std::size_t max_jobs)
      : RequestParser(request), find_measurement_(find_measurement), max_jobs_(max_jobs) {}

  FitProblem parse() {
    check_keys_of(json(request_), "", kFitRequestKeys);
    read_common();
    read_measurements();
    read_numbers();
    throw_if_faulty();
    add_runs();
    read_parameters();
    throw_if_faulty();
    add_parameters_of_runs();
    set_job_times();
    complete_runs();
    throw_if_faulty();
    for (const ReadMeasurement& one : read_) add_signals(one);
    throw_if_faulty();
    check_signals();
    if (faults_.empty()) check_places();
    check_size();
    throw_if_faulty();
    return std::move(made_);
  }

 private:
  void read_common() {
    made_.common_sweep = parts_of(kSweepKeys);
    try {
      common_ = parse_sweep_request(made_.common_sweep, max_jobs_);
    } catch (const InvalidRequest& invalid) {
      add_faults(invalid);
    }
  }

  void read_measurements() {
    const json given = request_.value("measurements", ordered_json());
    if (!given.is_array() || given.empty() || given.size() > kMostFittedMeasurements)
      return fault("/measurements", "must be a list of 1 to " + std::to_string(kMostFittedMeasurements) +
                                        " objects, {\"id\": \"mea_...\"}, say");
    for (std::size_t k = 0; k < given.size(); ++k)
      read_measurement(given[k], "/measurements/" + std::to_string(k));
  }

  void read_measurement(const json& given, const std::string& pointer) {
    if (!given.is_object()) return fault(pointer, "must be an object with \"id\"");
    check_keys_of(given, pointer, kFittedMeasurementKeys);
    const json id = given.value("id", json());
    if (!id.is_string()) return fault(pointer + "/id", "must be the id of a measurement");
    auto found = find_measurement_(id.get<std::string>());
    if (!found) return fault(pointer + "/id", "there is no measurement " + id.get<std::string>());
    ReadMeasurement one;
    one.pointer = pointer;
    one.measurement = std::move(*found);
    ids_.push_back(id.get<std::string>());
    one.runs = read_runs(given, pointer, "runs", one.measurement.runs.size(), true);
    for (const std::size_t run :
         read_runs(given, pointer, "held_back_runs", one.measurement.runs.size(), false)) {
      if (std::ranges::find(one.runs, run) == one.runs.end())
        fault(pointer + "/held_back_runs", "has run " + std::to_string(run) + ", which is not among runs");
      one.held_back_runs.insert(run);
    }
    one.fitted = read_windows(given, pointer, "fitted");
    one.held_back = read_windows(given, pointer, "held_back");
    if (given.contains("time_shift_s") &&
        is_right(pointer + "/time_shift_s", describe_number_fault({}, "s", given.at("time_shift_s"))))
      one.time_shift_s = given.at("time_shift_s").get<double>();
    read_channels(given, one);
    read_.push_back(std::move(one));
  }

  std::vector<std::size_t> read_runs(const json& given, const std::string& pointer, const char* key,
                                     std::size_t count, bool all) {
    std::vector<std::size_t> runs;
    if (!given.contains(key)) {
      for (std::size_t k = 0; all && k < count; ++k) runs.push_back(k);
      return runs;
    }
    const json& list = given.at(key);
    const Range range{.minimum = 0.0, .maximum = static_cast<double>(count - 1)};
    if (!list.is_array() || (all && list.empty())) {
      fault(pointer + "/" + key, "must be a list of numbers of runs, from 0 to " + std::to_string(count - 1));
      return runs;
    }
    for (std::size_t k = 0; k < list.size(); ++k) {
      const std::string place = pointer + "/" + key + "/" + std::to_string(k);
      if (!is_right(place, describe_integer_fault(range, list[k]))) continue;
      const auto run = list[k].get<std::size_t>();
      if (std::ranges::find(runs, run) != runs.end()) fault(place, "is in the list already");
      runs.push_back(run);
    }
    return runs;
  }

  std::vector<TimeWindow> read_windows(const json& given, const std::string& pointer, const char* key) {
    std::vector<TimeWindow> windows;
    if (!given.contains(key)) return windows;
    const json& list = given.at(key);
    if (!list.is_array()) {
      fault(pointer + "/" + key, "must be a list of windows, [[0, 2]], say");
      return windows;
    }
    for (std::size_t k = 0; k < list.size(); ++k) {
      const json& window = list[k];
      const bool right = window.is_array() && window.size() == 2 && window[0].is_number() &&
                         window[1].is_number() && window[0].get<double>() < window[1].get<double>();
      if (right) windows.push_back({.from_s = window[0].get<double>(), .to_s = window[1].get<double>()});
      else fault(pointer + "/" + key + "/" + std::to_string(k), "must be two ascending times, [0, 2], say");
    }
    return windows;
  }

  void read_channels(const json& given, ReadMeasurement& one) {
    if (!given.contains("channels")) return;
    const std::string pointer = one.pointer + "/channels";
    const json& channels = given.at("channels");
    if (!channels.is_object() || channels.empty())
      return fault(pointer, "must be an object of channels, {\"slider_acceleration_m_s2\": {}}, say");
    std::vector<std::string_view> known;
    for (const MeasuredChannel& channel : one.measurement.channels) known.push_back(channel.name);
    for (const auto& [name, options] : channels.items()) {
      const std::string place = pointer + pointer_token(name);
      if (std::ranges::find(known, name) == known.end()) {
        fault(place, describe_unknown_key(name, known));
        continue;
      }
      if (!options.is_object()) {
        fault(place, "must be an object of weight and noise");
        continue;
      }
      check_keys_of(options, place, kFittedChannelKeys);
      for (const std::string_view key : kFittedChannelKeys) {
        const Range above_0{.minimum = 0.0, .lower = Bound::kExclusive};
        if (options.contains(key))
          is_right(place + "/" + std::string(key), describe_number_fault(above_0, "", options.at(key)));
      }
      one.channels[name] = options;
    }
  }

  void read_numbers() {
    made_.replicates = read_integer("replicates", kFitReplicatesRange, 4);
    most_samples_ = read_integer("samples", kFitSamplesRange, 6000);
    made_.seed = read_integer("seed", kFitSeedRange, 1);
    const std::size_t n =
        request_.contains("over") && request_.at("over").is_object() ? request_.at("over").size() : 1;
    made_.budget = read_integer("budget", kFitBudgetRange, 2000);
    const std::size_t most = made_.budget / 4;
    made_.population = read_integer("population", kFitPopulationRange, std::min(10 + 5 * n, most));
    if (made_.population > most)
      fault("/population", "must be at most " + std::to_string(most) + ", a quarter of the budget");
    const json basis = request_.value("basis", ordered_json("by_divergence"));
    if (basis == "point_wise") made_.basis = FitBasis::kPointWise;
    else if (basis == "features") made_.basis = FitBasis::kFeatures;
    else if (basis != "by_divergence")
      fault("/basis", "must be \"by_divergence\", \"point_wise\" or \"features\"");
    const json intervals = request_.value("intervals", ordered_json("profile"));
    made_.profiles = intervals == "profile";
    if (intervals != "profile" && intervals != "linearised")
      fault("/intervals", "must be \"profile\" or \"linearised\"");
  }

  void add_runs() {
    for (std::size_t k = 0; k < read_.size(); ++k) {
      for (const std::size_t run : read_[k].runs)
        made_.runs.push_back({.measurement_id = ids_[k], .number = run});
    }
  }

  void read_parameters() {
    const ordered_json given = request_.value("over", ordered_json());
    if (!given.is_object() || given.empty() || given.size() > kMostFitParameters)
      return fault("/over", "must be an object of 1 to " + std::to_string(kMostFitParameters) +
                                " parameters, {\"clearance_mm\": {\"from\": 0.1, \"to\": 0.5}}, say");
    for (const auto& [path, entry] : given.items()) {
      const std::string pointer = "/over" + pointer_token(path);
      if (path.starts_with(kSensorPrefix)) read_sensor(path, json(entry), pointer);
      else read_job_parameter(path, json(entry), pointer);
    }
  }

  void read_sensor(const std::string& path, const json& given, const std::string& pointer) {
    const std::size_t dot = path.rfind('.');
    const std::string name =
        dot > kSensorPrefix.size() ? path.substr(kSensorPrefix.size(), dot - kSensorPrefix.size()) : "";
    const std::string last = path.substr(dot + 1);
    const auto quantity =
        std::ranges::find(kSensorQuantities, last, [](const auto& one) { return one.first; });
    const auto has_channel = [&](const ReadMeasurement& one) {
      return std::ranges::find(one.measurement.channels, name, &MeasuredChannel::name) !=
                 one.measurement.channels.end() &&
             (one.channels.empty() || one.channels.contains(name));
    };
    if (quantity == kSensorQuantities.end())
      return fault(pointer, "must end in gain, offset or delay_s, sensor.slider_position_m.gain, say");
    if (std::ranges::none_of(read_, has_channel)) return fault(pointer, "names no channel that is compared");
    if (!given.is_object()) return fault(pointer, "must be an object of from, to, scale and start");
    const std::size_t before = faults_.size();
    constexpr std::array<std::string_view, 1> kOthers{"start"};
    const auto span = read_span(given, kOthers, pointer, faults_);
    if (!span || faults_.size() > before) return;
    if (span->from >= span->to) return fault(pointer + "/to", "must be above from");
    FitParameter parameter{.path = path, .span = *span, .name = name, .sensor = quantity->second};
    if (given.contains("start")) {
      const Range within{.minimum = span->from, .maximum = span->to};
      if (!is_right(pointer + "/start", describe_number_fault(within, "", given.at("start")))) return;
      parameter.start = given.at("start").get<double>();
    }
    made_.parameters.push_back(std::move(parameter));
  }

  void read_job_parameter(const std::string& path, const json& given, const std::string& pointer) {
    std::optional<std::size_t> run;
    std::string name = path;
    if (path.starts_with(kRunPrefix)) {
      const std::size_t dot = path.find('.', kRunPrefix.size());
      const std::string number = path.substr(kRunPrefix.size(), dot - kRunPrefix.size());
      for (std::size_t k = 0; k < made_.runs.size(); ++k)
        if (number == std::to_string(k)) run = k;
      if (!run || dot == std::string::npos)
        return fault(pointer, "must have the number of a run behind runs., from 0 to " +
                                  std::to_string(made_.runs.size() - 1) + ", and a parameter behind it");
      name = path.substr(dot + 1);
    }
    auto variable =
        read_variable(name, given, pointer, run ? ordered_json::object() : request_, common_, faults_);
    if (!variable) return;
    if (variable->integer)
      return fault(pointer, "has whole numbers only, which a fit cannot approach step by step");
    const auto is_same = [&](const FitParameter& other) {
      return !other.sensor && other.name == name && (!other.run || !run || other.run == run);
    };
    if (std::ranges::any_of(made_.parameters, is_same))
      return fault(pointer, "is a parameter of all runs, too");
    made_.parameters.push_back({.path = path,
                                .span = variable->span,
                                .start = variable->start,
                                .integer = variable->integer,
                                .name = name,
                                .run = run});
  }

  [[nodiscard]] const MeasuredRun& measured_run(std::size_t run) const {
    std::size_t first = 0;
    for (const ReadMeasurement& one : read_) {
      if (run < first + one.runs.size()) return one.measurement.runs[one.runs[run - first]];
      first += one.runs.size();
    }
    throw std::logic_error("a fit has no such run");
  }

  /// Gives each run values of all paths that some run has its own value of: rows of a sweep have one list of
  /// paths.
  void add_parameters_of_runs() {
    std::vector<std::string> paths;
    const auto add_path = [&](const std::string& path) {
      if (std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
    };
    for (std::size_t k = 0; k < made_.runs.size(); ++k)
      for (const std::string& path : paths_of(ordered_json(measured_run(k).parameters))) add_path(path);
    for (const FitParameter& parameter : made_.parameters)
      if (parameter.run) add_path(parameter.name);
    const auto is_of_all = [&](const std::string& path) {
      return std::ranges::any_of(made_.parameters, [&](const FitParameter& one) {
        return !one.sensor && !one.run && one.name == path;
      });
    };
    std::erase_if(paths, is_of_all);
    for (std::size_t k = 0; k < made_.runs.size(); ++k) add_own_values(k, paths);
  }

  void add_own_values(std::size_t run, const std::vector<std::string>& paths) {
    const json& own = measured_run(run).parameters;
    try {
      const json given = parameters_of_case(common_.parameters, own);
      if (auto found = find_value_faults(given); !found.empty()) throw InvalidRequest(std::move(found));
      const json completed = fill_in_defaults(given);
      for (const std::string& path : paths) {
        const json& value = own.contains(path) ? own.at(path) : value_at_path(completed, path);
        made_.runs[run].parameters.emplace_back(path, value);
      }
    } catch (const InvalidRequest& invalid) {
      refuse_run(run, invalid);
    }
  }

  void refuse_run(std::size_t run, const InvalidRequest& invalid) {
    const FitRun& one = made_.runs[run];
    for (const Fault& found : invalid.faults()) {
      const std::string path = path_of_pointer(found.pointer);
      const auto is_it = [&](const FitParameter& parameter) {
        return !parameter.sensor &&
               (parameter.name == path || pointer_of_path(parameter.name) == found.pointer);
      };
      const auto free = std::ranges::find_if(made_.parameters, is_it);
      const bool is_free = free != made_.parameters.end();
      fault(is_free ? "/over" + pointer_token(free->path) : "/parameters" + found.pointer,
            found.detail + " (run " + std::to_string(one.number) + " of " + one.measurement_id + ")");
    }
  }

  [[nodiscard]] bool is_given(const std::string& key) const {
    return common_.parameters.contains(key) ||
           std::ranges::any_of(made_.runs.front().parameters,
                               [&](const auto& one) { return one.first == key; });
  }

  /// Latest time of a job that is compared.
  [[nodiscard]] double find_end() const {
    double end = 0.0;
    for (const ReadMeasurement& one : read_) {
      for (const std::size_t run : one.runs) {
        MeasuredSignal times;
        times.t = one.measurement.runs[run].time_s;
        times.fitted = one.fitted;
        times.held_back = one.held_back;
        for (const Samples which : {Samples::kFitted, Samples::kHeldBack})
          for (const std::size_t k : select_samples(times, which))
            end = std::max(end, times.t[k] + one.time_shift_s);
      }
    }
    return end - delay_limits().from;
  }

  /// Least and largest delay of any sensor that the fit may find; 0 to 0 without one.
  [[nodiscard]] Span delay_limits() const {
    Span limits;
    for (const FitParameter& parameter : made_.parameters) {
      if (parameter.sensor != SensorQuantity::kDelay) continue;
      limits.from = std::min(limits.from, parameter.span.from);
      limits.to = std::max(limits.to, parameter.span.to);
    }
    return limits;
  }

  void set_job_times() {
    ordered_json& parameters = made_.common_sweep["parameters"];
    if (parameters.is_null()) parameters = ordered_json::object();
    const double measured_rate = even_rate(measured_run(0).time_s);
    const double rate = measured_rate > 0.0 && measured_rate <= 1e5
                            ? measured_rate * std::ceil(std::min(kLeastRate / measured_rate, 1e3))
                            : kUnevenRate;
    if (!is_given("output_rate_hz")) parameters["output_rate_hz"] = rate;
    if (keeps_metrics_alone(parameters))
      fault("/parameters" + pointer_token(kKeepKey), std::string(kNeedsTrajectories));

    if (!is_given("duration_s"))
      parameters["duration_s"] = std::stod(number_text((std::ceil(find_end() * rate - 1e-6) + 2.0) / rate));
    common_.parameters = parameters;
  }

  /// Completes the parameters of each run at the start of the search.
  void complete_runs() {
    const FitPoint start = jobs::start_of(made_);
    for (std::size_t k = 0; k < made_.runs.size(); ++k) {
      try {
        completed_.push_back(
            complete_parameters(parameters_of_case(common_.parameters, case_of(made_, k, start)), ""));
      } catch (const InvalidRequest& invalid) {
        refuse_run(k, invalid);
      }
    }
  }

  void add_signals(const ReadMeasurement& one) {
    for (const std::size_t run : one.runs) {
      const std::size_t index = next_run_++;
      const auto job_channels = channel_table(to_job_spec(completed_[index]));
      const auto is_in_jobs = [&](const std::string& name) {
        return std::ranges::find(job_channels, name, &engine::QuantityInfo::key) != job_channels.end();
      };
      bool any = false;
      for (std::size_t c = 0; c < one.measurement.channels.size(); ++c) {
        const MeasuredChannel& channel = one.measurement.channels[c];
        if (!one.channels.empty() && !one.channels.contains(channel.name)) continue;
        if (!is_in_jobs(channel.name)) {
          if (one.channels.contains(channel.name))
            fault(one.pointer + "/channels" + pointer_token(channel.name), "is no channel of these jobs");
          continue;
        }
        any = true;
        add_signal(one, run, index, c);
      }
      if (!any) {
        fault(one.pointer, "has no channel that the jobs of run " + std::to_string(run) +
                               " have, too: name measured channels as those of a trajectory");
      }
    }
  }

  void add_signal(const ReadMeasurement& one, std::size_t run, std::size_t index, std::size_t column) {
    const MeasuredChannel& channel = one.measurement.channels[column];
    const MeasuredRun& samples = one.measurement.runs[run];
    FitSignal signal;
    signal.run = index;
    signal.channel = channel.name;
    const Span delays = delay_limits();
    const double job_end = completed_[index].at("duration_s").get<double>();
    for (std::size_t k = 0; k < samples.time_s.size(); ++k) {
      const double t = samples.time_s[k] + one.time_shift_s - channel.delay_s;
      if (t - delays.to < 0.0 || t - delays.from > job_end) continue;
      signal.measured.t.push_back(t);
      signal.measured.y.push_back(channel.sign * channel.gain * samples.columns[column][k] + channel.offset);
    }
    const auto shifted = [&](std::vector<TimeWindow> windows) {
      for (TimeWindow& window : windows) {
        window.from_s += one.time_shift_s - channel.delay_s;
        window.to_s += one.time_shift_s - channel.delay_s;
      }
      return windows;
    };
    constexpr double kNever = std::numeric_limits<double>::infinity();
    signal.measured.fitted = shifted(one.fitted);
    signal.measured.held_back = shifted(one.held_back);
    // The steady window: what comes before depends on how the machine was started.
    const double steady_from = completed_[index].at("run_up_s").get<double>();
    if (one.fitted.empty()) signal.measured.fitted = {{.from_s = steady_from, .to_s = kNever}};
    if (one.held_back_runs.contains(run)) {
      auto& held_back = signal.measured.held_back;
      held_back.insert(held_back.end(), signal.measured.fitted.begin(), signal.measured.fitted.end());
      signal.measured.fitted = {{.from_s = kNever, .to_s = kNever}};
    }
    if (channel.low_pass_hz) {
      signal.sensor.order = LowPassOrder::kSecond;
      signal.sensor.cutoff_hz = *channel.low_pass_hz;
    }
    const json options = one.channels.contains(channel.name) ? one.channels.at(channel.name) : json::object();
    set_scale(signal, options, one.pointer + "/channels" + pointer_token(channel.name));
    signal.cycle_s = cycle_of(index, signal);
    made_.signals.push_back(std::move(signal));
  }

  void set_scale(FitSignal& signal, const json& options, const std::string& pointer) {
    const auto fitted = select_samples(signal.measured, Samples::kFitted);
    double mean = 0.0;
    double squares = 0.0;
    for (const std::size_t k : fitted) mean += signal.measured.y[k] / static_cast<double>(fitted.size());
    for (const std::size_t k : fitted) squares += std::pow(signal.measured.y[k] - mean, 2);
    double sigma = 1.0;
    if (options.contains("noise")) sigma = options.at("noise").get<double>();
    else if (squares > 0.0) sigma = std::sqrt(squares / static_cast<double>(fitted.size()));
    else if (!fitted.empty()) fault(pointer, "does not vary: give its noise");
    std::vector<double> samples;
    for (const std::size_t k : fitted) samples.push_back(signal.measured.y[k]);
    if (options.contains("noise")) signal.noise = sigma;
    else if (samples.size() > kFewestForNoise) signal.noise = estimate_noise(samples);
    signal.weight = options.value("weight", 1.0);
    signal.measured.sigma = sigma / signal.weight;
    if (!std::isnormal(*signal.measured.sigma))
      fault(pointer, "has samples, a noise or a weight whose squares are no numbers");
  }

  [[nodiscard]] double cycle_of(std::size_t run, const FitSignal& signal) const {
    const json& velocity = value_at_path(completed_[run], "crank_velocity_rad_s");
    const auto fitted = select_samples(signal.measured, Samples::kFitted);
    const double length =
        fitted.empty() ? 0.0 : signal.measured.t[fitted.back()] - signal.measured.t[fitted.front()];
    const bool turns = velocity.is_number() && std::abs(velocity.get<double>()) > 0.0 &&
                       !common_.parameters.contains("crank_drive");
    const double turn = turns ? 2.0 * std::numbers::pi / std::abs(velocity.get<double>()) : length;
    return 2.0 * turn < length ? turn : length / kCyclesOfOther;
  }

  /// Thins the samples that are compared.
  void check_signals() {
    std::size_t samples = 0;
    for (const FitSignal& signal : made_.signals)
      samples += select_samples(signal.measured, Samples::kFitted).size();
    if (samples <= made_.parameters.size())
      return fault("/measurements",
                   "have " + std::to_string(samples) +
                       " samples to be fitted between 0 s and the end of the jobs; more than " +
                       std::to_string(made_.parameters.size()) + " are needed");
    made_.thinning = (samples + most_samples_ - 1) / most_samples_;
    for (FitSignal& signal : made_.signals) {
      signal.compared.sigma = signal.measured.sigma;
      const auto fitted = select_samples(signal.measured, Samples::kFitted);
      for (std::size_t i = 0; i < fitted.size(); i += made_.thinning) {
        signal.compared.t.push_back(signal.measured.t[fitted[i]]);
        signal.compared.y.push_back(signal.measured.y[fitted[i]]);
      }
    }
  }

  /// A parameter of a sensor or of one run needs samples that are fitted.
  void check_places() {
    for (const FitParameter& parameter : made_.parameters) {
      const auto tells = [&](const FitSignal& signal) {
        return !signal.compared.t.empty() && (!parameter.sensor || signal.channel == parameter.name) &&
               signal.run == parameter.run.value_or(signal.run);
      };
      if (std::ranges::none_of(made_.signals, tells))
        fault("/over" + pointer_token(parameter.path), "has no sample that is fitted");
    }
    if (made_.basis == FitBasis::kFeatures && made_.signals.front().compared.t.size() < kFewestForNoise)
      fault("/basis", "\"features\" need more samples than there are");
  }

  void check_size() {
    std::size_t fitted = 0;
    for (std::size_t run = 0; run < made_.runs.size(); ++run) fitted += is_fitted(made_, run) ? 1 : 0;
    std::uint64_t jobs = 0;
    if (__builtin_mul_overflow(made_.budget, fitted, &jobs) || jobs + made_.runs.size() > max_jobs_)
      fault("/budget", "makes " + std::to_string(jobs) + " jobs, one for each of " + std::to_string(fitted) +
                           " fitted runs and each point; at most " + std::to_string(max_jobs_) +
                           " are allowed");
  }

  const FindMeasurement& find_measurement_;
  std::size_t max_jobs_;
  FitProblem made_;
  SweepRequest common_;
  std::vector<std::string> ids_;  ///< of read_
  std::vector<ReadMeasurement> read_;
  std::vector<json> completed_;  ///< parameters of each run
  std::size_t most_samples_ = 0;
  std::size_t next_run_ = 0;
};

}  // namespace

FitProblem parse_fit_request(const ordered_json& request, const FindMeasurement& find_measurement,
                             std::size_t max_jobs) {
  return FitParser(request, find_measurement, max_jobs).parse();
}

}  // namespace jobs
