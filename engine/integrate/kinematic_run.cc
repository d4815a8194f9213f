// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/kinematic_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/dynamics/energies.h"
#include "engine/integrate/quartic.h"
#include "engine/integrate/sample_times.h"

namespace engine {

namespace {

constexpr std::size_t kSteps = 4;           // of a panel
constexpr double kStepOfTimeScale = 0.015;  // a step's part of the drives' time scale
constexpr double kPerSecond = 1000.0;       // the grid on which steps end is that of milliseconds, halves, doubles and so on
constexpr double kSameInstant = 1e-12;      // of the time
constexpr double kFirstOfLongest = 0.01;    // the first step of a run, of the longest one
constexpr double kResolved = 3e-6;          // fourth difference of a panel's accelerations and powers, of the largest of them
constexpr double kNegligibleRate = 1e-9;    // [m/s^2], [rad/s^2], [W]: what gravity's rounding may spoil
constexpr double kTurnStep = 1.0 / 32.0;    // of a step: the short one in which an acceleration turns
constexpr long kPanelsBetweenQueries = 64;

/// A quantity whose extremes are looked for, in the panel at hand.
struct Watched {
  Quartic course;
  double rise = 0.0;     ///< between its least and its largest value
  double largest = 0.0;  ///< magnitude in the run so far
};

class KinematicRun {
 public:
  KinematicRun(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options, Observer& observer, const Evaluation& assembled)
      : mechanism_(mechanism), closure_(closure), piece_(mechanism.drives), options_(options), observer_(observer), samples_(options.output_rate, options.duration),
        extra_{assembled, assembled}, sample_(assembled), powers_(mechanism.drives.size()),
        accelerations_(closure.unknown_coordinates().size()), loads_(mechanism.drives.size() + mechanism.cut_joints.size()) {
    nodes_.fill(assembled);
    closure_.follow_drives(piece_);
  }

  RunEnd run() {
    ++run_end_.evaluations;
    if (!solve(0.0, nodes_[0], nodes_[0], nodes_[0])) {
      fail(RunStatus::kLockUp, kLocked);
      return run_end_;
    }
    determinant_ = closure_.determinant();
    take_samples(nodes_[0], nodes_[0]);
    wanted_ = kFirstOfLongest * calc_longest();
    for (long panel = 0; nodes_[0].t < options_.duration && run_end_.status == RunStatus::kSucceeded; ++panel) {
      if (panel % kPanelsBetweenQueries == 0 && observer_.stop_requested(nodes_[0].t)) {
        fail(RunStatus::kStopped, "stopped on request");
      } else if (run_end_.steps >= options_.step_limit) {
        fail(RunStatus::kStepLimit, "the run needs more than " + std::to_string(options_.step_limit) + " steps");
      } else if (!solve_panel()) {
        fail(RunStatus::kLockUp, kLocked);
      } else {
        report_panel();
        if (piece_.is_over(nodes_[0].t) && nodes_[0].t < options_.duration && !jump()) fail(RunStatus::kLockUp, kLocked);
      }
    }
    run_end_.t = nodes_[0].t;
    return run_end_;
  }

 private:
  static constexpr const char* kLocked = "the linkage cannot follow its drives any further";

  void fail(RunStatus status, std::string detail) {
    run_end_.status = status;
    run_end_.detail = std::move(detail);
  }

  /// Enters the next drive piece and solves the instant again, with the accelerations after the jump.
  [[nodiscard]] bool jump() {
    piece_.advance();
    closure_.follow_drives(piece_);
    ++run_end_.evaluations;
    return solve(nodes_[0].t, nodes_[0], nodes_[0], nodes_[0]);
  }

  /// Everything at time t, from the motion at two instants: see LoopClosure::lead.
  [[nodiscard]] bool solve(double t, const Evaluation& before, const Evaluation& nearby, Evaluation& at) {
    closure_.lead(t, before, nearby, at);
    if (!closure_.solve(t, at)) return false;
    at.energy.kinetic = calc_kinetic_energy(mechanism_, at.frames);
    at.energy.potential = calc_potential_energy(mechanism_, at.frames, at.q);
    return true;
  }

