#include "engine/analysis/ideal_peak.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <boost/math/tools/minima.hpp>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"

namespace engine {

namespace {

constexpr double kInterval = 1e-3;  // [s] between the samples among which the extremes are looked for
constexpr double kContender = 0.99; // a sampled extreme above this part of the largest may be the true one

}  // namespace

std::optional<Peak> find_ideal_peak(const RpsupParameters& parameters, double from, double to) {
  if (!(from < to)) return std::nullopt;
  const Rpsup ideal = build_ideal_rpsup(parameters);
  LoopClosure closure(ideal.mechanism);
  Evaluation at = MotionSystem(ideal.mechanism).make_evaluation();
  // Onwards from the start: the branch on which the linkage is assembled is known there.
  bool closed = closure.assemble(0.0, at);
  const auto skipped = static_cast<long>(std::ceil(from / kInterval));
  for (long k = 1; closed && k < skipped; ++k) closed = closure.solve(static_cast<double>(k) * from / static_cast<double>(skipped), at);

  const auto intervals = std::max(2L, static_cast<long>(std::ceil((to - from) / kInterval)));
  const auto time_of = [&](long k) { return from + (to - from) * static_cast<double>(k) / static_cast<double>(intervals); };
  std::vector<double> sampled;
  std::vector<Eigen::VectorXd> positions;
  for (long k = 0; closed && k <= intervals; ++k) {
    closed = closure.solve(time_of(k), at);
    sampled.push_back(std::abs(at.qdd[ideal.layout.slider]));
    positions.push_back(at.q);
  }
  if (!closed) return std::nullopt;

  Peak peak;
  const double largest = *std::max_element(sampled.begin(), sampled.end());
  for (std::size_t k = 0; k < sampled.size(); ++k) {
    const auto i = static_cast<long>(k);
    peak.take(sampled[k], time_of(i));
    const bool extreme = k > 0 && k + 1 < sampled.size() && sampled[k] >= sampled[k - 1] && sampled[k] >= sampled[k + 1];
    if (!extreme || sampled[k] < kContender * largest) continue;
    const auto negative_magnitude = [&](double t) {
      at.q = positions[k];
      return closure.solve(t, at) ? -std::abs(at.qdd[ideal.layout.slider]) : 0.0;
    };
    const auto [t, value] = boost::math::tools::brent_find_minima(negative_magnitude, time_of(i - 1), time_of(i + 1), 26);
    peak.take(value, t);
  }
  return peak;
}

}  // namespace engine
