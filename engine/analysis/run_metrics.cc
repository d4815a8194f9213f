// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/run_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/analysis/velocity_cubic.h"

namespace engine {

RunMetrics::RunMetrics(Measured measured)
    : measured_(std::move(measured)),
      accelerations_(measured_.accelerations.size()),
      velocities_(measured_.velocities.size()),
      loads_(measured_.loads.size()),
      start_loads_(measured_.loads.size()),
      contact_times_(measured_.contacts.size()) {}

void RunMetrics::take_step(const Evaluation& start, const Evaluation& end) {
  if (!started_) begin(start.energy);
  for (std::size_t k = 0; k < accelerations_.size(); ++k)
    take_acceleration(measured_.accelerations[k], start, end, accelerations_[k]);
  for (std::size_t k = 0; k < velocities_.size(); ++k)
    take_velocity(measured_.velocities[k], start, end, velocities_[k]);
  if (end.t > measured_.steady_from) steady_time_ += end.t - std::max(start.t, measured_.steady_from);
  take_loads(start, end);
  take_energy(last_energy_, end.energy);
  last_energy_ = end.energy;
  take_contacts(start, end.t - start.t);
}

void RunMetrics::begin(const EnergyAccount& start) {
  started_ = true;
  first_balance_ = start.calc_balance();
  first_potential_ = start.potential;
  last_energy_ = start;
}

void RunMetrics::take_acceleration(FrameIndex i, const Evaluation& start, const Evaluation& end,
                                   Acceleration& taken) const {
  const double dt = end.t - start.t;
  const StepQuadratic a(start.qdd[i], end.qdd[i], end.qd[i] - start.qd[i], dt);
  taken.whole_run.take(a, 0.0, 1.0, start.t, dt);
  if (end.t <= measured_.steady_from) return;
  const double from = std::max(0.0, (measured_.steady_from - start.t) / dt);
  taken.steady.take(a, from, 1.0, start.t, dt);
  taken.square_integral += a.integrate_square(from, 1.0) * dt;
}

void RunMetrics::take_velocity(FrameIndex i, const Evaluation& start, const Evaluation& end,
                               Velocity& taken) const {
  if (end.t <= measured_.steady_from) return;
  const double dt = end.t - start.t;
  const VelocityCubic v(start.qd[i], start.qdd[i], end.qd[i], end.qdd[i], dt);
  const double from = std::max(0.0, (measured_.steady_from - start.t) / dt);
  for (const double s : v.find_candidates(from)) {
    taken.least = std::min(taken.least, v.value(s));
    taken.most = std::max(taken.most, v.value(s));
  }
  taken.way += dt * v.integrate(from, 1.0);
}

void RunMetrics::take_loads(const Evaluation& start, const Evaluation& end) {
  if (measured_.prepare) measured_.prepare(start);
  for (std::size_t k = 0; k < loads_.size(); ++k) start_loads_[k] = measured_.loads[k](start);
  if (measured_.prepare) measured_.prepare(end);
  wants_middle_ = false;
  for (std::size_t k = 0; k < loads_.size(); ++k)
    wants_middle_ |= loads_[k].take_step(start_loads_[k], measured_.loads[k](end), start.t, end.t);
}

/// Steps end just beyond an onset or a parting (rk4's up to a step later), so what holds at the start of a
/// step holds in all of it.
void RunMetrics::take_contacts(const Evaluation& start, double dt) {
  for (std::size_t k = 0; k < contact_times_.size(); ++k) {
    const ContactLoad& load = start.joints[measured_.contacts[k].joint].load;
    if (measured_.contacts[k].of_faces ? load.face_touches : load.max_penetration > 0.0)
      contact_times_[k] += dt;
  }
}

void RunMetrics::take_middle(const Evaluation& middle) {
  if (measured_.prepare) measured_.prepare(middle);
  for (std::size_t k = 0; k < loads_.size(); ++k) loads_[k].take_middle(measured_.loads[k](middle));
}

void RunMetrics::take_energy(const EnergyAccount& start, const EnergyAccount& end) {
  largest_imbalance_ = std::max(largest_imbalance_, std::abs(end.calc_balance() - first_balance_));
  turned_over_ += end.calc_turned_over_since(start);
  largest_in_motion_ = std::max({largest_in_motion_, start.kinetic, end.kinetic,
                                 std::abs(end.potential - first_potential_)});
}

double RunMetrics::calc_rms(std::size_t k) const {
  return steady_time_ > 0.0 ? std::sqrt(accelerations_[k].square_integral / steady_time_)
                            : std::numeric_limits<double>::quiet_NaN();
}

double RunMetrics::calc_mean_velocity(std::size_t k) const {
  return steady_time_ > 0.0 ? velocities_[k].way / steady_time_ : std::numeric_limits<double>::quiet_NaN();
}

double RunMetrics::calc_speed_fluctuation(std::size_t k) const {
  const double mean = std::abs(calc_mean_velocity(k));
  return mean > 0.0 ? (velocities_[k].most - velocities_[k].least) / mean
                    : std::numeric_limits<double>::quiet_NaN();
}

double RunMetrics::calc_energy_residual() const {
  return energy_scale() > 0.0 ? largest_imbalance_ / energy_scale()
                              : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace engine
