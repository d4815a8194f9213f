#include "engine/analysis/rpsup_channels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace engine {

namespace {

std::vector<QuantityInfo> measured_channels() {
  return {
      {.key = "t_s", .help = "time"},
      {.key = "crank_angle_rad", .help = "psi of link (1,1)"},
      {.key = "crank_velocity_rad_s", .help = "its rate"},
      {.key = "rod_displacement_m", .help = "z of link (1,2)"},
      {.key = "slider_position_m", .help = "z of link (2,1)"},
      {.key = "slider_velocity_m_s", .help = "its rate"},
      {.key = "slider_acceleration_m_s2", .help = "its second derivative"},
      {.key = "slider_acceleration_min_m_s2", .help = "least since the last sample"},
      {.key = "slider_acceleration_max_m_s2", .help = "largest since the last sample"},
      {.key = "journal_x_mm", .help = "journal centre in the bearing frame"},
      {.key = "journal_y_mm", .help = "journal centre in the bearing frame"},
      {.key = "journal_z_mm", .help = "journal centre in the bearing frame, along its axis"},
      {.key = "journal_tilt_mrad", .help = "angle between the axes of journal and bearing"},
      {.key = "contact_force_n", .help = "sum of the radial normal forces; null without clearance"},
      {.key = "friction_force_n", .help = "sum of the friction forces' magnitudes; null without clearance"},
      {.key = "crank_torque_n_m", .help = "driving torque of the crank"},
      {.key = "rod_force_n", .help = "driving force of the telescoping rod"},
      {.key = "reaction_x_n", .help = "force of the coupler on the cross link, in the global frame"},
      {.key = "reaction_y_n", .help = "force of the coupler on the cross link, in the global frame"},
      {.key = "reaction_z_n", .help = "force of the coupler on the cross link, in the global frame"},
      {.key = "coupler_deflection_mm", .help = "of the bearing's centre from where the undeformed coupler would hold it"},
      {.key = "kinetic_energy_j", .help = "of all links"},
      {.key = "potential_energy_j", .help = "of gravity, the coupler's springs and the elastic part of the contact"},
      {.key = "drive_work_j", .help = "of both drives since t = 0"},
      {.key = "energy_residual", .help = "(E - E(0) - work of the drives + losses) over the work turned over in the whole run"},
  };
}

std::string pose_key(const NamedFrame& link, std::string_view part) {
  std::string key = "pose_" + link.name + "_";
  std::replace(key.begin(), key.end(), ',', '_');
  return key.append(part);
}

std::vector<QuantityInfo> channels_of(const RpsupParameters& parameters, const Rpsup& rpsup) {
  std::vector<QuantityInfo> channels = measured_channels();
  for (int ring = 1; ring <= parameters.radial_levels; ++ring) {
    const std::string key = "ring_" + std::to_string(ring) + "_sliding_work";
    channels.push_back({.key = key + "_j", .help = "normal force times sliding speed of that ring of the journal, since t = 0; null without clearance"});
    for (const std::string axis : {"x", "y"}) channels.push_back({.key = key + "_" + axis + "_j", .help = "the same times the contact normal's " + axis});
  }
  for (const NamedFrame& link : rpsup.mechanism.links)
    for (const std::string_view part : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"})
      channels.push_back({.key = pose_key(link, part), .help = "pose of link (" + link.name + ") in the global frame: origin, unit quaternion",
                          .single_precision = true});
  return channels;
}

}  // namespace

std::vector<QuantityInfo> channel_table(const RpsupParameters& parameters) { return channels_of(parameters, build_rpsup(parameters)); }

RpsupChannels::RpsupChannels(const RpsupParameters& parameters, const Rpsup& rpsup)
    : parameters_(parameters), rpsup_(rpsup), last_turns_(rpsup.mechanism.links.size(), Eigen::Quaterniond::Identity()),
      sliding_work_(parameters) {
  trajectory_.channels = channels_of(parameters, rpsup);
  trajectory_.columns.resize(trajectory_.channels.size());
}

void RpsupChannels::take_step(const Evaluation& start, const Evaluation& end) {
  take_extremes(1.0);
  const FrameIndex slider = rpsup_.layout.slider;
  step_start_ = start.t;
  step_dt_ = end.t - start.t;
  acceleration_ = StepQuadratic(start.qdd[slider], end.qdd[slider], end.qd[slider] - start.qd[slider], step_dt_);
  taken_ = 0.0;
  if (parameters_.c_r > 0.0) sliding_work_.take_step(start, end);
}

void RpsupChannels::take_extremes(double until) {
  if (!(taken_ < until)) return;
  for (const double s : {taken_, acceleration_.find_turn(taken_, until), until}) {
    least_ = std::min(least_, acceleration_.value(s));
    most_ = std::max(most_, acceleration_.value(s));
  }
  taken_ = until;
}

void RpsupChannels::take_sample(const Evaluation& at) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const RpsupLayout& layout = rpsup_.layout;
  const double acceleration = at.qdd[layout.slider];
  if (!sampled_) {
    sampled_ = true;
    first_balance_ = at.energy.calc_balance();
    least_ = most_ = acceleration;
  }
  const double part = std::min(1.0, step_dt_ > 0.0 ? (at.t - step_start_) / step_dt_ : 1.0);
  take_extremes(part);
  const JointState& joint = at.joints[0];
  const bool clearance = parameters_.c_r > 0.0;
  const Eigen::Vector3d journal_mm = 1e3 * joint.journal.p_bj;
  const double tilt = std::asin(std::min(1.0, joint.journal.R_bj.col(2).head<2>().norm()));
  row_ = {at.t, at.q[layout.crank], at.qd[layout.crank], at.q[layout.rod], at.q[layout.slider], at.qd[layout.slider],
          acceleration, std::min(least_, acceleration), std::max(most_, acceleration), journal_mm.x(), journal_mm.y(), journal_mm.z(), 1e3 * tilt,
          clearance ? joint.load.radial_normal_sum : kNone, clearance ? joint.load.friction_sum : kNone, at.drive_force[0], at.drive_force[1],
          joint.reaction_W.x(), joint.reaction_W.y(), joint.reaction_W.z(), 1e3 * calc_deflection(at), at.energy.kinetic,
          at.energy.potential, at.energy.drive_work.sum(), at.energy.calc_balance() - first_balance_};
  add_sliding_work(part);
  add_poses(at);
  for (std::size_t k = 0; k < row_.size(); ++k) trajectory_.columns[k].push_back(row_[k]);
  least_ = most_ = acceleration;
}