  [[nodiscard]] double calc_longest() const {
    double longest = std::numeric_limits<double>::infinity();
    for (const Drive& drive : mechanism_.drives) longest = std::min(longest, kStepOfTimeScale * calc_time_scale(drive.law, nodes_[0].t));
    return longest;
  }

  /// Solves the instants of the next panel, in shorter steps where those do not do. False if the shortest do not: the mechanism locks.
  [[nodiscard]] bool solve_panel() {
    constexpr double kShortest = 1e-9;        // of the longest step: what cannot be followed with it is locked
    constexpr double kEasy = 1.0 / 32.0;      // twice the step misses sixteen times as much
    constexpr double kShortResolved = 1e-3;   // of what the drives allow: not divided for smoothness' sake
    double limit = options_.duration;
    for (const Drive& drive : mechanism_.drives) limit = std::min(limit, find_next_corner(drive.law, nodes_[0].t));
    if (options_.duration - limit < kSameInstant * limit) limit = options_.duration;
    const double followed = calc_longest();
    const double longest = std::min(followed, 2.0 * (limit - nodes_[0].t));
    const double first = std::min(wanted_, longest);
    const double shortest = std::max(kShortest * longest, kSameInstant * nodes_[0].t);
    for (double step = first; step >= shortest; step *= 0.5) {
      place_nodes(limit, step);
      if (!solve_nodes() || !(is_resolved() || step < kShortResolved * followed)) continue;
      if (step < first) wanted_ = step;
      if (missed_ < kEasy * kResolved) wanted_ = std::max(wanted_, 2.0 * step);
      return true;
    }
    return false;
  }

  /// Instants of a panel of steps no longer than the one given: whole milliseconds, twice or half as many again and again. Common rates
  /// of output find their samples among them, and yet they, and all that is read from steps, do not depend on that rate.
  void place_nodes(double limit, double step) {
    constexpr double kSliver = 0.125;  // of a step: so short a rest before or after the grid is taken along
    const double start = nodes_[0].t;
    int level = std::ilogb(kPerSecond * step);
    const double place = std::ldexp(kPerSecond * start, -level);
    double tick = std::round(place);
    double stop = 0.0;
    const double length = calc_instant(1.0, level);
    if (calc_instant(tick, level) == start) {
      // A limit this near to the grid is on it.
      const double whole = std::floor(std::ldexp(kPerSecond * limit * (1.0 + kSameInstant), -level)) - tick;
      const int halvings = whole >= 4.0 ? 0 : whole >= 2.0 ? 1 : 2;
      level -= halvings;
      tick = std::ldexp(tick, halvings);
      for (std::size_t k = 0; k <= kSteps; ++k) times_[k] = calc_instant(tick + static_cast<double>(k), level);
      stop = whole >= 1.0 ? times_[kSteps] : limit;
      if (std::abs(limit - stop) < kSameInstant * limit && limit == options_.duration) times_[kSteps] = limit;
      if (stop != limit && (limit - stop > kSliver * length || limit - stop < kSameInstant * limit)) return;
      stop = limit;
    } else {
      stop = calc_instant(std::floor(place + kSliver) + 1.0, level);
      if (stop > limit - kSliver * length) stop = limit;
    }
    for (std::size_t k = 0; k <= kSteps; ++k) times_[k] = start + (stop - start) * static_cast<double>(k) / kSteps;
    times_[kSteps] = stop;
  }

  /// The same number as that of a sample at the same instant.
  [[nodiscard]] static double calc_instant(double tick, int level) { return std::ldexp(tick, level) / kPerSecond; }

  [[nodiscard]] bool solve_nodes() {
    end_determinant_ = determinant_;
    run_end_.evaluations += kSteps;
    for (std::size_t k = 1; k <= kSteps; ++k) {
      const Evaluation& before = nodes_[k == 1 ? kSteps - 1 : k - 2];  // of the last panel where this one begins
      if (!solve(times_[k], before, nodes_[k - 1], nodes_[k]) || !keeps_branch(end_determinant_, closure_.determinant())) return false;
      end_determinant_ = closure_.determinant();
    }
    return true;
  }

