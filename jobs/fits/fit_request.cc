// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_request.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "jobs/fits/fit_cases.h"
#include "jobs/fits/fit_signals.h"
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
/// Cycles in a signal whose drive has no period.
constexpr double kCyclesOfOther = 8.0;

/// Reader of one request; a member function a part of it.
class FitParser : private FittedMeasurementsParser {
 public:
  FitParser(const ordered_json& request, const FindMeasurement& find_measurement, std::size_t max_jobs)
      : FittedMeasurementsParser(request, find_measurement), max_jobs_(max_jobs) {}

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
    for (const FittedMeasurement& one : measurements_) add_signals(one);
    throw_if_faulty();
    check_signals();
    if (faults_.empty()) check_places();
    check_size();
    throw_if_faulty();
    return std::move(made_);
  }

 private:
  void read_common() {
    made_.common_sweep = take_keys(request_, kSweepKeys);
    try {
      common_ = parse_sweep_request(made_.common_sweep, max_jobs_);
    } catch (const InvalidRequest& invalid) {
      add_faults(invalid);
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
    read_basis();
    read_intervals();
  }

  void read_basis() {
    const json basis = request_.value("basis", ordered_json("by_divergence"));
    if (basis == "point_wise") made_.basis = FitBasis::kPointWise;
    else if (basis == "features") made_.basis = FitBasis::kFeatures;
    else if (basis != "by_divergence")
      fault("/basis", "must be \"by_divergence\", \"point_wise\" or \"features\"");
  }

  void read_intervals() {
    const json intervals = request_.value("intervals", ordered_json("profile"));
    made_.profiles = intervals == "profile";
    if (intervals != "profile" && intervals != "linearised")
      fault("/intervals", "must be \"profile\" or \"linearised\"");
  }

  void add_runs() {
    for (std::size_t k = 0; k < measurements_.size(); ++k) {
      for (const std::size_t run : measurements_[k].runs)
        made_.runs.push_back({.measurement_id = measurements_[k].id, .number = run});
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
    const auto has_channel = [&](const FittedMeasurement& one) {
      return std::ranges::find(one.measurement.channels, name, &MeasuredChannel::name) !=
                 one.measurement.channels.end() &&
             (one.channels.empty() || one.channels.contains(name));
    };
    if (quantity == kSensorQuantities.end())
      return fault(pointer, "must end in gain, offset or delay_s, sensor.slider_position_m.gain, say");
    if (std::ranges::none_of(measurements_, has_channel))
      return fault(pointer, "names no channel that is compared");
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
                                .name = name,
                                .run = run});
  }

  [[nodiscard]] const MeasuredRun& measured_run(std::size_t run) const {
    std::size_t first = 0;
    for (const FittedMeasurement& one : measurements_) {
      if (run < first + one.runs.size()) return one.measurement.runs[one.runs[run - first]];
      first += one.runs.size();
    }
    throw std::logic_error("a fit has no such run");
  }

  /// Paths that some run has its own value of.
  [[nodiscard]] std::vector<std::string> list_paths_of_runs() const {
    std::vector<std::string> paths;
    const auto add_path = [&](const std::string& path) {
      if (std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
    };
    for (std::size_t k = 0; k < made_.runs.size(); ++k)
      for (const std::string& path : paths_of(ordered_json(measured_run(k).parameters))) add_path(path);
    for (const FitParameter& parameter : made_.parameters)
      if (parameter.run) add_path(parameter.name);
    return paths;
  }

  /// A value has one place: the request or the run.
  void check_parameters_of_run(std::size_t run) {
    const std::vector<std::string> given = paths_of(request_.value("parameters", ordered_json::object()));
    const FitRun& one = made_.runs[run];
    for (const std::string& path : paths_of(ordered_json(measured_run(run).parameters)))
      if (std::ranges::find(given, path) != given.end())
        fault("/parameters" + pointer_of_path(path), "is known of run " + std::to_string(one.number) +
                                                         " of " + one.measurement_id + ": leave it out here");
  }

  /// Gives each run values of all paths that some run has its own value of: rows of a sweep have one list of
  /// paths.
  void add_parameters_of_runs() {
    for (std::size_t k = 0; k < made_.runs.size(); ++k) check_parameters_of_run(k);
    std::vector<std::string> paths = list_paths_of_runs();
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
    for (const FittedMeasurement& one : measurements_) {
      const auto& channels = one.measurement.channels;
      const double least_delay = std::ranges::min(channels, {}, &MeasuredChannel::delay_s).delay_s;
      for (const std::size_t run : one.runs) {
        MeasuredSignal times;
        times.t = one.measurement.runs[run].time_s;
        times.fitted = one.fitted;
        times.held_back = one.held_back;
        for (const Samples which : {Samples::kFitted, Samples::kHeldBack})
          for (const std::size_t k : select_samples(times, which))
            end = std::max(end, times.t[k] + one.time_shift_s - std::min(0.0, least_delay));
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
    const double rate = find_output_rate(measured_run(0).time_s);
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

  void add_signals(const FittedMeasurement& one) {
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

  void add_signal(const FittedMeasurement& one, std::size_t run, std::size_t index, std::size_t column) {
    const SignalSource source{.measurement = one,
                              .run = run,
                              .column = column,
                              .job_parameters = completed_[index],
                              .delays = delay_limits()};
    FitSignal signal = make_fit_signal(source);
    check_is_fitted_once(source, signal);
    is_right(one.pointer + "/channels" + pointer_token(signal.channel), describe_scale_fault(signal));
    signal.run = index;
    signal.cycle_s = cycle_of(index, signal);
    made_.signals.push_back(std::move(signal));
  }

  /// Samples that two entries fit would count twice, and make intervals too narrow.
  void check_is_fitted_once(const SignalSource& source, const FitSignal& signal) {
    const std::vector<double>& times = source.measurement.measurement.runs[source.run].time_s;
    auto& fitted = fitted_[{source.measurement.id, source.run, signal.channel}];
    fitted.resize(times.size());
    for (const std::size_t k : select_samples(signal.measured, Samples::kFitted)) {
      const std::size_t sample = signal.first_sample + k;
      if (fitted[sample])
        return fault(source.measurement.pointer,
                     "fits run " + std::to_string(source.run) + " of " + source.measurement.id + " at " +
                         number_text(times[sample]) + " s, as another entry does");
      fitted[sample] = true;
    }
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

  void check_signals() {
    std::size_t samples = 0;
    for (const FitSignal& signal : made_.signals)
      samples += select_samples(signal.measured, Samples::kFitted).size();
    if (samples <= made_.parameters.size())
      return fault("/measurements", "have " + std::to_string(samples) +
                                        " samples to be fitted; more than " +
                                        std::to_string(made_.parameters.size()) + " are needed" +
                                        describe_fitted_samples());
    made_.thinning = (samples + most_samples_ - 1) / most_samples_;
    thin_signals();
  }

  /// Description of the fitted samples, as the rest of a sentence.
  [[nodiscard]] std::string describe_fitted_samples() const {
    const auto time = [&](const char* key) {
      return number_text(completed_.front().at(key).get<double>()) + " s";
    };
    const bool by_default =
        std::ranges::any_of(measurements_, [](const FittedMeasurement& one) { return one.fitted.empty(); });
    const std::string rest = " that are not held back and come before the jobs' end, " + time("duration_s");
    if (!by_default) return ": fitted are those in the windows of \"fitted\"" + rest;
    return ": fitted are those from run_up_s, " + time("run_up_s") + ", on" + rest +
           "; give another run_up_s, or windows in \"fitted\"";
  }

  /// Chooses the samples that are compared.
  void thin_signals() {
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

  std::size_t max_jobs_;
  FitProblem made_;
  SweepRequest common_;
  std::vector<json> completed_;  ///< parameters of each run
  /// Marks of the fitted samples, by measurement, run and channel.
  std::map<std::tuple<std::string, std::size_t, std::string>, std::vector<bool>> fitted_;
  std::size_t most_samples_ = 0;
  std::size_t next_run_ = 0;
};

}  // namespace

FitProblem parse_fit_request(const ordered_json& request, const FindMeasurement& find_measurement,
                             std::size_t max_jobs) {
  return FitParser(request, find_measurement, max_jobs).parse();
}

}  // namespace jobs
