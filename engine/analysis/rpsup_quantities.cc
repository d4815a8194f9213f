// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/rpsup_quantities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace engine {

namespace {

double radial_force(const Evaluation& at) { return at.joints[0].load.radial_normal_sum; }
double penetration(const Evaluation& at) { return at.joints[0].load.max_penetration; }
double friction_force(const Evaluation& at) { return at.joints[0].load.friction_sum; }
double crank_torque(const Evaluation& at) { return at.drive_force[0]; }
double rod_force(const Evaluation& at) { return at.drive_force[1]; }
double reaction(const Evaluation& at) { return at.joints[0].reaction_W.norm(); }
double none(const Evaluation&) { return kNone; }

double calc_deflection(const RpsupParameters& parameters, const Rpsup& rpsup, const Evaluation& at) {
  const CutJoint& joint = rpsup.mechanism.cut_joints[0];
  const FrameMotion& root = at.frames[static_cast<std::size_t>(rpsup.layout.coupler)];
  const FrameMotion& end = at.frames[static_cast<std::size_t>(joint.bearing_frame)];
  const Eigen::Vector3d undeformed = root.p + root.R.col(0) * parameters.coupler_length;
  return (end.p + end.R * joint.bearing.p - undeformed).norm();
}

/// Of a link's end from where the undeformed link would hold it, [m]
double calc_deflection(const BentLink& link, const Evaluation& at) {
  const auto place = [&at](const BodyFrames::Part& part, double along) -> Eigen::Vector3d {
    const FrameMotion& frame = at.frames[static_cast<std::size_t>(part.frame)];
    return frame.p + frame.R * (part.placement.p + along * part.placement.R.col(0));
  };
  return (place(link.tip, link.length - link.tip.begin) - place(link.root, link.length)).norm();
}

Reading journal_mm(int axis) {
  return [axis](const Evaluation& at) { return 1e3 * at.joints[0].journal.p_bj[axis]; };
}
Reading reaction_along(int axis) {
  return [axis](const Evaluation& at) { return at.joints[0].reaction_W[axis]; };
}
Reading position(FrameIndex i) {
  return [i](const Evaluation& at) { return at.q[i]; };
}
Reading rate(FrameIndex i) {
  return [i](const Evaluation& at) { return at.qd[i]; };
}

/// Of one ring of the journal.
void add_sliding_work(int ring, const RpsupParameters& parameters, const SlidingWork& sliding_work, std::vector<Channel>& channels) {
  const bool clearance = parameters.c_r > 0.0;
  const std::string key = "ring_" + std::to_string(ring + 1) + "_sliding_work";
  const auto read = [&](double SlidingWork::Ring::*part) -> Reading {
    if (!clearance) return none;
    return [&sliding_work, ring, part](const Evaluation& at) {
      return sliding_work.at(static_cast<std::size_t>(ring), sliding_work.place_of(at.t)).*part;
    };
  };
  channels.push_back({.info = {.key = key + "_j", .help = "normal force times sliding speed of that ring of the journal, since t = 0; null without clearance"},
                      .read = read(&SlidingWork::Ring::work)});
  channels.push_back({.info = {.key = key + "_x_j", .help = "the same times the contact normal's x"}, .read = read(&SlidingWork::Ring::work_x)});
  channels.push_back({.info = {.key = key + "_y_j", .help = "the same times the contact normal's y"}, .read = read(&SlidingWork::Ring::work_y)});
  if (parameters.wear_depth.empty()) return;
  channels.push_back({.info = {.key = key + "_penetration_j_m", .help = "the same times the penetration; of a worn bore alone"},
                      .read = read(&SlidingWork::Ring::work_delta)});
}

}  // namespace

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
      {.key = "structural_loss_j", .help = "energy lost in the flexible links' dampers"},
      {.key = "sliding_work_j", .help = "contact force times sliding speed over the whole run: worn volume = wear coefficient times it; null without clearance"},
      {.key = "energy_residual", .help = "largest |E - E(0) - work of the drives + losses| over the work turned over"},
      {.key = "steps", .help = "accepted integration steps", .integer = true},
      {.key = "rhs_evaluations", .help = "evaluations of the equations of motion", .integer = true},
  };
  return table;
}

std::vector<QuantityInfo> channel_table(const RpsupParameters& parameters) {
  const Rpsup rpsup = build_rpsup(parameters);
  std::vector<QuantityInfo> table;
  const SlidingWork sliding_work(parameters);
  for (Channel& channel : rpsup_channels(parameters, rpsup, sliding_work)) table.push_back(std::move(channel.info));
  for (QuantityInfo& pose : pose_channels(rpsup.mechanism.links)) table.push_back(std::move(pose));
  return table;
}

