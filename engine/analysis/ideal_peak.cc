// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/ideal_peak.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/dynamics/loop_closure.h"
#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"

namespace engine {

namespace {

constexpr double kIntervalOfTimeScale = 0.1;      // an interval's part of the drives' time scale
constexpr double kFirstInterval = 1e-3;           // of the longest interval: the first one of a run
// Part of an interval's accelerations by which the trapezoid may miss their mean.
constexpr double kSmooth = 0.01;
// A quadratic's extreme above this part of the largest so far may be the true one.
constexpr double kContender = 0.99;
constexpr double kNegligibleAcceleration = 1e-9;  // [m/s^2]: accelerations that gravity's rounding may spoil
constexpr long kSolvesBetweenQueries = 1024;

/// Goes through the motion in intervals so short that a quadratic tells the acceleration inside; locates its
/// extremes where they contend.
class IdealPeakSearch {
 public:
  IdealPeakSearch(const RpsupParameters& parameters, const std::function<bool(double)>& stop_requested)
      : ideal_(build_ideal_rpsup(parameters)),
        closure_(ideal_.mechanism),
        piece_(ideal_.mechanism.drives),
        stop_requested_(stop_requested) {
    closure_.follow_drives(piece_);
    last_ = next_ = probe_ = MotionSystem(ideal_.mechanism).make_evaluation();
  }

  std::optional<Peak> find(double from, double to) {
    // Onwards from the start: the branch on which the linkage is assembled is known there.
    if (!closure_.assemble(0.0, last_) || !solve(0.0, last_, last_, last_)) return std::nullopt;
    determinant_ = closure_.determinant();
    next_dt_ = kFirstInterval * calc_longest();
    if (!advance(from)) return std::nullopt;
    searches_ = true;
    take(last_);
    if (!advance(to)) return std::nullopt;
    return peak_;
  }

 private:
  /// From the last node to the time given, piece by piece of the drives' laws.
  [[nodiscard]] bool advance(double to) {
    while (last_.t < to) {
      piece_start_ = last_.t;
      piece_end_ = std::min(to, find_next_corner(ideal_.mechanism.drives, last_.t));
      if (to - piece_end_ <= 1e-12 * to) piece_end_ = to;
      scale_ = 0.0;
      while (last_.t < piece_end_)
        if (!take_interval()) return false;
      // A jump at the end of the search is outside of it.
      const bool ends = searches_ && last_.t >= to;
      if (piece_.is_over(last_.t) && !ends && !jump()) return false;
    }
    return true;
  }

  /// Enters the next drive piece and solves the instant again, with the accelerations after the jump.
  [[nodiscard]] bool jump() {
    piece_.advance();
    closure_.follow_drives(piece_);
    if (!solve(last_.t, last_, last_, last_)) return false;
    if (searches_) take(last_);
    return true;
  }

  /// One more interval of the piece. False if the linkage locks in it, however short, or if the search is to
  /// stop.
  [[nodiscard]] bool take_interval() {
    constexpr double kShortest = 1e-9;      // of the longest: what cannot be followed with it is locked
    constexpr double kShortSmooth = 1e-6;   // of what the drives allow: not divided for smoothness' sake
    const double followed = calc_longest();
    const double longest = std::min(followed, piece_end_ - last_.t);
    double dt = std::min(next_dt_, longest);
    for (;; dt *= 0.5) {
      if (dt < kShortest * longest || stopped_) return false;
      const double end = choose_end(dt);
      if (!(end > last_.t)) return false;
      if (!solve(end, next_, last_, next_) || !keeps_branch(determinant_, closure_.determinant())) continue;
      if (!searches_ || is_smooth() || dt < kShortSmooth * followed) break;
    }
    accept_interval(dt);
    return true;
  }

  /// End of an interval of dt, or of what divides the rest of the piece evenly.
  [[nodiscard]] double choose_end(double dt) const {
    const double remaining = piece_end_ - last_.t;
    return remaining <= dt        ? piece_end_
           : remaining < 2.0 * dt ? last_.t + 0.5 * remaining
                                  : last_.t + dt;
  }

  void accept_interval(double dt) {
    next_dt_ = 1.5 * dt;
    determinant_ = closure_.determinant();
    if (searches_) search_interval();
    std::swap(last_, next_);
  }

  /// The longest interval from the last node on that the drives allow.
  [[nodiscard]] double calc_longest() const {
    return kIntervalOfTimeScale * calc_time_scale(ideal_.mechanism.drives, last_.t);
  }