  /// Computes the quartics of the panel just solved.
  /// @returns whether they tell what happens inside it. Of accelerations that is measured by those near by: the next extreme may be as
  /// high and as narrow as the last. Of powers by the largest of the run: their sum is what counts.
  [[nodiscard]] bool is_resolved() {
    const std::vector<FrameIndex>& unknown = closure_.unknown_coordinates();
    double of_accelerations = 0.0;
    acceleration_scale_ = std::max(0.5 * acceleration_scale_, kNegligibleRate);
    for (std::size_t j = 0; j < unknown.size(); ++j) {
      const double largest = take_course(accelerations_[j], [i = unknown[j]](const Evaluation& at) { return at.qdd[i]; });
      acceleration_scale_ = std::max(acceleration_scale_, largest);
      of_accelerations = std::max(of_accelerations, std::abs(accelerations_[j].course.fourth_difference()));
    }
    double of_powers = 0.0;
    for (std::size_t k = 0; k < powers_.size(); ++k) {
      power_scale_ = std::max(power_scale_, take_course(powers_[k], [this, k](const Evaluation& at) { return calc_power(at, k); }));
      of_powers = std::max(of_powers, std::abs(powers_[k].course.fourth_difference()));
    }
    missed_ = std::max(of_accelerations / acceleration_scale_, of_powers / power_scale_);
    return missed_ <= kResolved;
  }

  /// @returns the largest magnitude in the panel
  template <typename Quantity>
  double take_course(Watched& watched, const Quantity& quantity) const {
    std::array<double, kSteps + 1> f{};
    for (std::size_t k = 0; k <= kSteps; ++k) f[k] = quantity(nodes_[k]);
    const auto [least, most] = std::minmax_element(f.begin(), f.end());
    watched.course = Quartic(f[0], f[1], f[2], f[3], f[4]);
    watched.rise = *most - *least;
    const double largest = std::max(std::abs(*least), std::abs(*most));
    watched.largest = std::max(watched.largest, largest);
    return largest;
  }

  [[nodiscard]] double calc_power(const Evaluation& at, std::size_t drive) const {
    return at.drive_force[static_cast<Eigen::Index>(drive)] * at.qd[mechanism_.drives[drive].coordinate];
  }

  void report_panel() {
    find_turns();
    for (std::size_t k = 1; k <= kSteps; ++k) set_work(nodes_[k]);
    auto turn = turns_.begin();
    for (std::size_t k = 0; k < kSteps; ++k) {
      const Evaluation* from = &nodes_[k];
      const double apart = 0.1 * kTurnStep * (nodes_[k + 1].t - nodes_[k].t);
      for (std::size_t i = 0; turn != turns_.end() && *turn < nodes_[k + 1].t; ++turn) {
        if (*turn < from->t + apart || *turn > nodes_[k + 1].t - apart) continue;
        Evaluation& at = extra_[i];
        ++run_end_.evaluations;
        if (!solve(*turn, nodes_[k], nodes_[k + 1], at)) continue;
        set_work(at);
        accept(*from, at);
        from = &at;
        i = 1 - i;
      }
      accept(*from, nodes_[k + 1]);
    }
    determinant_ = end_determinant_;
    std::swap(nodes_[0], nodes_[kSteps]);
  }

  /// Instants of the panel at which a step is to end, in order.
  void find_turns() {
    turns_.clear();
    const double half = 0.5 * kTurnStep;
    double largest = 0.0;
    for (const Watched& acceleration : accelerations_) largest = std::max(largest, acceleration.largest);
    for (const Watched& acceleration : accelerations_)
      for_each_turn(acceleration, largest, [&](double s) {
        add_turn(s - half);
        add_turn(s + half);
      });
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      const std::size_t drives = mechanism_.drives.size();
      const auto load = [&](const Evaluation& at) {
        return k < drives ? at.drive_force[static_cast<Eigen::Index>(k)] : at.joints[k - drives].reaction_W.norm();
      };
      take_course(loads_[k], load);
      for_each_turn(loads_[k], loads_[k].largest, [&](double s) { add_turn(s); });
    }
    std::sort(turns_.begin(), turns_.end());
  }

