// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/our_jobs.h"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "tests/bench/support/contact_state.h"
#include "tests/bench/support/cpu_time.h"

namespace bench {

namespace {

CodeRun take_run(const engine::RunResult& run, std::span<const engine::QuantityInfo> metrics,
                 const std::string& peak) {
  if (run.status != engine::RunStatus::kSucceeded) throw std::runtime_error("a run failed: " + run.detail);
  const auto value = [&](const std::string& key) {
    return run.metrics.at(static_cast<std::size_t>(
        std::ranges::find(metrics, key, &engine::QuantityInfo::key) - metrics.begin()));
  };
  return {value(peak), static_cast<long>(value("rhs_evaluations"))};
}

/// The engine keeps the drives' motion at the last instants: each call gets one that is not among them.
template <typename Evaluate>
double time_at_new_instants(const Evaluate& evaluate) {
  constexpr int kInstants = 8;
  constexpr double kApart = 1e-9;  // [s]
  int k = 0;
  return time_short([&] { evaluate(kApart * static_cast<double>(k++ % kInstants)); });
}

}  // namespace

CodeRun run_rpsup(const engine::RpsupParameters& parameters, const engine::RunOptions& options) {
  return take_run(engine::simulate_rpsup(parameters, options, {}), engine::metric_table(),
                  "peak_slider_acceleration_m_s2");
}

CodeRun run_linkage(const engine::Linkage& linkage, const std::string& measured,
                    const engine::RunOptions& options) {
  return take_run(engine::simulate_linkage(linkage, options, 0.0, {}),
                  engine::linkage_tables(linkage).metrics, "peak_" + measured + "_acceleration_rad_s2");
}

double time_rpsup_evaluation(const engine::RpsupParameters& parameters, std::string_view instruction_set) {
  ContactState state(parameters, instruction_set);
  return time_at_new_instants([&state](double t) { state.evaluate(t); });
}

double time_evaluation(const engine::Mechanism& mechanism, std::string_view instruction_set) {
  engine::MotionSystem system(mechanism, instruction_set);
  const Coordinates at = assemble(mechanism);
  const Eigen::VectorXd y = system.make_state(at.q, at.qd);
  Eigen::VectorXd dydt = Eigen::VectorXd::Zero(y.size());
  return time_at_new_instants([&](double t) { (void)system.calc_derivative(t, y, dydt); });
}

}  // namespace bench
