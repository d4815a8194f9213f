// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>

#include "engine/simulate.h"
#include "engine/simulate_rpsup.h"
#include "validation/support/quiet_observer.h"
#include "tests/bench/parts/register_parts.h"
#include "tests/bench/support/cases.h"
#include "tests/bench/support/integrators.h"

namespace bench {

namespace {

using engine::Coupler;
using engine::RpsupParameters;
using engine::RunOptions;

/// A run by steps alone, without results: what a step costs.
void take_steps(benchmark::State& run, const engine::Mechanism& mechanism, const RunOptions& options) {
  validation::QuietObserver observer;
  double steps = 0.0;
  double evaluations = 0.0;
  for (auto _ : run) {
    const engine::RunOutcome end = engine::simulate(mechanism, options, observer);
    if (end.status != engine::RunStatus::kSucceeded) run.SkipWithError(end.detail.c_str());
    steps += static_cast<double>(end.steps);
    evaluations += static_cast<double>(end.evaluations);
  }
  using benchmark::Counter;
  run.counters["s_per_step"] = Counter(steps, Counter::kIsRate | Counter::kInvert);
  run.counters["evaluations_per_step"] = evaluations / steps;
}

/// The same motion of a linkage that fits no topology of compile-time constants, so that the engine visits
/// its joints in loops: the journal's frame turned about its axis.
engine::Mechanism turn_journal(engine::Mechanism mechanism) {
  Eigen::Matrix3d& R = mechanism.cut_joints.front().journal.R;
  R = R * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return mechanism;
}

/// A whole job, all channels and metrics.
void run_job(benchmark::State& run, const RpsupParameters& parameters, const RunOptions& options) {
  for (auto _ : run) {
    const engine::RunResult result = engine::simulate_rpsup(parameters, options, {});
    if (result.status != engine::RunStatus::kSucceeded) run.SkipWithError(result.detail.c_str());
  }
  using benchmark::Counter;
  run.counters["s_per_simulated_s"] =
      Counter(options.duration, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

/// A short run: the crank is at full speed after half of it.
RpsupParameters hurried(RpsupParameters parameters, double duration) {
  parameters.run_up = 0.5 * duration;
  return parameters;
}

void register_steps(Coupler coupler, const char* coupler_name) {
  constexpr double kDuration = 0.1;
  const engine::Mechanism mechanism =
      engine::build_rpsup(hurried(linkage(coupler, 0.25e-3, 10.0), kDuration)).mechanism;
  for (const NamedIntegrator& integrator : all_integrators()) {
    RunOptions options{.duration = kDuration, .output_rate = 20.0};
    options.integrator = integrator.integrator;
    const std::string name = "steps/" + integrator.name + "/" + coupler_name;
    for (const auto& [suffix, moved] :
         {std::pair{"", mechanism}, std::pair{"/dynamic_topology", turn_journal(mechanism)}})
      benchmark::RegisterBenchmark(
          (name + suffix).c_str(),
          [=, moved = moved](benchmark::State& run) { take_steps(run, moved, options); })
          ->Unit(benchmark::kMillisecond);
  }
}

constexpr double kJobDuration = 0.5;  // [s]

void register_job(const std::string& name, const RpsupParameters& parameters) {
  benchmark::RegisterBenchmark(
      ("job/" + name).c_str(),
      [=](benchmark::State& run) { run_job(run, parameters, {.duration = kJobDuration}); })
      ->Unit(benchmark::kMillisecond);
}

/// The rigid linkage with clearance; a controller of the velocity moves the crank, by a torque or by a motor.
void register_actuated_jobs() {
  RpsupParameters parameters = hurried(linkage(Coupler::kRigid, 0.25e-3, 10.0), kJobDuration);
  const engine::DriveLaw run_up = engine::RunUp{.omega = 10.0, .run_up = parameters.run_up};
  parameters.crank_actuator =
      engine::Controller{.target = run_up, .proportional = 200.0, .integral = 2000.0};
  register_job("rigid/controller", parameters);
  parameters.crank_actuator =
      engine::DcMotor{.voltage = engine::Controller{.target = run_up, .proportional = 40.0, .integral = 400.0},
                      .torque_constant = 0.5,
                      .resistance = 0.5,
                      .inductance = 1e-3,
                      .gear_ratio = 20.0,
                      .rotor_inertia = 1e-3};
  register_job("rigid/motor", parameters);
}

}  // namespace

void register_runs() {
  for (const auto& [coupler, name] :
       {std::pair{Coupler::kRigid, "rigid"}, std::pair{Coupler::kFlexible, "flexible"}}) {
    register_steps(coupler, name);
    for (const auto& [c_r, joint] : {std::pair{0.25e-3, "clearance"}, {0.0, "ideal"}})
      register_job(name + std::string("/") + joint, hurried(linkage(coupler, c_r, 10.0), kJobDuration));
  }
  register_actuated_jobs();
}

}  // namespace bench