  /// Position, velocity and acceleration at t, from those of two instants: see LoopClosure::extrapolate.
  [[nodiscard]] bool solve(double t, const Evaluation& before, const Evaluation& nearby, Evaluation& at) {
    if (++solves_ % kSolvesBetweenQueries == 0 && stop_requested_ && stop_requested_(t)) stopped_ = true;
    if (stopped_) return false;
    closure_.extrapolate(t, before, nearby, at);
    return closure_.solve_motion(t, at);
  }

  [[nodiscard]] double velocity(const Evaluation& at) const { return at.qd[ideal_.layout.slider]; }
  [[nodiscard]] double acceleration(const Evaluation& at) const { return at.qdd[ideal_.layout.slider]; }
  void take(const Evaluation& at) { peak_.take(acceleration(at), at.t); }

  /// Near lock-up the slider reverses in far less time than the drives take: what happens between two
  /// instants shows in the change of velocity. Measured by the accelerations near by, not by the peak: the
  /// next peak may be as high and as narrow as the last.
  [[nodiscard]] bool is_smooth() {
    const double a0 = acceleration(last_);
    const double a1 = acceleration(next_);
    const double scale = std::max({std::abs(a0), std::abs(a1), 0.8 * scale_, kNegligibleAcceleration});
    const double missed = (velocity(next_) - velocity(last_)) / (next_.t - last_.t) - 0.5 * (a0 + a1);
    if (!(std::abs(missed) <= kSmooth * scale)) return false;
    scale_ = scale;
    return true;
  }

  void search_interval() {
    // An extreme near an interval's end may show from the other side only, and there just outside.
    constexpr double kMargin = 0.1;
    const double dt = next_.t - last_.t;
    const StepQuadratic a(acceleration(last_), acceleration(next_), velocity(next_) - velocity(last_), dt);
    take(next_);
    const double s = a.find_extremum(-kMargin, 1.0 + kMargin);
    const double t = last_.t + s * dt;
    if (s == -kMargin || std::abs(a.value(s)) < kContender * peak_.magnitude ||
        std::abs(t - located_) < kMargin * dt)
      return;
    locate(t, dt);
  }

  /// Extreme near t, as that of the parabola through three instants close together, and again from there if
  /// it lies beyond them.
  void locate(double t, double dt) {
    constexpr int kMaxTries = 8;
    constexpr double kOfInterval = 1.0 / 64.0;
    const double apart = std::min(kOfInterval * dt, 0.25 * (piece_end_ - piece_start_));
    for (int i = 0; i < kMaxTries; ++i) {
      t = std::clamp(t, piece_start_ + apart, piece_end_ - apart);
      const double offset = probe_extreme_offset(t, apart);
      if (!std::isfinite(offset)) return;
      t = std::clamp(t + apart * std::clamp(offset, -0.5 / kOfInterval, 0.5 / kOfInterval), piece_start_,
                     piece_end_);
      if (std::abs(offset) > 1.0) continue;
      probe(t);
      located_ = t;
      return;
    }
  }

  /// Distance from t, over `apart`, of the extreme of the parabola through t and both instants beside it.
  /// These count for the peak, too.
  double probe_extreme_offset(double t, double apart) {
    const double before = probe(t - apart);
    const double middle = probe(t);
    const double after = probe(t + apart);
    return 0.5 * (before - after) / (before - 2.0 * middle + after);
  }

  double probe(double t) {
    if (!solve(t, last_, next_, probe_)) return std::nan("");
    take(probe_);
    return acceleration(probe_);
  }

  Rpsup ideal_;
  LoopClosure closure_;
  DrivePiece piece_;
  const std::function<bool(double)>& stop_requested_;
  /// The interval's ends, and until the second is known the one before; an instant near by.
  Evaluation last_, next_, probe_;
  double piece_start_ = 0.0, piece_end_ = 0.0;  ///< between corners of the drives' laws, [s]
  double next_dt_ = 0.0;       ///< the next interval, [s]
  double determinant_ = 0.0;  ///< at the last node
  double scale_ = 0.0;        ///< of the accelerations in the last intervals, [m/s^2]
  double located_ = -1.0;     ///< the last extreme, [s]
  Peak peak_;
  bool searches_ = false, stopped_ = false;
  long solves_ = 0;
};

}  // namespace

std::optional<Peak> find_ideal_peak(const RpsupParameters& parameters, double from, double to,
                                    const std::function<bool(double)>& stop_requested) {
  if (!(from < to) || parameters.crank_actuator || parameters.rod_actuator) return std::nullopt;
  return IdealPeakSearch(parameters, stop_requested).find(from, to);
}

}  // namespace engine