  void add_turn(double s) {
    if (s > 0.0 && s < kSteps) turns_.push_back(nodes_[0].t + s * (nodes_[kSteps].t - nodes_[0].t) / kSteps);
  }

  /// Places where a quantity turns: one in a step whose ends see its slope change sign. The panels beside find one at their common end too.
  template <typename Take>
  void for_each_turn(const Watched& watched, double scale, const Take& take) const {
    constexpr double kRounding = 1e-10;
    if (!(watched.rise > kRounding * scale)) return;
    const double over = 0.25 * kTurnStep;
    const std::array<double, kSteps + 1> places{-over, 1.0, 2.0, 3.0, kSteps + over};
    double slope = watched.course.slope(places[0]);
    for (std::size_t k = 1; k <= kSteps; ++k) {
      const double next = watched.course.slope(places[k]);
      if (slope * next < 0.0) take(find_root(watched.course, places[k - 1], places[k]));
      slope = next;
    }
  }

  /// By halving: the slope has another sign at each end.
  [[nodiscard]] static double find_root(const Quartic& course, double from, double to) {
    constexpr int kHalvings = 40;
    const bool rises = course.slope(from) > 0.0;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (from + to);
      ((course.slope(middle) > 0.0) == rises ? from : to) = middle;
    }
    return 0.5 * (from + to);
  }

  /// Work of the drives at an instant of the panel.
  void set_work(Evaluation& at) const {
    const double step = (nodes_[kSteps].t - nodes_[0].t) / kSteps;
    for (std::size_t k = 0; k < powers_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      at.energy.drive_work[i] = nodes_[0].energy.drive_work[i] + step * powers_[k].course.integral((at.t - nodes_[0].t) / step);
    }
  }

  void accept(const Evaluation& from, const Evaluation& to) {
    ++run_end_.steps;
    observer_.on_step(from, to);
    take_samples(from, to);
  }

  /// Samples up to the end of a step, those inside solved each at its own instant.
  void take_samples(const Evaluation& from, const Evaluation& to) {
    while (!samples_.all_taken() && samples_.next() <= to.t) {
      if (samples_.next() == to.t) {
        observer_.on_sample(to);
      } else {
        if (!solve(samples_.next(), from, to, sample_)) return fail(RunStatus::kLockUp, kLocked);
        set_work(sample_);
        observer_.on_sample(sample_);
      }
      samples_.take();
    }
  }

  const Mechanism& mechanism_;
  LoopClosure& closure_;
  DrivePiece piece_;
  const RunOptions& options_;
  Observer& observer_;
  SampleTimes samples_;
  std::array<Evaluation, kSteps + 1> nodes_;  ///< of the panel; the first is solved already
  std::array<double, kSteps + 1> times_{};    ///< wanted of them
  std::array<Evaluation, 2> extra_;           ///< ends of a step within the panel's
  Evaluation sample_;
  double wanted_ = 0.0;                       ///< the next step, [s]
  double determinant_ = 0.0, end_determinant_ = 0.0;  ///< of the panel's first and last instant
  std::vector<Watched> powers_;               ///< one a drive
  double acceleration_scale_ = 0.0;           ///< of those near by
  double missed_ = 0.0;                       ///< by the panel's quartics, see kResolved
  double power_scale_ = kNegligibleRate;      ///< of the run so far
  std::vector<Watched> accelerations_;        ///< one an unknown coordinate
  std::vector<Watched> loads_;                ///< one a drive, then one a cut joint
  std::vector<double> turns_;
  RunEnd run_end_;
};

}  // namespace

RunEnd run_kinematics(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options, Observer& observer,
                      const Evaluation& assembled) {
  return KinematicRun(mechanism, closure, options, observer, assembled).run();
}

}  // namespace engine
