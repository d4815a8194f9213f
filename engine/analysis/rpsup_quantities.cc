// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/rpsup_quantities.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/analysis/actuator_readings.h"

namespace engine {

namespace {

double radial_force(const Evaluation& at) { return at.joints[0].load.radial_normal_sum; }
double penetration(const Evaluation& at) { return at.joints[0].load.max_penetration; }
double friction_force(const Evaluation& at) { return at.joints[0].load.friction_sum; }
double reaction(const Evaluation& at) { return at.joints[0].reaction_W.norm(); }
double none(const Evaluation&) { return kNoValue; }
double zero(const Evaluation&) { return 0.0; }

/// Measured::loads of an RPSUP linkage.
enum class Load : std::size_t {
  kContactForce,
  kPenetration,
  kFrictionForce,
  kCrankTorque,
  kRodForce,
  kReaction,
  kCrankCurrent,
  kCrankElectricWork,
  kRodCurrent,
  kRodElectricWork,
};

/// The readings of an actuated coordinate's actuator; of a driven one only the drive's force.
ActuatorReadings drive_readings(const Mechanism& mechanism, FrameIndex coordinate) {
  std::vector<ActuatorReadings> actuators = find_actuator_readings(mechanism, coordinate);
  if (!actuators.empty()) return actuators.front();
  const auto drive = std::ranges::find(mechanism.drives, coordinate, &Drive::coordinate);
  const auto index = static_cast<Eigen::Index>(drive - mechanism.drives.begin());
  return {.force = [index](const Evaluation& at) { return at.drive_force[index]; }};
}

double calc_deflection(const RpsupParameters& parameters, const Rpsup& rpsup, const Evaluation& at) {
  const CutJoint& joint = rpsup.mechanism.cut_joints[0];
  const FrameMotion& root = at.frames[static_cast<std::size_t>(rpsup.layout.coupler)];
  const FrameMotion& end = at.frames[static_cast<std::size_t>(joint.bearing_frame)];
  const Eigen::Vector3d undeformed = root.p + root.R.col(0) * parameters.coupler_length;
  return (end.p + end.R * joint.bearing.p - undeformed).norm();
}

/// Of a link's end from where the undeformed link would hold it, [m]
double calc_deflection(const BentLink& link, const Evaluation& at) {
  const auto point_at = [&at](const BodyFrames::Part& part, double along) -> Eigen::Vector3d {
    const FrameMotion& frame = at.frames[static_cast<std::size_t>(part.frame)];
    return frame.p + frame.R * (part.placement.p + along * part.placement.R.col(0));
  };
  return (point_at(link.tip, link.length - link.tip.begin) - point_at(link.root, link.length)).norm();
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

/// Adds a channel that is read at an instant. The info has a name: g++ 12 would destroy its strings twice if
/// the channel could not be made.
void add_reading(std::vector<Channel>& channels, std::string key, std::string help, Reading read,
                 std::string symbol = {}) {
  QuantityInfo info{.key = std::move(key), .help = std::move(help), .symbol = std::move(symbol)};
  channels.push_back({.info = std::move(info), .read = std::move(read)});
}

/// Adds the channels of the least and the largest value of a load between samples. @param exists  else null
void add_extremes(std::vector<Channel>& channels, const std::string& stem, const std::string& unit,
                  const Reading& read, Load load, bool exists = true) {
  for (Channel& channel :
       extreme_channels(stem, unit, read, Channel::Kind::kLeastLoad, static_cast<std::size_t>(load))) {
    if (!exists) {
      channel.kind = Channel::Kind::kReading;
      channel.read = none;
    }
    channels.push_back(std::move(channel));
  }
}

void add_slider_channels(FrameIndex slider, std::vector<Channel>& channels) {
  add_reading(channels, "slider_position_m", "Position of the slider, link (2,1), along its guide",
              position(slider), "z^(2,1)");
  add_reading(channels, "slider_velocity_m_s", "Velocity of the slider", rate(slider), "ż^(2,1)");
  const Reading acceleration = [slider](const Evaluation& at) { return at.qdd[slider]; };
  add_reading(channels, "slider_acceleration_m_s2", "Acceleration of the slider", acceleration, "z̈^(2,1)");
  for (Channel& channel :
       extreme_channels("slider_acceleration", "_m_s2", acceleration, Channel::Kind::kLeastAcceleration,
                        static_cast<std::size_t>(slider)))
    channels.push_back(std::move(channel));
}

/// Time and the motion of crank, rod and slider.
void add_motion_channels(const RpsupLayout& layout, std::vector<Channel>& channels) {
  add_reading(channels, "t_s", "Time", [](const Evaluation& at) { return at.t; }, "t");
  add_reading(channels, "crank_angle_rad", "Angle of the crank, link (1,1)", position(layout.crank),
              "ψ^(1,1)");
  add_reading(channels, "crank_velocity_rad_s", "Angular velocity of the crank", rate(layout.crank),
              "ψ̇^(1,1)");
  add_reading(channels, "rod_displacement_m",
              "Displacement of the sliding rod, link (1,2), along the crank", position(layout.rod),
              "z^(1,2)");
  add_slider_channels(layout.slider, channels);
}

/// Adds the channels of a motor that moves crank or rod.
void add_motor_channels(const std::string& link, const ActuatorReadings& motor, Load current,
                        std::vector<Channel>& channels) {
  if (!motor.current) return;
  add_reading(channels, link + "_current_a", "Current of the " + link + "'s motor", motor.current);
  add_extremes(channels, link + "_current", "_a", motor.current, current);
  add_reading(channels, link + "_voltage_v", "Voltage of the supply of the " + link + "'s motor",
              motor.voltage);
  add_reading(channels, link + "_electric_work_j",
              "Electric work of the supply of the " + link + "'s motor since t = 0", motor.electric_work);
}

void add_journal_channels(std::vector<Channel>& channels) {
  add_reading(channels, "journal_x_mm", "Journal centre in the bearing frame {b}: x, across the axis",
              journal_mm(0));
  add_reading(channels, "journal_y_mm", "Journal centre in the bearing frame {b}: y, across the axis",
              journal_mm(1));
  add_reading(channels, "journal_z_mm", "Journal centre in the bearing frame {b}: z, along the axis",
              journal_mm(2));
  add_reading(channels, "journal_tilt_mrad", "Angle between the axes of journal and bearing",
              [](const Evaluation& at) { return 1e3 * calc_tilt(at.joints[0].journal); });
}

void add_contact_channels(bool clearance, std::vector<Channel>& channels) {
  add_reading(channels, "contact_force_n",
              "Sum of the radial normal forces on the journal; null without clearance",
              clearance ? &radial_force : &none, "Σ f_n");
  add_extremes(channels, "contact_force", "_n", radial_force, Load::kContactForce, clearance);
  add_reading(channels, "friction_force_n",
              "Sum of the magnitudes of the friction forces on the journal; null without clearance",
              clearance ? &friction_force : &none, "Σ |f_t|");
  add_extremes(channels, "friction_force", "_n", friction_force, Load::kFrictionForce, clearance);
}

void add_drive_channels(const Rpsup& rpsup, std::vector<Channel>& channels) {
  const ActuatorReadings crank = drive_readings(rpsup.mechanism, rpsup.layout.crank),
                         rod = drive_readings(rpsup.mechanism, rpsup.layout.rod);
  add_reading(channels, "crank_torque_n_m", "Driving torque of the crank", crank.force);
  add_extremes(channels, "crank_torque", "_n_m", crank.force, Load::kCrankTorque);
  add_reading(channels, "rod_force_n", "Driving force of the sliding rod", rod.force);
  add_extremes(channels, "rod_force", "_n", rod.force, Load::kRodForce);
  add_motor_channels("crank", crank, Load::kCrankCurrent, channels);
  add_motor_channels("rod", rod, Load::kRodCurrent, channels);
}

void add_reaction_channels(std::vector<Channel>& channels) {
  add_reading(channels, "reaction_x_n", "Force of the coupler on the cross link: x in the global frame",
              reaction_along(0));
  add_reading(channels, "reaction_y_n", "Force of the coupler on the cross link: y in the global frame",
              reaction_along(1));
  add_reading(channels, "reaction_z_n", "Force of the coupler on the cross link: z in the global frame",
              reaction_along(2));
  add_reading(channels, "joint_reaction_n", "Magnitude of the force of the coupler on the cross link",
              reaction);
  add_extremes(channels, "joint_reaction", "_n", reaction, Load::kReaction);
}

/// Motion and loads of the joint between coupler and cross link, and the drives' forces.
void add_joint_channels(const Rpsup& rpsup, bool clearance, std::vector<Channel>& channels) {
  add_journal_channels(channels);
  add_contact_channels(clearance, channels);
  add_drive_channels(rpsup, channels);
  add_reaction_channels(channels);
}

/// Deflections of the flexible links other than the coupler. @param links  must outlive the channels
void add_deflection_channels(const std::vector<BentLink>& links, std::vector<Channel>& channels) {
  for (const BentLink& link : links)
    add_reading(channels, link.name + "_deflection_mm",
                "Distance of the link's end from its place on the undeformed link",
                [&link](const Evaluation& at) { return 1e3 * calc_deflection(link, at); });
}

/// The energy account.
void add_energy_channels(std::vector<Channel>& channels) {
  add_reading(channels, "kinetic_energy_j",
              "Kinetic energy of all links, and of rotors and windings of motors",
              [](const Evaluation& at) { return at.energy.kinetic; });
  add_reading(channels, "potential_energy_j",
              "Potential energy of gravity, of the flexible links' springs and of the elastic contact",
              [](const Evaluation& at) { return at.energy.potential; });
  add_reading(channels, "drive_work_j", "Work of both drives since t = 0",
              [](const Evaluation& at) { return at.energy.drive_work.sum(); });
  channels.push_back(
      {.info = {.key = "energy_residual",
                .help = "E − E(0) − work of the drives + losses, divided by the largest of: work turned over "
                        "in the whole run, kinetic energy, change of potential energy"},
       .kind = Channel::Kind::kImbalance});
}

}  // namespace

std::span<const QuantityInfo> metric_table() {
  static const std::vector<QuantityInfo> table{
      {.key = "peak_slider_acceleration_m_s2",
       .help = "Largest magnitude of the slider's acceleration in the steady window (t ≥ run_up_s), sought "
               "inside every integration step",
       .symbol = "max |z̈^(2,1)|"},
      {.key = "peak_slider_acceleration_time_s", .help = "Time of peak_slider_acceleration_m_s2"},
      {.key = "peak_slider_acceleration_whole_run_m_s2",
       .help = "Largest magnitude of the slider's acceleration in the whole run"},
      {.key = "peak_slider_acceleration_whole_run_time_s",
       .help = "Time of peak_slider_acceleration_whole_run_m_s2"},
      {.key = "rms_slider_acceleration_m_s2",
       .help = "Root mean square of the slider's acceleration in the steady window (t ≥ run_up_s)"},
      {.key = "ideal_peak_slider_acceleration_m_s2",
       .help = "Largest magnitude of the slider's acceleration in the steady window, of the ideal linkage "
               "(rigid links, no clearance) with the same drives"},
      {.key = "ideal_peak_slider_acceleration_time_s", .help = "Time of ideal_peak_slider_acceleration_m_s2"},
      {.key = "amplification",
       .help = "Ratio of peak_slider_acceleration_m_s2 to ideal_peak_slider_acceleration_m_s2"},
      {.key = "peak_contact_force_n",
       .help =
           "Largest sum of the radial normal forces on the journal in the whole run; null without clearance",
       .symbol = "max Σ f_n"},
      {.key = "peak_contact_force_time_s", .help = "Time of peak_contact_force_n"},
      {.key = "max_penetration_um",
       .help =
           "Largest radial penetration of the journal into the bore in the whole run; null without clearance",
       .symbol = "max Δ"},
      {.key = "max_penetration_time_s", .help = "Time of max_penetration_um"},
      {.key = "impact_count",
       .help = "Number of onsets of radial contact in the whole run, counted for each ring of the journal",
       .integer = true},
      {.key = "contact_time_ratio",
       .help = "Fraction of the whole run in which the journal touches the bore; null without clearance"},
      {.key = "peak_crank_torque_n_m",
       .help = "Largest magnitude of the crank's driving torque in the whole run"},
      {.key = "peak_crank_torque_time_s", .help = "Time of peak_crank_torque_n_m"},
      {.key = "peak_rod_force_n",
       .help = "Largest magnitude of the sliding rod's driving force in the whole run"},
      {.key = "peak_rod_force_time_s", .help = "Time of peak_rod_force_n"},
      {.key = "mean_crank_velocity_rad_s",
       .help = "Mean angular velocity of the crank in the steady window (t ≥ run_up_s); null unless an "
               "actuator moves the crank"},
      {.key = "crank_speed_fluctuation",
       .help = "Coefficient of fluctuation of speed: difference of the crank's largest and least angular "
               "velocity by the magnitude of its mean one, in the steady window; null unless an actuator "
               "moves the crank"},
      {.key = "peak_crank_current_a",
       .help = "Largest magnitude of the current of the crank's motor in the whole run; null without motor"},
      {.key = "peak_crank_current_time_s", .help = "Time of peak_crank_current_a"},
      {.key = "peak_crank_electric_work_j",
       .help = "Largest magnitude of the electric work of the crank's motor since t = 0; null without motor"},
      {.key = "peak_crank_electric_work_time_s", .help = "Time of peak_crank_electric_work_j"},
      {.key = "peak_rod_current_a",
       .help = "Largest magnitude of the current of the rod's motor in the whole run; null without motor"},
      {.key = "peak_rod_current_time_s", .help = "Time of peak_rod_current_a"},
      {.key = "peak_rod_electric_work_j",
       .help = "Largest magnitude of the electric work of the rod's motor since t = 0; null without motor"},
      {.key = "peak_rod_electric_work_time_s", .help = "Time of peak_rod_electric_work_j"},
      {.key = "peak_joint_reaction_n",
       .help = "Largest magnitude of the force between coupler and cross link in the whole run"},
      {.key = "peak_joint_reaction_time_s", .help = "Time of peak_joint_reaction_n"},
      {.key = "friction_work_j",
       .help = "Work done against the friction force in the joint in the whole run, the energy of bent "
               "bristles included"},
      {.key = "impact_loss_j", .help = "Energy lost in the normal contact law in the whole run"},
      {.key = "structural_loss_j",
       .help = "Energy lost in the dampers of the flexible links and in motors in the whole run"},
      {.key = "sliding_work_j",
       .help = "Time integral of normal contact force × sliding speed over the whole run; by Archard's law "
               "worn volume = wear coefficient × sliding work; null without clearance"},
      {.key = "energy_residual",
       .help = "Largest |E − E(0) − work of the drives + losses|, divided by the largest of: work turned "
               "over in the whole run, kinetic energy, change of potential energy"},
      {.key = "steps", .help = "Number of accepted integration steps", .integer = true},
      {.key = "rhs_evaluations", .help = "Number of evaluations of the equations of motion", .integer = true},
  };
  return table;
}

std::vector<QuantityInfo> channel_table(const RpsupParameters& parameters) {
  const Rpsup rpsup = build_rpsup(parameters);
  std::vector<QuantityInfo> table;
  const SlidingWork sliding_work(parameters);
  for (Channel& channel : rpsup_channels(parameters, rpsup, sliding_work))
    table.push_back(std::move(channel.info));
  for (QuantityInfo& pose : pose_channels(rpsup.mechanism.links)) table.push_back(std::move(pose));
  return table;
}

std::vector<Channel> rpsup_channels(const RpsupParameters& parameters, const Rpsup& rpsup,
                                    const SlidingWork& sliding_work) {
  std::vector<Channel> channels;
  add_motion_channels(rpsup.layout, channels);
  add_joint_channels(rpsup, parameters.c_r > 0.0, channels);
  add_reading(channels, "coupler_deflection_mm",
              "Distance of the bearing's centre from its place on the undeformed coupler",
              [&parameters, &rpsup](const Evaluation& at) {
                return 1e3 * calc_deflection(parameters, rpsup, at);
              });
  add_energy_channels(channels);
  add_deflection_channels(rpsup.layout.bent, channels);
  std::ranges::move(sliding_work.channels(""), std::back_inserter(channels));
  return channels;
}

Measured rpsup_measured(const RpsupParameters& parameters, const Rpsup& rpsup) {
  const ActuatorReadings crank = drive_readings(rpsup.mechanism, rpsup.layout.crank),
                         rod = drive_readings(rpsup.mechanism, rpsup.layout.rod);
  Measured measured{.accelerations = {rpsup.layout.slider},
                    .velocities = {},
                    .loads = {radial_force, penetration, friction_force, crank.force, rod.force, reaction,
                              crank.current ? crank.current : zero,
                              crank.current ? crank.electric_work : zero,
                              rod.current ? rod.current : zero, rod.current ? rod.electric_work : zero},
                    .contacts = {{.joint = 0}},
                    .steady_from = parameters.run_up};
  if (parameters.crank_actuator) measured.velocities = {rpsup.layout.crank};
  return measured;
}

std::vector<double> calc_rpsup_metrics(const RpsupParameters& parameters, const RunMetrics& metrics,
                                       const SlidingWork& sliding_work, const RunOutcome& outcome,
                                       const std::optional<Peak>& ideal) {
  const bool has_steady = metrics.steady_time() > 0.0;
  const bool has_clearance = parameters.c_r > 0.0;
  const auto is_motor = [](const std::optional<Actuator>& actuator) {
    return actuator && std::holds_alternative<DcMotor>(*actuator);
  };
  const double ideal_peak = ideal ? ideal->magnitude : kNoValue;
  const RunMetrics::Acceleration& slider = metrics.acceleration(0);
  const auto peak = [&metrics](Load load) { return metrics.load_peak(static_cast<std::size_t>(load)); };
  const bool crank_has_motor = is_motor(parameters.crank_actuator);
  const bool rod_has_motor = is_motor(parameters.rod_actuator);
  return {
      has_steady ? slider.steady.magnitude : kNoValue,
      has_steady ? time_of(slider.steady) : kNoValue,
      slider.whole_run.magnitude,
      time_of(slider.whole_run),
      metrics.calc_rms(0),
      ideal_peak,
      ideal ? time_of(*ideal) : kNoValue,
      has_steady && ideal_peak > 0.0 ? slider.steady.magnitude / ideal_peak : kNoValue,
      has_clearance ? peak(Load::kContactForce).magnitude : kNoValue,
      has_clearance ? time_of(peak(Load::kContactForce)) : kNoValue,
      has_clearance ? 1e6 * peak(Load::kPenetration).magnitude : kNoValue,
      has_clearance ? time_of(peak(Load::kPenetration)) : kNoValue,
      static_cast<double>(metrics.onsets()),
      has_clearance ? metrics.contact_time(0) / outcome.t : kNoValue,
      peak(Load::kCrankTorque).magnitude,
      time_of(peak(Load::kCrankTorque)),
      peak(Load::kRodForce).magnitude,
      time_of(peak(Load::kRodForce)),
      parameters.crank_actuator ? metrics.calc_mean_velocity(0) : kNoValue,
      parameters.crank_actuator ? metrics.calc_speed_fluctuation(0) : kNoValue,
      crank_has_motor ? peak(Load::kCrankCurrent).magnitude : kNoValue,
      crank_has_motor ? time_of(peak(Load::kCrankCurrent)) : kNoValue,
      crank_has_motor ? peak(Load::kCrankElectricWork).magnitude : kNoValue,
      crank_has_motor ? time_of(peak(Load::kCrankElectricWork)) : kNoValue,
      rod_has_motor ? peak(Load::kRodCurrent).magnitude : kNoValue,
      rod_has_motor ? time_of(peak(Load::kRodCurrent)) : kNoValue,
      rod_has_motor ? peak(Load::kRodElectricWork).magnitude : kNoValue,
      rod_has_motor ? time_of(peak(Load::kRodElectricWork)) : kNoValue,
      peak(Load::kReaction).magnitude,
      time_of(peak(Load::kReaction)),
      metrics.last_energy().friction_loss,
      metrics.last_energy().impact_loss,
      metrics.last_energy().structural_loss,
      has_clearance ? sliding_work.total() : kNoValue,
      metrics.calc_energy_residual(),
      static_cast<double>(outcome.steps),
      static_cast<double>(outcome.evaluations),
  };
}

}  // namespace engine
