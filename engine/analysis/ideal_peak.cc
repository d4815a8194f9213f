#include "engine/analysis/ideal_peak.h"

#include <algorithm>
#include <cmath>

#include <boost/math/tools/minima.hpp>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"

namespace engine {

namespace {

constexpr double kInterval = 1e-3;   // [s] between the samples among which the extremes are looked for
constexpr double kContender = 0.99;  // a sampled extreme above this part of the largest so far may be the true one
constexpr long kSolvesBetweenQueries = 1024;

class IdealPeakSearch {
 public:
  IdealPeakSearch(const RpsupParameters& parameters, const std::function<bool(double)>& stop_requested)
      : ideal_(build_ideal_rpsup(parameters)), closure_(ideal_.mechanism), stop_requested_(stop_requested) {
    at_ = MotionSystem(ideal_.mechanism).make_evaluation();
  }

  std::optional<Peak> find(double from, double to) {
    // Onwards from the start: the branch on which the linkage is assembled is known there.
    if (!closure_.assemble(0.0, at_) || !advance(0.0, from)) return std::nullopt;
    const auto intervals = std::max(2L, static_cast<long>(std::ceil((to - from) / kInterval)));
    const auto time_of = [&](long k) { return from + (to - from) * static_cast<double>(std::clamp(k, 0L, intervals)) / static_cast<double>(intervals); };
    double before = 0.0;  // the magnitudes and the position at the last two samples
    double last = 0.0;
    Eigen::VectorXd q_last;
    for (long k = 0; k <= intervals + 1; ++k) {
      if (k <= intervals && !solve(time_of(k))) return std::nullopt;
      const double now = k <= intervals ? std::abs(at_.qdd[ideal_.layout.slider]) : 0.0;
      peak_.take(now, time_of(k));
      if (k > 0 && last >= before && last >= now && last >= kContender * peak_.magnitude) {
        const Eigen::VectorXd q_now = at_.q;
        refine(q_last, time_of(k - 2), time_of(k));
        at_.q = q_now;
      }
      before = last;
      last = now;
      q_last = at_.q;
    }
    return peak_;
  }

 private:
  [[nodiscard]] bool solve(double t) {
    if (++solves_ % kSolvesBetweenQueries == 0 && stop_requested_ && stop_requested_(t)) return false;
    return closure_.solve(t, at_);
  }

  [[nodiscard]] bool advance(double from, double to) {
    const auto intervals = static_cast<long>(std::ceil((to - from) / kInterval));
    for (long k = 1; k <= intervals; ++k)
      if (!solve(from + (to - from) * static_cast<double>(k) / static_cast<double>(intervals))) return false;
    return true;
  }

  /// Brent's search for the extreme in an interval that holds one.
  void refine(const Eigen::VectorXd& q_nearby, double from, double to) {
    constexpr int kBits = 26;  // of the time; the value is then right to twice as many
    const auto negative_magnitude = [&](double t) {
      at_.q = q_nearby;
      return closure_.solve(t, at_) ? -std::abs(at_.qdd[ideal_.layout.slider]) : 0.0;
    };
    const auto [t, value] = boost::math::tools::brent_find_minima(negative_magnitude, from, to, kBits);
    peak_.take(value, t);
  }

  Rpsup ideal_;
  LoopClosure closure_;
  const std::function<bool(double)>& stop_requested_;
  Evaluation at_;
  Peak peak_;
  long solves_ = 0;
};

}  // namespace

std::optional<Peak> find_ideal_peak(const RpsupParameters& parameters, double from, double to,
                                    const std::function<bool(double)>& stop_requested) {
  if (!(from < to)) return std::nullopt;
  return IdealPeakSearch(parameters, stop_requested).find(from, to);
}

}  // namespace engine
