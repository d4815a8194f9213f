// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/kinematic_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "engine/dynamics/energies.h"
#include "engine/integrate/block_instants.h"
#include "engine/integrate/choose_integrator.h"
#include "engine/integrate/sample_times.h"
#include "engine/integrate/tracked_quantity.h"

namespace engine {

namespace {

constexpr std::size_t kSteps = kBlockSteps;
constexpr double kStepOfTimeScale = 0.015;  // a step's part of the drives' time scale
constexpr double kFirstOfLongest = 0.01;    // the first step of a run, of the longest one
constexpr double kResolved = 3e-6;          // fourth difference of a block, of the largest value
constexpr double kNegligibleRate = 1e-9;    // [m/s^2], [rad/s^2], [W]: below, gravity's rounding counts
constexpr long kBlocksBetweenQueries = 64;

class KinematicRun {
 public:
  KinematicRun(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options,
               Observer& observer, const Evaluation& assembled)
      : mechanism_(mechanism),
        closure_(closure),
        piece_(mechanism.drives),
        options_(options),
        observer_(observer),
        samples_(options.output_rate, options.duration),
        extra_{assembled, assembled},
        predicted_(assembled),
        beside_{assembled, assembled},
        sample_(assembled),
        powers_(mechanism.drives.size()),
        accelerations_(closure.unknown_coordinates().size()),
        loads_(mechanism.drives.size() + mechanism.cut_joints.size()) {
    nodes_.fill(assembled);
    closure_.follow_drives(piece_);
  }

  RunOutcome run() {
    if (!start()) {
      fail(RunStatus::kLockUp, kLocked);
      return outcome_;
    }
    for (long block = 0; can_continue(block); ++block) {
      if (!solve_block()) {
        fail_at_end();
      } else {
        report_block();
        if (piece_.is_over(nodes_[0].t) && nodes_[0].t < options_.duration && !jump()) fail_at_end();
      }
    }
    outcome_.t = nodes_[0].t;
    return outcome_;
  }

 private:
  static constexpr const char* kLocked = "the linkage cannot follow its drives any further";

  [[nodiscard]] bool start() {
    ++outcome_.evaluations;
    if (!solve(0.0, nodes_[0], nodes_[0], nodes_[0])) return false;
    block_determinant_ = determinant_;
    largest_determinant_ = std::abs(determinant_);
    largest_rate_ = calc_largest_rate();
    take_samples(nodes_[0], nodes_[0], true);
    next_step_ = kFirstOfLongest * calc_longest();
    return true;
  }

  /// @returns whether the run solves another block. Fails if it has taken too many steps, or is to stop.
  [[nodiscard]] bool can_continue(long block) {
    if (!(nodes_[0].t < options_.duration) || outcome_.status != RunStatus::kSucceeded) return false;
    if (block % kBlocksBetweenQueries == 0 && observer_.stop_requested(nodes_[0].t))
      fail(RunStatus::kStopped, "stopped on request");
    else if (outcome_.steps >= options_.step_limit)
      fail(RunStatus::kStepLimit,
           "the run needs more than " + std::to_string(options_.step_limit) + " steps");
    return outcome_.status == RunStatus::kSucceeded;
  }

  void fail(RunStatus status, std::string detail) {
    outcome_.status = status;
    outcome_.detail = std::move(detail);
  }

  /// The motion leads no further. Rates are bounded in a change point, and grow without bound before a
  /// position beyond reach.
  void fail_at_end() {
    constexpr double kNear = 0.05;       // of the largest determinant
    constexpr double kUnbounded = 30.0;  // of the largest rate elsewhere
    if (std::abs(block_determinant_) < kNear * largest_determinant_ &&
        calc_largest_rate() < kUnbounded * largest_rate_)
      fail(RunStatus::kSingular, describe_change_point(mechanism_, nodes_[0]));
    else
      fail(RunStatus::kLockUp, kLocked);
  }

  /// Largest rate of an unknown coordinate at the block's start.
  [[nodiscard]] double calc_largest_rate() const {
    double largest = 0.0;
    for (const FrameIndex i : closure_.unknown_coordinates())
      largest = std::max(largest, std::abs(nodes_[0].qd[i]));
    return largest;
  }

