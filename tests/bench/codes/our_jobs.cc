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

double time_rpsup_evaluation(const engine::RpsupParameters& parameters) {
  ContactState state(parameters);
  return time_short([&state] { state.evaluate(); });
}

double time_evaluation(const engine::Mechanism& mechanism) {
  engine::MotionSystem system(mechanism);
  const Coordinates at = assemble(mechanism);
  const Eigen::VectorXd y = system.make_state(at.q, at.qd);
  Eigen::VectorXd dydt = Eigen::VectorXd::Zero(y.size());
  return time_short([&] { (void)system.calc_derivative(0.0, y, dydt); });
}

}  // namespace bench
