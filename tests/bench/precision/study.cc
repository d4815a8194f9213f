// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/precision/study.h"

#include <cmath>
#include <limits>
#include <utility>

#include "engine/simulate_rpsup.h"
#include "validation/support/runs.h"
#include "tests/bench/support/cases.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/integrators.h"
#include "tests/bench/support/table.h"

namespace bench {

namespace {

using engine::Coupler;

constexpr double kDuration = 4.0;  // [s]

PrecisionCase make_case(CaseKind kind, Coupler coupler, double clearance_mm, double omega) {
  return {std::string(coupler == Coupler::kRigid ? "rigid" : "flexible") + " " + digits(clearance_mm, 3) +
              " mm " + digits(omega, 3) + " rad/s",
          kind, linkage(coupler, 1e-3 * clearance_mm, omega)};
}

engine::RunOptions make_options(engine::Integrator integrator) {
  engine::RunOptions options{.duration = kDuration};
  options.integrator = integrator;
  return options;
}

engine::RunOptions with_tolerance(engine::RunOptions options, double relative) {
  options.relative_tolerance = relative;
  options.absolute_tolerance = relative;
  return options;
}

engine::RunOptions with_step(engine::RunOptions options, double step) {
  options.step = step;
  return options;
}

}  // namespace

std::vector<PrecisionCase> precision_cases() {
  std::vector<PrecisionCase> cases;
  for (const double clearance : {0.25, 0.5}) {
    for (const double omega : {5.0, 10.0, 12.0, 15.0})
      cases.push_back(make_case(CaseKind::kKnown, Coupler::kRigid, clearance, omega));
    cases.push_back(make_case(CaseKind::kKnown, Coupler::kFlexible, clearance, 5.0));
  }
  for (const auto& [clearance, omega] :
       {std::pair{0.15, 9.0}, {0.2, 11.0}, {0.35, 7.0}, {0.35, 9.0}, {0.35, 11.0}, {0.35, 14.0}})
    cases.push_back(make_case(CaseKind::kFresh, Coupler::kRigid, clearance, omega));
  for (const auto& [clearance, omega] : {std::pair{0.15, 4.0}, {0.35, 4.5}})
    cases.push_back(make_case(CaseKind::kFresh, Coupler::kFlexible, clearance, omega));
  return cases;
}

std::vector<Setting> precision_settings() {
  std::vector<Setting> settings;
  for (const NamedIntegrator& integrator : all_integrators()) {
    const engine::RunOptions options = make_options(integrator.integrator);
    if (integrator.has_fixed_step())
      for (const double step : {1e-5, 5e-6, 2.5e-6})
        settings.push_back({integrator.name, step, with_step(options, step)});
    else
      for (const double tolerance : {3e-4, 1e-4, 3e-5, 7.5e-6, 1e-6, 1e-7})
        settings.push_back({integrator.name, tolerance, with_tolerance(options, tolerance)});
  }
  return settings;
}

double find_reference_peak(const PrecisionCase& what) {
  const engine::RunOptions options = with_tolerance(make_options(engine::Integrator::kDopri5), 1e-9);
  return validation::metric(validation::run_rpsup(what.parameters, options), "peak_slider_acceleration_m_s2");
}

Measurement measure(const PrecisionCase& what, const Setting& setting, double reference_peak) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  engine::RunResult run;
  const double seconds =
      time_cpu([&] { run = engine::simulate_rpsup(what.parameters, setting.options, {}); });
  if (run.status != engine::RunStatus::kSucceeded) return {&what, &setting, seconds, kNone, kNone, kNone};
  const double peak = validation::metric(run, "peak_slider_acceleration_m_s2");
  return {&what,   &setting,
          seconds, validation::metric(run, "rhs_evaluations"),
          peak,    std::abs(peak / reference_peak - 1.0)};
}

}  // namespace bench