  /// Enters the next drive piece and solves the instant again, with the accelerations after the jump.
  [[nodiscard]] bool jump() {
    piece_.advance();
    closure_.follow_drives(piece_);
    ++outcome_.evaluations;
    return solve(nodes_[0].t, nodes_[0], nodes_[0], nodes_[0]);
  }

  /// Solves for everything at time t, from the motion at two instants: see LoopClosure::extrapolate. False in
  /// and next to a change point.
  [[nodiscard]] bool solve(double t, const Evaluation& before, const Evaluation& nearby, Evaluation& at) {
    constexpr double kSingular = 1e-9;  // of the largest determinant: the solution loses as many digits
    closure_.extrapolate(t, before, nearby, at);
    if (!closure_.solve(t, at)) return false;
    determinant_ = closure_.determinant();
    if (!(std::abs(determinant_) > kSingular * largest_determinant_)) return false;
    calc_energies(at);
    return true;
  }

  /// The same in a change point: by the motion shortly before and, inside a drive's piece, after.
  [[nodiscard]] bool solve_beside(double t, const Evaluation& before, const Evaluation& nearby,
                                  Evaluation& at) {
    constexpr double kBeside = 0.4;  // of a step
    const double apart = kBeside * step_;
    auto& [left, right] = beside_;
    if (!solve(t - apart, before, nearby, left) || !is_continued(t - apart, before, nearby, left))
      return false;
    right = left;
    if (!piece_.is_over(t) && !(solve(t + apart, before, nearby, right) &&
                                is_continued(t + apart, before, nearby, right)))
      return false;
    interpolate(t, left, right, at);
    return true;
  }

  void interpolate(double t, const Evaluation& before, const Evaluation& after, Evaluation& at) const {
    closure_.interpolate(t, before, after, at);
    calc_energies(at);
  }

  /// @returns whether the motion goes on as predicted, on the branch on which it was: another one would
  /// differ by about the motion since the change point
  [[nodiscard]] bool is_continued(double t, const Evaluation& before, const Evaluation& nearby,
                                  const Evaluation& at) {
    constexpr double kPredicted = 1e-3;  // of the motion between the two instants
    if (!(nearby.t > before.t)) return false;
    closure_.extrapolate(t, before, nearby, predicted_);
    double error = 0.0, motion = 0.0;
    for (const FrameIndex i : closure_.unknown_coordinates()) {
      error = std::max(error, std::abs(at.q[i] - predicted_.q[i]));
      motion = std::max(motion, std::abs(nearby.q[i] - before.q[i]));
    }
    return error <= kPredicted * motion;
  }

  void calc_energies(Evaluation& at) const {
    at.energy.kinetic = calc_kinetic_energy(mechanism_, at.frames, at.qd);
    at.energy.potential = calc_potential_energy(mechanism_, at.frames, at.q);
  }

  [[nodiscard]] double calc_longest() const {
    return kStepOfTimeScale * calc_time_scale(mechanism_.drives, nodes_[0].t);
  }

  /// Solves the instants of the next block, with the step halved until the block is resolved. False if the
  /// shortest step fails: the mechanism locks.
  [[nodiscard]] bool solve_block() {
    constexpr double kShortest = 1e-9;        // of the longest step: a motion that it cannot follow is locked
    constexpr double kEasy = 1.0 / 32.0;      // twice the step makes sixteen times the error
    constexpr double kShortResolved = 1e-3;   // of the drives' step: a shorter one may be unresolved
    double limit = std::min(options_.duration, find_next_corner(mechanism_.drives, nodes_[0].t));
    if (options_.duration - limit < kSameInstant * limit) limit = options_.duration;
    const double allowed = calc_longest();
    const double longest = std::min(allowed, 2.0 * (limit - nodes_[0].t));
    const double first = std::min(next_step_, longest);
    const double shortest = std::max(kShortest * longest, kSameInstant * nodes_[0].t);
    double last_error = std::numeric_limits<double>::infinity();
    for (double step = first; step >= shortest; step *= 0.5) {
      times_ = calc_block_instants(nodes_[0].t, step, limit, options_.duration);
      if (!solve_nodes()) continue;
      const bool resolved = interpolate_block();
      // Rounding, which grows next to change points, does not fall with the step.
      const bool rounding = !resolved && interpolation_error_ > 0.5 * last_error;
      last_error = interpolation_error_;
      if (!is_power_bounded()) continue;
      if (!(resolved || rounding || step < kShortResolved * allowed)) continue;
      if (step < first) next_step_ = step;
      if (interpolation_error_ < kEasy * kResolved) next_step_ = std::max(next_step_, 2.0 * step);
      return true;
    }
    return false;
  }

