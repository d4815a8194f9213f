// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_json.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "jobs/base/optional_json.h"
#include "jobs/fits/fit_cases.h"
#include "jobs/results/resource_json.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr const char* kFitRoute = "/v1/fits/";

json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

json basis_json(const std::optional<FitBasis>& basis) {
  if (!basis) return nullptr;
  return *basis == FitBasis::kPointWise ? "point_wise" : "features";
}

/// Interval by the linearised model; null where there is none.
json linear_json(const FitSummary& summary, std::size_t i) {
  if (!summary.intervals) return nullptr;
  const Estimate& interval = summary.intervals->parameters[i];
  return {{"low", finite_or_null(interval.low)}, {"high", finite_or_null(interval.high)}};
}

json profile_end_json(const ProfileEnd& end) {
  return end.verdict == ProfileVerdict::kFound ? json(end.value) : json();
}

json profile_json(const FitSummary& summary, std::size_t i) {
  if (!summary.profiles) return nullptr;
  const ProfileInterval& interval = (*summary.profiles)[i];
  return {{"low", profile_end_json(interval.low)}, {"high", profile_end_json(interval.high)}};
}

json range_json(const FitSummary& summary, std::size_t i) {
  if (summary.ranges.empty()) return nullptr;
  return {{"low", summary.ranges[i].low}, {"high", summary.ranges[i].high}};
}

/// @returns empty if an end of the profile was not found, so that nothing tells
std::optional<bool> is_identified(const FitSummary& summary, const Span& span, std::size_t i) {
  if (!summary.intervals || !std::isfinite(summary.intervals->deviations[static_cast<Eigen::Index>(i)]))
    return false;
  if (summary.basis == FitBasis::kFeatures && !summary.ranges.empty())
    return is_decided(summary.ranges[i], span);
  if (!summary.profiles) return true;
  const ProfileInterval& interval = (*summary.profiles)[i];
  const auto has_end = [&](ProfileVerdict verdict) {
    return interval.low.verdict == verdict || interval.high.verdict == verdict;
  };
  if (has_end(ProfileVerdict::kFound)) return true;
  return has_end(ProfileVerdict::kLost) ? std::nullopt : std::optional(false);
}

/// Null where a larger budget, or jobs that do not fail, might tell.
json identified_json(const FitSummary& summary, const Span& span, std::size_t i) {
  if (!summary.intervals) return nullptr;
  const std::optional<bool> identified = is_identified(summary, span, i);
  return identified == false && summary.budget_ended_local ? json() : value_or_null(identified);
}

json parameters_json(const FitProblem& problem, const FitSummary& summary) {
  json made = json::array();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const FitParameter& parameter = problem.parameters[i];
    json one{{"path", parameter.path},
             {"value", summary.best ? json(summary.points[*summary.best].point[i]) : json()},
             {"linearised", linear_json(summary, i)},
             {"profile", profile_json(summary, i)},
             {"range", range_json(summary, i)},
             {"identified", identified_json(summary, parameter.span, i)},
             {"from", parameter.span.from},
             {"to", parameter.span.to}};
    made.push_back(std::move(one));
  }
  return made;
}

json correlation_json(const FitSummary& summary) {
  if (!summary.intervals) return nullptr;
  const Eigen::MatrixXd& correlation = summary.intervals->correlation;
  json rows = json::array();
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index k = 0; k < correlation.cols(); ++k) row.push_back(finite_or_null(correlation(i, k)));
    rows.push_back(std::move(row));
  }
  return rows;
}

json error_json(const std::optional<SignalError>& error) {
  if (!error) return nullptr;
  return {{"samples", error->samples},
          {"rms", error->rms},
          {"relative_rms", value_or_null(error->relative_rms)},
          {"measured_peak", error->measured_peak},
          {"predicted_peak", error->predicted_peak}};
}

json signals_json(const FitProblem& problem, const FitSummary& summary) {
  json made = json::array();
  for (const SignalSummary& one : summary.signals) {
    const FitSignal& signal = problem.signals[one.signal];
    const FitRun& run = problem.runs[signal.run];
    made.push_back({{"measurement_id", run.measurement_id},
                    {"run", run.number},
                    {"channel", signal.channel},
                    {"fitted", error_json(one.fitted)},
                    {"held_back", error_json(one.held_back)}});
  }
  return made;
}

json first_of(const json& ids) { return ids.empty() ? json() : ids.front(); }

/// Ids of the jobs that there are.
json ids_of_jobs(const FitPointSummary& point) {
  json ids = json::array();
  for (const std::string& id : point.job_ids)
    if (!id.empty()) ids.push_back(id);
  return ids;
}

json best_json(const FitSummary& summary) {
  if (!summary.best) return nullptr;
  const FitPointSummary& best = summary.points[*summary.best];
  return {
      {"point", *summary.best}, {"sum_of_squares", value_or_null(best.sum)}, {"job_ids", ids_of_jobs(best)}};
}

json counts_of_points(const FitSummary& summary) {
  json counts{{"pending", 0}, {"succeeded", 0}, {"lost", 0}};
  for (const FitPointSummary& point : summary.points) {
    json& count = counts.at(std::string(state_name(point.state)));
    count = count.get<std::size_t>() + 1;
  }
  return counts;
}

json divergence_json(const std::optional<SignalDivergence>& divergence) {
  if (!divergence) return nullptr;
  return {{"ratio", finite_or_null(divergence->ratio)}, {"message", divergence->message}};
}

json ids_of_measurements(const nlohmann::ordered_json& request) {
  json ids = json::array();
  for (const auto& one : request.at("measurements")) ids.push_back(json(one.at("id")));
  return ids;
}

