// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/integration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/integrate/choose_integrator.h"
#include "engine/integrate/contact_events.h"
#include "engine/integrate/interpolation.h"
#include "engine/model/applied_force.h"

namespace engine {

namespace {

constexpr double kFirstStep = 1e-6;     // [s]; the step control finds its own within some steps
// A longer step without bristles may have overshot: a shorter one is tried first.
constexpr double kWidenBelow = 1e-5;  // [s]
constexpr double kShortestAtTables = 1e-5;  // steps that look for what they pass by, [s]
constexpr double kHopeless = 1e-11;       // [s]
constexpr int kMaxHopelessSteps = 100;   // in a row: a short step by itself grows again
constexpr int kMaxLandings = 6;         // tries to end a step on an event
constexpr long kStepsBetweenQueries = 256;

RunOptions with_integrator(const Mechanism& mechanism, RunOptions options) {
  if (options.integrator != Integrator::kAuto) return options;
  options.integrator = choose_integrator(mechanism, options.integrator);
  options.relative_tolerance = choose_tolerance(mechanism, options.relative_tolerance);
  options.absolute_tolerance = choose_tolerance(mechanism, options.absolute_tolerance);
  return options;
}

/// Shortest step, a hundred roundings of the time: below, error control has failed.
double shortest_step(double t) { return 1e-14 * std::max(1.0, t); }

/// Shortest remainder that counts as a fixed step, [s]. A shorter one is rounding.
double sliver_of(const RunOptions& options) {
  return options.integrator == Integrator::kRk4 ? 1e-9 * options.step : 0.0;
}

double calc_mass(const Mechanism& mechanism) {
  double mass = 0.0;
  for (const Coordinate& body : mechanism.coordinates) mass += body.mass;
  return mass;
}

}  // namespace

Integration::Integration(const Mechanism& mechanism, const RunOptions& options, Observer& observer)
    : mechanism_(mechanism),
      charts_(mechanism),
      given_chart_observer_(observer, charts_),
      options_(with_integrator(mechanism, options)),
      observer_(charts_.empty() ? observer : given_chart_observer_),
      system_(mechanism_),
      tolerance_(options_.relative_tolerance, options_.absolute_tolerance),
      energy_control_(options_, is_rigid(mechanism) ? calc_mass(mechanism) : 0.0),
      follows_speed_(!has_clearance(mechanism)),
      stepper_(make_stepper(mechanism, options_.integrator, tolerance_)),
      control_(stepper_->error_exponent()),
      samples_(options.output_rate, options.duration),
      sliver_(sliver_of(options_)),
      pace_check_(options.duration, options.step_limit),
      unstable_mode_limiter_(mechanism, options_.integrator, system_.free_count()) {}

RunOutcome Integration::run(const Evaluation& assembled) {
  const bool fixed = options_.integrator == Integrator::kRk4;
  piece_ = DrivePiece(mechanism_.drives, mechanism_.actuations, mechanism_.body_loads);
  system_.follow_drives(piece_);
  if (!start(assembled)) return outcome_;
  end_ = start_;
  take_samples();
  while (can_continue()) {
    if (!(fixed ? try_fixed_step() : try_controlled_step())) continue;
    accept();
    if ((piece_.is_over(start_.t) || start_.t >= piece_.end() - sliver_) && start_.t < options_.duration)
      jump();
  }
  outcome_.t = start_.t;
  return outcome_;
}

/// @returns whether the run takes another step. Fails if it has taken too many, or is to stop.
bool Integration::can_continue() {
  if (failed_ || !(start_.t < options_.duration)) return false;
  if (outcome_.steps >= options_.step_limit)
    fail(RunStatus::kStepLimit,
         "the run needs more than " + std::to_string(options_.step_limit) + " steps");
  else if (pace_check_.is_hopeless(outcome_.steps, start_.t))
    fail(RunStatus::kStepLimit, "at the pace of its last million steps the run needs more than " +
                                    std::to_string(options_.step_limit) + " steps");
  else if (outcome_.steps % kStepsBetweenQueries == 0 && observer_.stop_requested(start_.t))
    fail(RunStatus::kStopped, "stopped on request");
  return !failed_;
}

void Integration::set_start(const Evaluation& assembled) {
  start_.at = system_.make_evaluation();
  given_chart_observer_.start(assembled);
  start_.at.q = assembled.q;
  start_.at.qd = assembled.qd;
  bend_bristles(mechanism_, start_.at.qd);
  start_.y = system_.make_state(start_.at.q, start_.at.qd);
  (void)begin_charts();
  end_ = sample_ = start_;
  start_.f = end_.f = sample_.f = Eigen::VectorXd::Zero(start_.y.size());
  dt_ = kFirstStep;
}

bool Integration::start(const Evaluation& assembled) {
  set_start(assembled);
  const EvaluationStatus status = evaluate_start();
  if (status != EvaluationStatus::kOk) {
    fail(status);
    return false;
  }
  // Dopri5's steps are as short as its stability asks: it would take no longer ones.
  if (is_implicit(options_.integrator))
    tolerance_.set_radii(mechanism_, system_.free_coordinates(), start_.at.frames);
  system_.add_penetrations(start_.at, rings_start_);
  follow_speed();
  return true;
}

/// Evaluates the start. A journal may touch there: its bristles come to where the contact is, as many as it
/// needs.
EvaluationStatus Integration::evaluate_start() {
  EvaluationStatus status = evaluate(start_);
  if (system_.prepare_step(start_.at, 0.0, start_.y)) status = evaluate(start_);
  while (status == EvaluationStatus::kBristleMissing) status = widen_bristles();
  return status;
}

/// Begins new charts of spherical joints whose angles come near to a singularity. @returns whether any is
/// new; the state is to be evaluated again then
bool Integration::begin_charts() {
  if (!charts_.update(mechanism_, start_.at.q, start_.at.qd)) return false;
  system_.reload_mechanism();
  const Eigen::Index motion = 2 * system_.free_count();
  start_.y.head(motion) = system_.make_state(start_.at.q, start_.at.qd).head(motion);
  return true;
}

/// Largest speed of the drives in the whole run, [m/s], from samples; rotations by the radius of gyration of
/// the bodies that they carry.
double Integration::calc_drive_speed() const {
  constexpr int kSamples = 64;
  double largest = 0.0;
  for (const Drive& drive : mechanism_.drives) {
    const bool turns =
        mechanism_.coordinates[static_cast<std::size_t>(drive.coordinate)].motion == Motion::kRotation;
    const double radius =
        turns ? calc_gyration_radius(mechanism_, drive.coordinate, start_.at.frames) : 1.0;
    for (int k = 0; k <= kSamples; ++k)
      largest = std::max(
          largest, radius * std::abs(calc_driven_motion(drive.law, k * options_.duration / kSamples).qd));
  }
  return largest;
}

/// Lets absolute tolerances follow the scale of the motion: the largest speed so far, at first with the speed
/// that the accelerations make of rest, and with that of the drives.
void Integration::follow_speed() {
  constexpr double kSoon = 1e-3;  // [s]
  if (!follows_speed_) return;
  const int n = system_.layout().free, v = system_.layout().v();
  double speed = tolerance_.calc_speed(start_.y.segment(v, n));
  if (start_.t == 0.0)
    speed = std::max({speed, kSoon * tolerance_.calc_speed(start_.f.segment(v, n)), calc_drive_speed()});
  if (!(speed > speed_)) return;
  speed_ = speed;
  const double factor = tolerance_.follow_speed(speed_);
  // The energies of a drive that begins at rest are small at first only.
  if (start_.at.energy.drive_work.size() == 0) energy_control_.follow_speed(factor);
}

/// Enters the next drive piece and evaluates the state again, with the accelerations after the jump.
void Integration::jump() {
  piece_.advance();
  system_.follow_drives(piece_);
  stepper_->invalidate();
  (void)evaluate(start_);  // as after each change below: what could be evaluated before can be now
}

/// Moves bristles along with their contacts to other elements, whose rates differ.
void Integration::prepare(double dt) {
  if (!system_.prepare_step(start_.at, dt, start_.y)) return;
  stepper_->invalidate();
  (void)evaluate(start_);
}

EvaluationStatus Integration::evaluate(StepPoint& point) {
  ++outcome_.evaluations;
  const EvaluationStatus status = system_.calc_derivative(point.t, point.y, point.f, point.at);
  system_.calc_energies(point.at);
  return status;
}

EvaluationStatus Integration::widen_bristles() {
  system_.widen_bristles(start_.y);
  // Replaced, not resized: see MotionSystem::allocate().
  for (Eigen::VectorXd* each : {&start_.f, &end_.y, &end_.f, &sample_.y, &sample_.f})
    *each = Eigen::VectorXd(Eigen::VectorXd::Zero(start_.y.size()));
  stepper_ = make_stepper(mechanism_, options_.integrator, tolerance_);
  return evaluate(start_);
}

void Integration::fail(EvaluationStatus status) {
  if (status == EvaluationStatus::kLocked)
    fail(RunStatus::kLockUp, "the linkage cannot follow its drives any further");
  else if (status == EvaluationStatus::kWedged)
    fail(RunStatus::kLockUp,
         describe_lock_or("friction by reactions wedges the linkage; a smaller coefficient or radius, or a "
                          "longer bearing, may help"));
  else if (status == EvaluationStatus::kOutOfRange)
    fail(RunStatus::kContactRange,
         "the journal goes deeper into the bore than the stiffness law holds; "
         "hertz and liu have no such limit");
  else
    fail(RunStatus::kNonFinite, "the state is no longer a number; a smaller step or tolerance may help");
}

/// Cause of a failure: gimbal lock, or the given one.
std::string Integration::describe_lock_or(std::string otherwise) const {
  constexpr double kNear = 0.05;  // cosine
  const std::optional<FrameIndex> locked = find_gimbal_lock(mechanism_, start_.at.q, kNear);
  return locked ? describe_gimbal_lock(mechanism_, *locked) : std::move(otherwise);
}

void Integration::fail(RunStatus status, std::string detail) {
  failed_ = true;
  outcome_.status = status;
  outcome_.detail = std::move(detail);
}

/// A fixed step crosses the jumps inside it: its stages take the accelerations at their own instants.
void Integration::cross_jumps(double t_end) {
  if (piece_.end() >= t_end - sliver_) return;
  while (piece_.end() < t_end - sliver_) piece_.advance();
  system_.follow_drives(DrivePiece());
  crossing_step_ = fixed_steps_;
}

/// Step k ends at (k + 1) step without accumulated rounding, the last step at the end of the run.
bool Integration::try_fixed_step() {
  double t_end = static_cast<double>(fixed_steps_ + 1) * options_.step;
  if (options_.duration - t_end < sliver_) t_end = options_.duration;
  if (crossing_step_ < fixed_steps_) {  // not where the same step is tried again
    crossing_step_ = kNoStep;
    system_.follow_drives(piece_);
  }
  cross_jumps(t_end);
  prepare(t_end - start_.t);
  const Trial trial = stepper_->try_step(system_, start_, t_end - start_.t, end_);
  outcome_.evaluations += trial.evaluations;
  if (!accept_or_widen(trial)) return false;
  end_.t = t_end;
  system_.calc_energies(end_.at);
  ++fixed_steps_;
  return true;
}

/// @returns whether a fixed step is accepted. If not, widens the bristles for another try, or fails.
bool Integration::accept_or_widen(const Trial& trial) {
  if (trial.status == EvaluationStatus::kBristleMissing) {
    (void)widen_bristles();
    return false;
  }
  if (trial.status != EvaluationStatus::kOk || !end_.y.allFinite()) {
    fail(trial.status);
    return false;
  }
  return true;
}

bool Integration::try_controlled_step() {
  const double stop = std::min(options_.duration, piece_.end());
  const double remaining = stop - start_.t;
  const double dt = choose_step(remaining);
  prepare(dt);
  const Trial trial = try_step(dt);
  if (!accept_or_shrink(trial, dt)) return false;
  if (dt > kShortestAtTables && passes_by_a_table()) {
    dt_ = 0.5 * dt;
    return false;
  }
  set_next_step(dt, trial.error);
  if (failed_ || !land_on_event(dt)) return false;
  if (dt == remaining && end_.t - start_.t == dt) end_.t = stop;
  return true;
}

/// Checks the local stability where that is due, which may leave the stepper without its matrices.
/// @param remaining  time up to where the step is to end at the latest, [s]
double Integration::choose_step(double remaining) {
  if (unstable_mode_limiter_.is_check_due(start_.t))
    unstable_mode_limiter_.check_local_stability(system_, start_, *stepper_);
  return std::min({dt_, unstable_mode_limiter_.max_step(), remaining});
}

/// After a step whose error is within the tolerance. Fails if steps stay too short.
void Integration::set_next_step(double dt, double error) {
  dt_ = dt * control_.accept(error);
  hopeless_steps_ = dt_ < kHopeless ? hopeless_steps_ + 1 : 0;
  if (hopeless_steps_ == kMaxHopelessSteps)
    fail(RunStatus::kStepUnderflow,
         describe_lock_or("the motion asks for steps below 1e-11 s: a linkage that jams does, and very light "
                          "bodies in loops"));
}

/// @returns whether the step just tried has passed by what a table over position or velocity says
bool Integration::passes_by_a_table() const {
  return std::ranges::any_of(mechanism_.actuations, [this](const Actuation& actuation) {
    return is_passed_by(actuation, start_.at.q, end_.at.q, start_.at.qd, end_.at.qd);
  });
}

Trial Integration::try_step(double dt) {
  Trial trial = stepper_->try_step(system_, start_, dt, end_);
  outcome_.evaluations += trial.evaluations;
  if (trial.status != EvaluationStatus::kOk || !(trial.error <= 1.0)) return trial;
  system_.calc_energies(end_.at);
  if (!is_implicit(options_.integrator)) return trial;
  const double imbalance = energy_control_.measure(start_.at.energy, end_.at.energy, start_.t, dt);
  if (!(imbalance <= trial.error)) trial.error = imbalance;  // no number is no small error
  return trial;
}

/// @returns whether a trial is accepted. If not, sets the next step, or fails.
bool Integration::accept_or_shrink(const Trial& trial, double dt) {
  if (trial.status == EvaluationStatus::kBristleMissing && dt <= kWidenBelow) {
    (void)widen_bristles();
    return false;
  }
  const bool evaluated = trial.status == EvaluationStatus::kOk && std::isfinite(trial.error);
  if (evaluated && trial.error <= 1.0) return true;
  dt_ = dt * (evaluated ? control_.reject(trial.error) : 0.25);
  if (dt_ < shortest_step(start_.t)) {
    if (evaluated)
      fail(RunStatus::kStepUnderflow,
           describe_lock_or("the error stays above the tolerance however small the step"));
    else
      fail(trial.status);
  }
  return false;
}

/// Event location: where a ring meets or leaves the bore inside the step just tried, tries a shorter step
/// that ends there.
/// @returns false if the shorter step failed; the next try is shorter still
bool Integration::land_on_event(double dt) {
  for (int landing = 0;; ++landing) {
    rings_end_.clear();
    system_.add_penetrations(end_.at, rings_end_);
    const std::optional<double> until = ContactEvents::find_first(rings_start_, rings_end_, dt);
    if (!until || *until < shortest_step(start_.t) || landing == kMaxLandings) return true;
    const Trial trial = try_step(*until);
    if (!accept_or_shrink(trial, *until)) return false;
    dt = *until;
  }
}

void Integration::accept() {
  ++outcome_.steps;
  energy_control_.accept(start_.at.energy, end_.at.energy);
  observe_step();
  stepper_->accept();
  accept_contacts();
  std::swap(start_, end_);
  std::swap(rings_start_, rings_end_);
  follow_speed();
  if (begin_charts()) {
    stepper_->invalidate();
    (void)evaluate(start_);
  }
}

void Integration::observe_step() {
  observer_.on_step(start_.at, end_.at);
  if (observer_.wants_middle()) {
    if (evaluate_inside(0.5 * (start_.t + end_.t)) == EvaluationStatus::kOk) observer_.on_middle(sample_.at);
  }
  take_samples();
}

/// Takes note of the contacts that began or ended in the step, and evaluates its end with them.
void Integration::accept_contacts() {
  const ContactChange change = system_.accept_step(start_.at, end_.at, end_.y);
  if (change.ring_onsets + change.face_onsets > 0)
    observer_.on_onsets(change.ring_onsets, change.face_onsets);
  // One element more or less in a lasting contact changes the Jacobian and the state's polynomial little;
  // Newton's iterations correct the difference.
  if (change.abrupt)
    stepper_->invalidate();
  else if (change.any)
    stepper_->reset_convergence_rate();
  if (change.any) (void)evaluate(end_);
}

/// Takes the samples up to the end of the step, with the contacts of the step.
void Integration::take_samples() {
  while (!samples_.all_taken() && samples_.next() <= end_.t) {
    const EvaluationStatus status = evaluate_sample(samples_.next());
    if (status != EvaluationStatus::kOk) return fail(status);
    system_.calc_energies(sample_.at);
    observer_.on_sample(sample_.at);
    samples_.take();
  }
}

/// Evaluates the last step at time t into sample_, or its end where the state inside cannot be evaluated: an
/// element touches there that touches at neither end, or friction fits the reactions at the ends alone.
EvaluationStatus Integration::evaluate_sample(double t) {
  const EvaluationStatus inside = evaluate_inside(t);
  if (inside != EvaluationStatus::kBristleMissing && inside != EvaluationStatus::kWedged) return inside;
  sample_.y = end_.y;
  const EvaluationStatus at_end = system_.calc_derivative(end_.t, sample_.y, sample_.f, sample_.at);
  sample_.at.t = t;
  return at_end;
}

/// Evaluates the last step at time t into sample_.
EvaluationStatus Integration::evaluate_inside(double t) {
  if (t < end_.t)
    interpolate_state(start_, end_, system_.layout(), (t - start_.t) / (end_.t - start_.t), sample_.y);
  else
    sample_.y = end_.y;
  return system_.calc_derivative(t, sample_.y, sample_.f, sample_.at);
}

}  // namespace engine