  [[nodiscard]] bool solve_nodes() {
    double last = block_determinant_;
    outcome_.evaluations += kSteps;
    step_ = times_[1] - times_[0];
    for (std::size_t k = 1; k <= kSteps; ++k) {
      const Evaluation& before =
          nodes_[k == 1 ? kSteps - 1 : k - 2];  // for k = 1 in the block before, or in a try
      const Node node = solve_node(times_[k], last, before, nodes_[k - 1], nodes_[k]);
      if (node == Node::kNone) return false;
      is_far_[k] = node == Node::kFar;
      last = determinant_;
    }
    end_determinant_ = last;
    return true;
  }

  /// The motion leads to no such node, or to one near a change point or far from all.
  enum class Node { kNone, kNearChangePoint, kFar };

  /// @param last  determinant of the node before
  [[nodiscard]] Node solve_node(double t, double last, const Evaluation& before, const Evaluation& nearby,
                                Evaluation& at) {
    constexpr double kApart = 0.25;  // of a step: nearer to a change point, rounding grows, and branches are
                                     // too close for is_continued() to tell
    if (solve(t, before, nearby, at)) {
      if (keeps_branch(last, determinant_)) return Node::kFar;
      if (std::abs(determinant_) > kApart * std::abs(determinant_ - last) &&
          is_continued(t, before, nearby, at))
        return Node::kNearChangePoint;
    }
    return solve_beside(t, before, nearby, at) ? Node::kNearChangePoint : Node::kNone;
  }

  /// Computes the interpolants of the block just solved.
  /// @returns whether they resolve the motion inside the block. The error of accelerations is relative to
  /// those near by, since the next extremum may be as high and as narrow as the last; the error of powers to
  /// the largest of the run, since their sum counts.
  bool interpolate_block() {
    // Share of the rates' squares. Smaller accelerations of a uniform motion do not count: next to a change
    // point they are rounding.
    constexpr double kUniform = 0.3;
    const double fastest = calc_fastest_rate();
    acceleration_scale_ =
        std::max({0.5 * acceleration_scale_, kNegligibleRate, kUniform * fastest * fastest});
    const double acceleration_error = interpolate_accelerations();
    power_error_ = interpolate_powers();
    interpolation_error_ = std::max(acceleration_error / acceleration_scale_, power_error_ / power_scale_);
    return interpolation_error_ <= kResolved;
  }

  /// Largest rate of an unknown coordinate in the block.
  [[nodiscard]] double calc_fastest_rate() const {
    double fastest = 0.0;
    for (const FrameIndex i : closure_.unknown_coordinates())
      for (const Evaluation& node : nodes_) fastest = std::max(fastest, std::abs(node.qd[i]));
    return fastest;
  }

  /// @returns the largest fourth difference; the scale of accelerations is at least the largest of them then
  double interpolate_accelerations() {
    const std::vector<FrameIndex>& unknown = closure_.unknown_coordinates();
    double error = 0.0;
    for (std::size_t j = 0; j < unknown.size(); ++j) {
      const double largest =
          interpolate(accelerations_[j], [i = unknown[j]](const Evaluation& at) { return at.qdd[i]; });
      acceleration_scale_ = std::max(acceleration_scale_, largest);
      error = std::max(error, std::abs(accelerations_[j].interpolant().fourth_difference()));
    }
    return error;
  }

  /// The same for powers; notes the largest one of the block.
  double interpolate_powers() {
    double error = 0.0;
    block_power_ = 0.0;
    for (std::size_t k = 0; k < powers_.size(); ++k) {
      const auto power = [this, k](const Evaluation& at) { return calc_power(at, k); };
      block_power_ = std::max(block_power_, interpolate(powers_[k], power));
      power_scale_ = std::max(power_scale_, block_power_);
      error = std::max(error, std::abs(powers_[k].interpolant().fourth_difference()));
    }
    return error;
  }