/// Use of each sample.
std::vector<const char*> uses_of(const MeasuredSignal& measured) {
  std::vector<const char*> uses(measured.t.size(), "unused");
  for (const std::size_t k : select_samples(measured, Samples::kFitted)) uses[k] = "fitted";
  for (const std::size_t k : select_samples(measured, Samples::kHeldBack)) uses[k] = "held_back";
  return uses;
}

/// Sentences on all that a reader of the values must know.
json remarks_json(const FitProblem& problem, const FitSummary& summary) {
  json remarks = summary.remarks;
  if (!summary.intervals) return remarks;
  if (summary.budget_ended_local) {
    remarks.push_back(
        "The budget ended the fit on its way: a larger one may find better values, and tell parameters that "
        "have no interval yet.");
    return remarks;
  }
  const std::vector<std::string> names = names_of(problem);
  for (std::string& sentence : describe_unidentifiable(names, *summary.intervals))
    remarks.push_back(std::move(sentence));
  for (std::size_t i = 0; summary.profiles && i < names.size(); ++i) {
    for (const ProfileEnd& end : {(*summary.profiles)[i].low, (*summary.profiles)[i].high})
      if (!end.message.empty()) remarks.push_back(names[i] + ": " + end.message);
  }
  return remarks;
}

}  // namespace

json fit_summary_json(const StudyRow& row) {
  const auto request = nlohmann::ordered_json::parse(row.request);
  json paths = json::array();
  for (const auto& [path, span] : request.at("over").items()) paths.push_back(path);
  json made = study_json(row, kFitRoute);
  made.update({{"variables", std::move(paths)}, {"measurement_ids", ids_of_measurements(request)}});
  made["links"]["signals"] = kFitRoute + row.id + "/signals";
  return made;
}

const std::vector<std::string>& fit_listing_keys() {
  static const std::vector<std::string> keys = [] {
    StudyRow row;
    row.request = R"({"over": {}, "measurements": []})";
    return keys_of(fit_summary_json(row));
  }();
  return keys;
}

json fit_json(const StudyRow& row, const FitProblem& problem, const FitSummary& summary,
              const SweepResults& results, int threads) {
  json made = fit_summary_json(row);
  made["budget"] = problem.budget;
  made["thinning"] = problem.thinning;
  made["counts"] = progress_json(results.sweep, threads).at("counts");
  made["progress"] =
      row.state == "running"
          ? std::min(1.0, static_cast<double>(summary.points.size()) / static_cast<double>(problem.budget))
          : 1.0;
  made["stage"] = stage_name(summary.stage);
  made["points"] = counts_of_points(summary);
  made["basis"] = basis_json(summary.basis);
  made["divergence"] = divergence_json(summary.divergence);
  made["best"] = best_json(summary);
  made["parameters"] = parameters_json(problem, summary);
  made["correlation"] = correlation_json(summary);
  made["signals"] = signals_json(problem, summary);
  made["local_end"] = value_or_null(summary.local_end);
  made["remarks"] = remarks_json(problem, summary);
  made["request"] = json::parse(row.request);
  return made;
}

const std::vector<std::string>& fit_point_columns() {
  static const std::vector<std::string> columns{"point",       "stage",          "state",
                                                "lost_reason", "sum_of_squares", "job_id"};
  return columns;
}

ResultTable fit_point_table(const StudyRow& row, const FitProblem& problem, const FitSummary& summary) {
  ResultTable table{.columns = fit_point_columns(), .rows = {}, .ended = row.state != "running"};
  for (const FitParameter& parameter : problem.parameters) table.columns.push_back(parameter.path);
  for (const FitPointSummary& point : summary.points) {
    std::vector<json> cells{table.rows.size(),        stage_name(point.stage),
                            state_name(point.state),  value_or_null(point.lost_reason),
                            value_or_null(point.sum), first_of(ids_of_jobs(point))};
    cells.insert(cells.end(), point.point.begin(), point.point.end());
    table.rows.push_back(std::move(cells));
  }
  return table;
}

namespace {

void add_signal_rows(const FitRun& run, const FitSignal& signal, const Prediction& prediction,
                     ResultTable& table) {
  const std::vector<const char*> uses = uses_of(signal.measured);
  const std::size_t step = (uses.size() + kMostSignalRows - 1) / kMostSignalRows;
  for (std::size_t k = 0; k < uses.size(); k += step) {
    const double measured = prediction.measured[k];
    const double predicted = prediction.predicted[k];
    table.rows.push_back({run.measurement_id, run.number, signal.channel, uses[k], prediction.t[k], measured,
                          predicted, predicted - measured});
  }
}

}  // namespace

const std::vector<std::string>& fit_signal_columns() {
  static const std::vector<std::string> columns{"measurement_id", "run",       "channel", "use", "t_s",
                                                "measured",       "predicted", "residual"};
  return columns;
}

ResultTable fit_signal_table(const StudyRow& row, const FitObserver& observer, const FitSummary& summary) {
  const FitProblem& problem = observer.problem();
  ResultTable table{.columns = fit_signal_columns(), .rows = {}, .ended = row.state != "running"};
  if (!summary.best) return table;
  const FitPointSummary& best = summary.points[*summary.best];
  for (const FitSignal& signal : problem.signals) {
    const auto prediction = observer.predict(signal, best.point, best.job_ids);
    if (prediction) add_signal_rows(problem.runs[signal.run], signal, *prediction, table);
  }
  return table;
}

}  // namespace jobs
