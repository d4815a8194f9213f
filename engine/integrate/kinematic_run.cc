#include "engine/integrate/kinematic_run.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/dynamics/tree_dynamics.h"
#include "engine/integrate/sample_times.h"

namespace engine {

namespace {

constexpr double kStep = 2.5e-4;  // [s]; the reconstructed peak is then right to about 1e-7
constexpr long kStepsBetweenQueries = 256;

class KinematicRun {
 public:
  KinematicRun(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options, Observer& observer, const Evaluation& assembled)
      : mechanism_(mechanism), closure_(closure), duration_(options.duration), observer_(observer),
        samples_(options.output_rate, options.duration), start_(assembled), middle_(assembled), end_(assembled), sample_(assembled) {}

  RunEnd run() {
    ++run_end_.evaluations;
    if (!solve(0.0, start_)) return run_end_;
    take_samples(start_, start_);
    const auto pairs = static_cast<long>(std::ceil(duration_ / (2.0 * kStep)));
    for (long pair = 0; pair < pairs; ++pair) {
      if (run_end_.steps % kStepsBetweenQueries == 0 && observer_.stop_requested(start_.t)) {
        run_end_.status = RunStatus::kStopped;
        run_end_.detail = "stopped on request";
        break;
      }
      if (!take_pair(static_cast<double>(pair + 1) * duration_ / static_cast<double>(pairs))) break;
    }
    run_end_.t = start_.t;
    return run_end_;
  }

 private:
  bool solve(double t, Evaluation& at) {
    if (closure_.solve(t, at)) {
      at.energy.kinetic = calc_kinetic_energy(mechanism_, at.frames);
      at.energy.potential = calc_potential_energy(mechanism_, at.frames, at.q);
      return true;
    }
    run_end_.status = RunStatus::kLockUp;
    run_end_.detail = "the linkage cannot follow its drives any further";
    return false;
  }

  /// Two steps to t: the power at three instants gives the work of both.
  bool take_pair(double t) {
    const double dt = 0.5 * (t - start_.t);
    run_end_.evaluations += 2;
    middle_ = start_;
    if (!solve(start_.t + dt, middle_)) return false;
    end_ = middle_;
    if (!solve(t, end_)) return false;
    for (std::size_t k = 0; k < mechanism_.drives.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double p0 = calc_power(start_, k);
      const double p1 = calc_power(middle_, k);
      const double p2 = calc_power(end_, k);
      middle_.energy.drive_work[i] = start_.energy.drive_work[i] + dt / 12.0 * (5.0 * p0 + 8.0 * p1 - p2);
      end_.energy.drive_work[i] = start_.energy.drive_work[i] + dt / 3.0 * (p0 + 4.0 * p1 + p2);
    }
    accept(start_, middle_);
    accept(middle_, end_);
    std::swap(start_, end_);
    return run_end_.status == RunStatus::kSucceeded;
  }

  [[nodiscard]] double interpolate_work(const Evaluation& from, const Evaluation& to, std::size_t drive, double t) const {
    const auto i = static_cast<Eigen::Index>(drive);
    const double dt = to.t - from.t;
    const double s = (t - from.t) / dt;
    const double p0 = dt * calc_power(from, drive);
    const double p1 = dt * calc_power(to, drive);
    const double dw = to.energy.drive_work[i] - from.energy.drive_work[i];
    return from.energy.drive_work[i] + s * (p0 + s * (3.0 * dw - 2.0 * p0 - p1 + s * (p0 + p1 - 2.0 * dw)));
  }

  [[nodiscard]] double calc_power(const Evaluation& at, std::size_t drive) const {
    return at.drive_force[static_cast<Eigen::Index>(drive)] * at.qd[mechanism_.drives[drive].coordinate];
  }

  void accept(const Evaluation& from, const Evaluation& to) {
    ++run_end_.steps;
    observer_.on_step(from, to);
    take_samples(from, to);
  }

  /// Samples of a step, each solved at its own instant; their work is the cubic through work and power at the step's ends.
  void take_samples(const Evaluation& from, const Evaluation& to) {
    while (!samples_.all_taken() && samples_.next() <= to.t) {
      sample_ = to;
      if (samples_.next() < to.t) {
        if (!solve(samples_.next(), sample_)) return;
        for (std::size_t k = 0; k < mechanism_.drives.size(); ++k)
          sample_.energy.drive_work[static_cast<Eigen::Index>(k)] = interpolate_work(from, to, k, sample_.t);
      }
      observer_.on_sample(sample_);
      samples_.take();
    }
  }

  const Mechanism& mechanism_;
  LoopClosure& closure_;
  double duration_;
  Observer& observer_;
  SampleTimes samples_;
  Evaluation start_, middle_, end_, sample_;
  RunEnd run_end_;
};

}  // namespace

RunEnd run_kinematics(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options, Observer& observer,
                      const Evaluation& assembled) {
  return KinematicRun(mechanism, closure, options, observer, assembled).run();
}

}  // namespace engine