  /// @returns whether the powers of the drives go on next to a change point as they came. Where a drive works
  /// against what its linkage cannot do, its force has no bound, and the motion ends.
  [[nodiscard]] bool is_power_bounded() const {
    constexpr double kBounded = 1e-3;  // of the largest power before
    return std::ranges::all_of(is_far_, std::identity()) || power_error_ <= kBounded * passed_power_;
  }

  /// @returns the largest magnitude in the block
  template <typename Quantity>
  double interpolate(TrackedQuantity& tracked, const Quantity& quantity) const {
    BlockInstants f{};
    for (std::size_t k = 0; k <= kSteps; ++k) f[k] = quantity(nodes_[k]);
    return tracked.set(f);
  }

  [[nodiscard]] double calc_power(const Evaluation& at, std::size_t drive) const {
    return at.drive_force[static_cast<Eigen::Index>(drive)] * at.qd[mechanism_.drives[drive].coordinate];
  }

  /// @returns whether the k-th step of the block is far from change points: extrema are sought there only
  [[nodiscard]] bool is_step_far(std::size_t k) const { return is_far_[k] && is_far_[k + 1]; }

  void report_block() {
    collect_split_instants();
    for (std::size_t k = 1; k <= kSteps; ++k) set_work(nodes_[k]);
    auto split = splits_.cbegin();
    for (std::size_t k = 0; k < kSteps; ++k) split = report_step(k, split);
    passed_power_ = std::max(passed_power_, block_power_);
    block_determinant_ = end_determinant_;
    largest_determinant_ = std::max(largest_determinant_, std::abs(end_determinant_));
    std::swap(nodes_[0], nodes_[kSteps]);
    is_far_[0] = is_far_[kSteps];
    if (std::abs(block_determinant_) > 0.5 * largest_determinant_)
      largest_rate_ = std::max(largest_rate_, calc_largest_rate());
  }

  /// @param split  the first instant that may lie in the step  @returns the first behind it
  std::vector<double>::const_iterator report_step(std::size_t k, std::vector<double>::const_iterator split) {
    const Evaluation* from = &nodes_[k];
    const double apart = 0.1 * kExtremumStep * (nodes_[k + 1].t - nodes_[k].t);
    for (std::size_t i = 0; split != splits_.end() && *split < nodes_[k + 1].t; ++split) {
      if (*split < from->t + apart || *split > nodes_[k + 1].t - apart || !is_step_far(k)) continue;
      Evaluation& at = extra_[i];
      ++outcome_.evaluations;
      if (!solve(*split, nodes_[k], nodes_[k + 1], at)) continue;
      set_work(at);
      accept(*from, at, true);
      from = &at;
      i = 1 - i;
    }
    accept(*from, nodes_[k + 1], is_step_far(k));
    return split;
  }

  /// Instants of the block at which a step is to end, in order.
  void collect_split_instants() {
    splits_.clear();
    split_at_accelerations();
    split_at_loads();
    std::sort(splits_.begin(), splits_.end());
  }

  /// On both sides of their extrema.
  void split_at_accelerations() {
    const double half = 0.5 * kExtremumStep;
    double largest = 0.0;
    for (const TrackedQuantity& acceleration : accelerations_)
      largest = std::max(largest, acceleration.largest());
    for (const TrackedQuantity& acceleration : accelerations_)
      acceleration.for_each_extremum(largest, [&](double s) {
        add_split(s - half);
        add_split(s + half);
      });
  }

  /// In the extrema of drive forces and reactions.
  void split_at_loads() {
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      const std::size_t drives = mechanism_.drives.size();
      const auto load = [&](const Evaluation& at) {
        return k < drives ? at.drive_force[static_cast<Eigen::Index>(k)]
                          : at.joints[k - drives].reaction_W.norm();
      };
      interpolate(loads_[k], load);
      loads_[k].for_each_extremum(loads_[k].largest(), [&](double s) { add_split(s); });
    }
  }

  void add_split(double s) {
    if (s > 0.0 && s < kSteps) splits_.push_back(nodes_[0].t + s * (nodes_[kSteps].t - nodes_[0].t) / kSteps);
  }