std::vector<Channel> rpsup_channels(const RpsupParameters& parameters, const Rpsup& rpsup, const SlidingWork& sliding_work) {
  const RpsupLayout& layout = rpsup.layout;
  const FrameIndex slider = layout.slider;
  const bool clearance = parameters.c_r > 0.0;
  std::vector<Channel> channels{
      {.info = {.key = "t_s", .help = "time"}, .read = [](const Evaluation& at) { return at.t; }},
      {.info = {.key = "crank_angle_rad", .help = "psi of link (1,1)"}, .read = position(layout.crank)},
      {.info = {.key = "crank_velocity_rad_s", .help = "its rate"}, .read = rate(layout.crank)},
      {.info = {.key = "rod_displacement_m", .help = "z of link (1,2)"}, .read = position(layout.rod)},
      {.info = {.key = "slider_position_m", .help = "z of link (2,1)"}, .read = position(slider)},
      {.info = {.key = "slider_velocity_m_s", .help = "its rate"}, .read = rate(slider)},
      {.info = {.key = "slider_acceleration_m_s2", .help = "its second derivative"},
       .read = [slider](const Evaluation& at) { return at.qdd[slider]; }},
      {.info = {.key = "slider_acceleration_min_m_s2", .help = "least since the last sample"}, .kind = Channel::Kind::kLeastAcceleration,
       .coordinate = slider},
      {.info = {.key = "slider_acceleration_max_m_s2", .help = "largest since the last sample"}, .kind = Channel::Kind::kLargestAcceleration,
       .coordinate = slider},
      {.info = {.key = "journal_x_mm", .help = "journal centre in the bearing frame"}, .read = journal_mm(0)},
      {.info = {.key = "journal_y_mm", .help = "journal centre in the bearing frame"}, .read = journal_mm(1)},
      {.info = {.key = "journal_z_mm", .help = "journal centre in the bearing frame, along its axis"}, .read = journal_mm(2)},
      {.info = {.key = "journal_tilt_mrad", .help = "angle between the axes of journal and bearing"},
       .read = [](const Evaluation& at) { return 1e3 * calc_tilt(at.joints[0].journal); }},
      {.info = {.key = "contact_force_n", .help = "sum of the radial normal forces; null without clearance"},
       .read = clearance ? radial_force : none},
      {.info = {.key = "friction_force_n", .help = "sum of the friction forces' magnitudes; null without clearance"},
       .read = clearance ? friction_force : none},
      {.info = {.key = "crank_torque_n_m", .help = "driving torque of the crank"}, .read = crank_torque},
      {.info = {.key = "rod_force_n", .help = "driving force of the telescoping rod"}, .read = rod_force},
      {.info = {.key = "reaction_x_n", .help = "force of the coupler on the cross link, in the global frame"}, .read = reaction_along(0)},
      {.info = {.key = "reaction_y_n", .help = "force of the coupler on the cross link, in the global frame"}, .read = reaction_along(1)},
      {.info = {.key = "reaction_z_n", .help = "force of the coupler on the cross link, in the global frame"}, .read = reaction_along(2)},
      {.info = {.key = "coupler_deflection_mm", .help = "of the bearing's centre from where the undeformed coupler would hold it"},
       .read = [&parameters, &rpsup](const Evaluation& at) { return 1e3 * calc_deflection(parameters, rpsup, at); }},
      {.info = {.key = "kinetic_energy_j", .help = "of all links"}, .read = [](const Evaluation& at) { return at.energy.kinetic; }},
      {.info = {.key = "potential_energy_j", .help = "of gravity, the flexible links' springs and the elastic part of the contact"},
       .read = [](const Evaluation& at) { return at.energy.potential; }},
      {.info = {.key = "drive_work_j", .help = "of both drives since t = 0"},
       .read = [](const Evaluation& at) { return at.energy.drive_work.sum(); }},
      {.info = {.key = "energy_residual", .help = "(E - E(0) - work of the drives + losses) over the work turned over in the whole run"},
       .kind = Channel::Kind::kImbalance},
  };
  for (const BentLink& link : layout.bent)
    channels.push_back({.info = {.key = link.name + "_deflection_mm", .help = "of the link's end from where the undeformed link would hold it"},
                        .read = [&link](const Evaluation& at) { return 1e3 * calc_deflection(link, at); }});
  for (int ring = 0; ring < parameters.radial_levels; ++ring) add_sliding_work(ring, parameters, sliding_work, channels);
  return channels;
}

Measured rpsup_measured(const RpsupParameters& parameters, const RpsupLayout& layout) {
  return {.accelerations = {layout.slider}, .loads = {radial_force, penetration, crank_torque, rod_force, reaction}, .contacts = {0},
          .steady_from = parameters.run_up};
}

std::vector<double> calc_rpsup_metrics(const RpsupParameters& parameters, const RunMetrics& metrics, const SlidingWork& sliding_work,
                                       const RunEnd& end, const std::optional<Peak>& ideal) {
  const bool has_steady = metrics.steady_time() > 0.0;
  const bool has_clearance = parameters.c_r > 0.0;
  const double ideal_peak = ideal ? ideal->magnitude : kNone;
  const RunMetrics::Acceleration& slider = metrics.acceleration(0);
  return {
      has_steady ? slider.steady.magnitude : kNone,
      has_steady ? slider.steady.t : kNone,
      slider.whole_run.magnitude,
      metrics.calc_rms(0),
      ideal_peak,
      has_steady && ideal_peak > 0.0 ? slider.steady.magnitude / ideal_peak : kNone,
      has_clearance ? metrics.largest_load(0) : kNone,
      has_clearance ? 1e6 * metrics.largest_load(1) : kNone,
      static_cast<double>(metrics.onsets()),
      has_clearance ? metrics.contact_time(0) / end.t : kNone,
      metrics.largest_load(2),
      metrics.largest_load(3),
      metrics.largest_load(4),
      metrics.last_energy().friction_loss,
      metrics.last_energy().impact_loss,
      metrics.last_energy().structural_loss,
      has_clearance ? sliding_work.total() : kNone,
      metrics.calc_energy_residual(),
      static_cast<double>(end.steps),
      static_cast<double>(end.evaluations),
  };
}

}  // namespace engine
