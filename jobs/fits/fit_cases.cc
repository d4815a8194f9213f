// SPDX-License-Identifier: Apache-2.0
#include "jobs/fits/fit_cases.h"

#include <algorithm>

#include "jobs/parameters/unit_scale.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/statistics/splitmix64.h"

namespace jobs {
namespace {

using nlohmann::ordered_json;

}  // namespace

std::vector<Span> spans_of(const FitProblem& problem) {
  std::vector<Span> spans;
  for (const FitParameter& parameter : problem.parameters) spans.push_back(parameter.span);
  return spans;
}

std::vector<std::string> names_of(const FitProblem& problem) {
  std::vector<std::string> names;
  for (const FitParameter& parameter : problem.parameters) names.push_back(parameter.path);
  return names;
}

FitPoint point_at(const FitProblem& problem, const std::vector<double>& parts) {
  FitPoint point;
  for (std::size_t i = 0; i < parts.size(); ++i)
    point.push_back(decimal_between(problem.parameters[i].span, parts[i], kSearchSteps));
  return point;
}

FitPoint start_of(const FitProblem& problem) {
  FitPoint point = point_at(problem, std::vector<double>(problem.parameters.size(), 0.5));
  for (std::size_t i = 0; i < point.size(); ++i) point[i] = problem.parameters[i].start.value_or(point[i]);
  return point;
}

FitPoint replicate_of(const FitProblem& problem, const FitPoint& point, std::size_t k) {
  FitPoint beside = point;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const Span& span = problem.parameters[i].span;
    const std::uint64_t random = splitmix64(problem.seed, k * point.size() + i);
    const double shift = kReplicateShift * (static_cast<double>(random >> 11U) * 0x1p-52 - 1.0);
    const double part = part_at(span, point[i]);
    beside[i] = value_at(span, part + shift <= 1.0 && part + shift >= 0.0 ? part + shift : part - shift);
  }
  return beside;
}

bool is_fitted(const FitProblem& problem, std::size_t run) {
  return std::ranges::any_of(problem.signals, [&](const FitSignal& signal) {
    return signal.run == run && !signal.compared.t.empty();
  });
}

ordered_json case_of(const FitProblem& problem, std::size_t run, const FitPoint& point) {
  ordered_json made = ordered_json::object();
  for (const auto& [path, value] : problem.runs[run].parameters) set_in_case(made, path, value);
  for (std::size_t i = 0; i < point.size(); ++i) {
    const FitParameter& parameter = problem.parameters[i];
    if (parameter.sensor || parameter.run.value_or(run) != run) continue;
    set_in_case(made, parameter.name, point[i]);
  }
  return made;
}

SensorModel sensor_of(const FitProblem& problem, const FitSignal& signal, const FitPoint& point) {
  SensorModel sensor = signal.sensor;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const FitParameter& parameter = problem.parameters[i];
    if (!parameter.sensor || parameter.name != signal.channel) continue;
    switch (*parameter.sensor) {
      case SensorQuantity::kGain:
        sensor.gain = point[i];
        break;
      case SensorQuantity::kOffset:
        sensor.offset = point[i];
        break;
      case SensorQuantity::kDelay:
        sensor.delay_s = point[i];
        break;
    }
  }
  return sensor;
}

}  // namespace jobs