  /// Work of the drives at an instant of the block.
  void set_work(Evaluation& at) const {
    const double step = (nodes_[kSteps].t - nodes_[0].t) / kSteps;
    for (std::size_t k = 0; k < powers_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      at.energy.drive_work[i] = nodes_[0].energy.drive_work[i] +
                                step * powers_[k].interpolant().integral((at.t - nodes_[0].t) / step);
    }
  }

  void report_middle(const Evaluation& from, const Evaluation& to) {
    ++outcome_.evaluations;
    if (!solve(0.5 * (from.t + to.t), from, to, sample_)) return;
    set_work(sample_);
    observer_.on_middle(sample_);
  }

  void accept(const Evaluation& from, const Evaluation& to, bool far) {
    ++outcome_.steps;
    observer_.on_step(from, to);
    if (far && observer_.wants_middle()) report_middle(from, to);
    take_samples(from, to, far);
  }

  /// Samples up to the end of a step, those inside solved each at its own instant; next to a change point
  /// interpolated.
  void take_samples(const Evaluation& from, const Evaluation& to, bool far) {
    while (!samples_.all_taken() && samples_.next() <= to.t) {
      if (samples_.next() == to.t) {
        observer_.on_sample(to);
      } else {
        if (!far)
          interpolate(samples_.next(), from, to, sample_);
        else if (!solve(samples_.next(), from, to, sample_))
          return fail_at_end();
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
  std::array<Evaluation, kSteps + 1> nodes_;  ///< of the block; the first is solved already
  BlockInstants times_{};                     ///< their instants
  std::array<bool, kSteps + 1> is_far_{true, true, true, true, true};  ///< of each node, from change points
  std::array<Evaluation, 2> extra_;           ///< at split instants, alternately
  Evaluation predicted_;                      ///< coordinates by extrapolation
  std::array<Evaluation, 2> beside_;          ///< shortly before and after a change point
  Evaluation sample_;
  double step_ = 0.0;                         ///< of the block, [s]
  double next_step_ = 0.0;                    ///< the next step, [s]
  double determinant_ = 0.0;                  ///< of the instant solved last
  double block_determinant_ = 0.0, end_determinant_ = 0.0;  ///< of the block's first and last instant
  double largest_determinant_ = 0.0;          ///< magnitude in the run so far
  double largest_rate_ = 0.0;                 ///< of an unknown coordinate, far from singular positions
  std::vector<TrackedQuantity> powers_;       ///< one a drive
  double acceleration_scale_ = 0.0;           ///< of the accelerations near by
  double interpolation_error_ = 0.0;          ///< fourth difference of the block, relative, see kResolved
  double power_scale_ = kNegligibleRate;      ///< of the run so far
  double block_power_ = 0.0;                  ///< largest power in the block, [W]
  double power_error_ = 0.0;                  ///< fourth difference of the powers in the block, [W]
  double passed_power_ = kNegligibleRate;     ///< largest power of the blocks before, [W]
  std::vector<TrackedQuantity> accelerations_;  ///< one an unknown coordinate
  std::vector<TrackedQuantity> loads_;        ///< one a drive, then one a cut joint
  std::vector<double> splits_;                ///< instants inside the block at which a step ends as well
  RunOutcome outcome_;
};

}  // namespace

bool allows_kinematics(const Mechanism& mechanism, Integrator integrator) {
  return mechanism.drive_rows == DriveRows::kEliminated && integrator != Integrator::kRk4 &&
         !has_clearance(mechanism);
}

std::string describe_change_point(const Mechanism& mechanism, const Evaluation& at) {
  std::ostringstream text;
  text << "the linkage is in a change point, from which it can follow its drives in more than one way: "
       << "at t = " << at.t << " s";
  for (std::size_t k = 0; k < mechanism.drives.size(); ++k) {
    const FrameIndex d = mechanism.drives[k].coordinate;
    const Coordinate& driven = mechanism.coordinates[static_cast<std::size_t>(d)];
    text << (k > 0 ? ", " : ", with ") << driven.name << " at " << at.q[d]
         << (driven.motion == Motion::kRotation ? " rad" : " m");
  }
  return text.str();
}

RunOutcome run_kinematics(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options,
                          Observer& observer, const Evaluation& assembled) {
  return KinematicRun(mechanism, closure, options, observer, assembled).run();
}

}  // namespace engine
