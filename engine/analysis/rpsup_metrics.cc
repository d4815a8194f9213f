#include "engine/analysis/rpsup_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/analysis/quantities.h"

namespace engine {

std::span<const QuantityInfo> metric_table() {
  static const std::vector<QuantityInfo> table{
      {.key = "peak_slider_acceleration_m_s2", .help = "largest |acceleration| of the slider for t >= run_up_s, from the inside of every step"},
      {.key = "peak_slider_acceleration_time_s", .help = "when that was"},
      {.key = "peak_slider_acceleration_whole_run_m_s2", .help = "the same from t = 0 on"},
      {.key = "rms_slider_acceleration_m_s2", .help = "root mean square of the slider's acceleration for t >= run_up_s"},
      {.key = "ideal_peak_slider_acceleration_m_s2", .help = "largest |acceleration| of the ideal rigid linkage with the same drives, t >= run_up_s"},
      {.key = "amplification", .help = "peak over ideal peak"},
      {.key = "peak_contact_force_n", .help = "largest sum of radial normal forces of the whole run; null without clearance"},
      {.key = "max_penetration_um", .help = "largest radial penetration of the whole run; null without clearance"},
      {.key = "impact_count", .help = "onsets of radial contact of a ring in the whole run", .integer = true},
      {.key = "contact_time_ratio", .help = "part of the whole run in which the bore is touched; null without clearance"},
      {.key = "peak_crank_torque_n_m", .help = "largest |driving torque| of the whole run"},
      {.key = "peak_rod_force_n", .help = "largest |driving force| of the telescoping rod of the whole run"},
      {.key = "peak_joint_reaction_n", .help = "largest force between coupler and cross link of the whole run"},
      {.key = "friction_work_j", .help = "energy lost to friction in the joint"},
      {.key = "impact_loss_j", .help = "energy lost in the normal contact law"},
      {.key = "structural_loss_j", .help = "energy lost in the flexible coupler's dampers"},
      {.key = "sliding_work_j", .help = "contact force times sliding speed over the whole run: worn volume = wear coefficient times it; null without clearance"},
      {.key = "energy_residual", .help = "largest |E - E(0) - work of the drives + losses| over the work turned over"},
      {.key = "steps", .help = "accepted integration steps", .integer = true},
      {.key = "rhs_evaluations", .help = "evaluations of the equations of motion", .integer = true},
  };
  return table;
}

void RpsupMetrics::take_step(const Evaluation& start, const Evaluation& end) {
  if (!started_) {
    started_ = true;
    first_balance_ = start.energy.calc_balance();
    last_energy_ = start.energy;
  }
  take_acceleration(start, end);
  take_loads(start, end);
  take_energy(last_energy_, end.energy);
  last_energy_ = end.energy;
  // Steps end just beyond an onset or a parting, so what holds at the start of a step holds in all of it.
  if (start.joints[0].load.max_penetration > 0.0) contact_time_ += end.t - start.t;
}

void RpsupMetrics::take_acceleration(const Evaluation& start, const Evaluation& end) {
  const double dt = end.t - start.t;
  const StepQuadratic a(start.qdd[layout_.slider], end.qdd[layout_.slider], end.qd[layout_.slider] - start.qd[layout_.slider], dt);
  whole_run_.take(a, 0.0, 1.0, start.t, dt);
  if (end.t <= parameters_.run_up) return;
  const double from = std::max(0.0, (parameters_.run_up - start.t) / dt);
  steady_.take(a, from, 1.0, start.t, dt);
  square_integral_ += a.integrate_square(from, 1.0) * dt;
  steady_time_ += (1.0 - from) * dt;
}

void RpsupMetrics::take_loads(const Evaluation& start, const Evaluation& end) {
  const JointState& before = start.joints[0];
  const JointState& after = end.joints[0];
  const auto take = [&](double from, double to, SteppedPeak& peak) { return peak.take_step(from, to, start.t, end.t); };
  wants_middle_ = take(before.load.radial_normal_sum, after.load.radial_normal_sum, contact_force_);
  wants_middle_ |= take(before.load.max_penetration, after.load.max_penetration, penetration_);
  wants_middle_ |= take(start.drive_force[0], end.drive_force[0], torque_);
  wants_middle_ |= take(start.drive_force[1], end.drive_force[1], rod_force_);
  wants_middle_ |= take(before.reaction_W.norm(), after.reaction_W.norm(), reaction_);
}

void RpsupMetrics::take_middle(const Evaluation& middle) {
  const JointState& joint = middle.joints[0];
  contact_force_.take_middle(joint.load.radial_normal_sum);
  penetration_.take_middle(joint.load.max_penetration);
  torque_.take_middle(middle.drive_force[0]);
  rod_force_.take_middle(middle.drive_force[1]);
  reaction_.take_middle(joint.reaction_W.norm());
}

void RpsupMetrics::take_energy(const EnergyAccount& start, const EnergyAccount& end) {
  largest_imbalance_ = std::max(largest_imbalance_, std::abs(end.calc_balance() - first_balance_));
  turned_over_ += end.calc_turned_over_since(start);
}

std::vector<double> RpsupMetrics::calc(const RunEnd& end, const std::optional<Peak>& ideal, double sliding_work) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const bool has_steady = steady_time_ > 0.0;
  const bool has_clearance = parameters_.c_r > 0.0;
  const double ideal_peak = ideal ? ideal->magnitude : kNone;
  return {
      has_steady ? steady_.magnitude : kNone,
      has_steady ? steady_.t : kNone,
      whole_run_.magnitude,
      has_steady ? std::sqrt(square_integral_ / steady_time_) : kNone,
      ideal_peak,
      has_steady && ideal_peak > 0.0 ? steady_.magnitude / ideal_peak : kNone,
      has_clearance ? contact_force_.peak().magnitude : kNone,
      has_clearance ? 1e6 * penetration_.peak().magnitude : kNone,
      static_cast<double>(onsets_),
      has_clearance ? contact_time_ / end.t : kNone,
      torque_.peak().magnitude,
      rod_force_.peak().magnitude,
      reaction_.peak().magnitude,
      last_energy_.friction_loss,
      last_energy_.impact_loss,
      last_energy_.structural_loss,
      has_clearance ? sliding_work : kNone,
      turned_over_ > 0.0 ? largest_imbalance_ / turned_over_ : kNone,
      static_cast<double>(end.steps),
      static_cast<double>(end.evaluations),
  };
}

}  // namespace engine