void RpsupChannels::add_sliding_work(double part) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (int ring = 0; ring < parameters_.radial_levels; ++ring) {
    const auto work = sliding_work_.at(static_cast<std::size_t>(ring), part);
    for (const double value : {work.work, work.work_x, work.work_y}) row_.push_back(parameters_.c_r > 0.0 ? value : kNone);
  }
}

void RpsupChannels::add_poses(const Evaluation& at) {
  for (std::size_t k = 0; k < rpsup_.mechanism.links.size(); ++k) {
    const FrameMotion& frame = at.frames[static_cast<std::size_t>(rpsup_.mechanism.links[k].frame)];
    Eigen::Quaterniond turn(frame.R);
    if (turn.dot(last_turns_[k]) < 0.0) turn.coeffs() = -turn.coeffs();
    last_turns_[k] = turn;
    for (const double value : {frame.p.x(), frame.p.y(), frame.p.z(), turn.w(), turn.x(), turn.y(), turn.z()}) row_.push_back(value);
  }
}

double RpsupChannels::calc_deflection(const Evaluation& at) const {
  const CutJoint& joint = rpsup_.mechanism.cut_joints[0];
  const FrameMotion& root = at.frames[static_cast<std::size_t>(rpsup_.layout.coupler)];
  const FrameMotion& end = at.frames[static_cast<std::size_t>(joint.bearing_frame)];
  const Eigen::Vector3d undeformed = root.p + root.R.col(0) * parameters_.coupler_length;
  return (end.p + end.R * joint.bearing.p - undeformed).norm();
}

Trajectory RpsupChannels::finish(double work_turned_over) {
  for (std::size_t k = 0; k < trajectory_.columns.size(); ++k) {
    if (trajectory_.channels[k].key != "energy_residual" || !(work_turned_over > 0.0)) continue;
    for (double& value : trajectory_.columns[k]) value /= work_turned_over;
  }
  return std::move(trajectory_);
}

}  // namespace engine
