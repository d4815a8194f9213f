// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/linkage_quantities.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "engine/dynamics/spring_motion.h"
#include "engine/model/applied_force.h"

namespace engine {

namespace {

constexpr const char* kAxisNames[] = {"x", "y", "z"};

/// "joints.elbow" -> "the joint elbow"
std::string describe_source(std::string_view source) {
  if (source.empty()) return "every linkage";
  const std::size_t dot = source.find('.');
  const std::string_view kind = source.substr(0, dot);
  const char* const what = kind == "bodies"           ? "body"
                           : kind == "springs"        ? "spring"
                           : kind == "loads"          ? "load"
                           : kind == "accelerometers" ? "accelerometer"
                                                      : "joint";
  return std::string("the ") + what + " " + std::string(source.substr(dot + 1));
}

/// Ending of the key of a generalised force, and what the force is called.
/// @param is_translation  whether its coordinate is one; else it is a rotation
const char* force_unit(bool is_translation) { return is_translation ? "_n" : "_n_m"; }
const char* force_name(bool is_translation) { return is_translation ? "force" : "torque"; }

/// @param what  "channel" or "metric"  @param sources  one a quantity
std::optional<KeyClash> find_clash_of(const char* what, const std::vector<QuantityInfo>& table,
                                      const std::vector<std::string>& sources) {
  std::map<std::string_view, std::string_view> source_of;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const auto [entry, is_new] = source_of.emplace(table[k].key, sources[k]);
    if (is_new) continue;
    const bool named = !sources[k].empty();
    const std::string_view source(sources[k]);
    return KeyClash{.field = std::string(named ? source : entry->second),
                    .detail = std::string("makes the ") + what + " " + table[k].key + ", and so does " +
                              describe_source(named ? entry->second : source) +
                              ": give one of them another name"};
  }
  return std::nullopt;
}

/// Peak of the k-th acceleration in the steady window; null if the run does not come there.
Peak find_steady_peak(const RunMetrics& metrics, std::size_t k) {
  if (metrics.steady_time() > 0.0) return metrics.acceleration(k).steady;
  return {.magnitude = kNoValue, .t = kNoValue};
}

}  // namespace

LinkageQuantities::LinkageQuantities(const Linkage& linkage, const BuiltLinkage& built, double steady_from)
    : built_(built), reactions_(built.mechanism) {
  measured_.steady_from = steady_from;
  measured_.prepare = prepare();
  add_channel("t_s", "Time", [](const Evaluation& at) { return at.t; });
  add_joints(linkage.joints);
  for (std::size_t k = 0; k < linkage.springs.size(); ++k) add_spring(linkage.springs[k], k);
  for (std::size_t k = 0; k < linkage.loads.size(); ++k) add_body_load(linkage.loads[k], k);
  for (std::size_t k = 0; k < linkage.accelerometers.size(); ++k) add_accelerometer(linkage, k);
  source_.clear();
  add_energy_channels();
  add_run_metrics();
}

void LinkageQuantities::add_joints(const std::vector<LinkageJoint>& joints) {
  sliding_work_.reserve(joints.size());
  for (std::size_t k = 0; k < joints.size(); ++k) add_coordinates(joints[k], built_.joints[k]);
  for (std::size_t k = 0; k < joints.size(); ++k) add_joint(joints[k], built_.joints[k]);
}

void LinkageQuantities::add_coordinates(const LinkageJoint& joint, const BuiltJoint& built) {
  source_ = "joints." + joint.name;
  for (int i = 0; i < built.count; ++i)
    add_coordinate(joint.freedoms[static_cast<std::size_t>(i)], built.first + i);
}

Preparation LinkageQuantities::prepare() {
  return [this](const Evaluation& at) { reactions_.calc(at); };
}

void LinkageQuantities::add_channel(std::string key, std::string help, Reading read) {
  channels_.push_back({.info = {.key = std::move(key), .help = std::move(help)}, .read = std::move(read)});
  channel_sources_.push_back(source_);
}

void LinkageQuantities::add_channels(std::span<Channel> channels) {
  for (Channel& channel : channels) {
    channels_.push_back(std::move(channel));
    channel_sources_.push_back(source_);
  }
}

void LinkageQuantities::add_metric(QuantityInfo info, Result result) {
  metrics_.push_back(std::move(info));
  metric_sources_.push_back(source_);
  results_.push_back(std::move(result));
}

std::size_t LinkageQuantities::add_load(const std::string& stem, const std::string& unit, std::string help,
                                        double scale, Reading read) {
  const std::size_t load = measured_.loads.size();
  measured_.loads.push_back(std::move(read));
  add_peak(stem, unit, std::move(help), scale,
           [load](const RunMetrics& metrics) { return metrics.load_peak(load); });
  return load;
}

void LinkageQuantities::add_peak(const std::string& stem, const std::string& unit, std::string help,
                                 double scale, const std::function<Peak(const RunMetrics&)>& find) {
  add_metric({.key = stem + unit, .help = std::move(help)},
             [=](const RunMetrics& metrics, const auto&) { return scale * find(metrics).magnitude; });
  add_metric({.key = stem + "_time_s", .help = "Time of " + stem},
             [=](const RunMetrics& metrics, const auto&) { return time_of(find(metrics)); });
}

void LinkageQuantities::add_sampled_load(const std::string& stem, const std::string& unit, std::string help,
                                         std::string peak_help, const Reading& read) {
  add_channel(stem + unit, std::move(help), read);
  const std::size_t load = add_load("peak_" + stem, unit, std::move(peak_help), 1.0, read);
  add_extremes(stem, unit, read, Channel::Kind::kLeastLoad, load);
}

void LinkageQuantities::add_extremes(const std::string& stem, const std::string& unit, const Reading& read,
                                     Channel::Kind kind, std::size_t index) {
  auto extremes = extreme_channels(stem, unit, read, kind, index);
  add_channels(extremes);
}

bool LinkageQuantities::is_translation(FrameIndex coordinate) const {
  return built_.mechanism.coordinates[static_cast<std::size_t>(coordinate)].motion == Motion::kTranslation;
}

void LinkageQuantities::add_coordinate(const LinkageFreedom& freedom, FrameIndex i) {
  const std::string unit = is_translation(i) ? "_m" : "_rad";
  add_channel(freedom.name + unit, "Coordinate of the joint", [i](const Evaluation& at) { return at.q[i]; });
  add_channel(freedom.name + unit + "_s", "Rate of the joint's coordinate",
              [i](const Evaluation& at) { return at.qd[i]; });
  add_acceleration(freedom.name, unit + "_s2", i);
  if (freedom.drive) add_drive(freedom, i);
  if (freedom.actuator || freedom.load || freedom.friction) add_force_elements(freedom, i);
}

void LinkageQuantities::add_acceleration(const std::string& name, const std::string& unit, FrameIndex i) {
  const Reading acceleration = [i](const Evaluation& at) { return at.qdd[i]; };
  add_channel(name + unit, "Acceleration of the joint's coordinate", acceleration);
  add_extremes(name, unit, acceleration, Channel::Kind::kLeastAcceleration, static_cast<std::size_t>(i));
  add_acceleration_metrics(name + "_acceleration", unit, i);
}

void LinkageQuantities::add_acceleration_metrics(const std::string& stem, const std::string& unit,
                                                 FrameIndex i) {
  const std::size_t k = measured_.accelerations.size();
  measured_.accelerations.push_back(i);
  add_peak("peak_" + stem, unit,
           "Largest magnitude of the coordinate's acceleration in the steady window (t ≥ run_up_s), sought "
           "inside every integration step",
           1.0, [k](const RunMetrics& metrics) { return find_steady_peak(metrics, k); });
  add_peak("peak_" + stem + "_whole_run", unit,
           "Largest magnitude of the coordinate's acceleration in the whole run", 1.0,
           [k](const RunMetrics& metrics) { return metrics.acceleration(k).whole_run; });
  add_metric(
      {.key = "rms_" + stem + unit,
       .help = "Root mean square of the coordinate's acceleration in the steady window (t ≥ run_up_s)"},
      [k](const RunMetrics& metrics, const auto&) { return metrics.calc_rms(k); });
}

void LinkageQuantities::add_drive(const LinkageFreedom& freedom, FrameIndex i) {
  const std::vector<Drive>& drives = built_.mechanism.drives;
  Eigen::Index drive = 0;
  while (drives[static_cast<std::size_t>(drive)].coordinate != i) ++drive;
  add_driving_force(freedom.name, i, [drive](const Evaluation& at) { return at.drive_force[drive]; });
}

void LinkageQuantities::add_driving_force(const std::string& name, FrameIndex i, const Reading& force) {
  const std::string what = force_name(is_translation(i));
  add_sampled_load(name + "_drive", force_unit(is_translation(i)), "Driving " + what + " of the coordinate",
                   "Largest magnitude of the coordinate's driving " + what + " in the whole run", force);
}

void LinkageQuantities::add_force_elements(const LinkageFreedom& freedom, FrameIndex i) {
  std::vector<ActuatorReadings> readings = find_actuator_readings(built_.mechanism, i);
  if (freedom.friction) {
    add_friction(freedom, i, readings.back().force);
    readings.pop_back();
  }
  if (freedom.load)
    add_channel(freedom.name + "_load" + force_unit(is_translation(i)),
                std::string("Load on the coordinate: ") + force_name(is_translation(i)) + " by its law",
                readings.back().force);
  if (freedom.actuator) add_actuator(freedom.name, i, readings.front());
}

void LinkageQuantities::add_friction(const LinkageFreedom& freedom, FrameIndex i, const Reading& force) {
  const std::string what = force_name(is_translation(i));
  add_sampled_load(freedom.name + "_friction", force_unit(is_translation(i)),
                   "Friction in the joint: " + what + " on the coordinate",
                   "Largest magnitude of the joint's friction " + what + " in the whole run", force);
  if (freedom.friction->by_reaction) add_normal_force(freedom, i);
}

void LinkageQuantities::add_actuator(const std::string& name, FrameIndex i,
                                     const ActuatorReadings& actuator) {
  const std::string what = force_name(is_translation(i));
  add_driving_force(name, i, actuator.force);
  add_sampled_load(name + "_drive_power", "_w", "Power of the driving " + what,
                   "Largest magnitude of the power of the driving " + what + " in the whole run",
                   actuator.power);
  if (actuator.current) add_motor(name, actuator);
  add_speed(name, i);
}

void LinkageQuantities::add_motor(const std::string& name, const ActuatorReadings& motor) {
  add_sampled_load(name + "_current", "_a", "Current of the motor",
                   "Largest magnitude of the motor's current in the whole run", motor.current);
  add_channel(name + "_voltage_v", "Voltage of the motor's supply", motor.voltage);
  add_channel(name + "_electric_work_j", "Electric work of the motor's supply since t = 0",
              motor.electric_work);
  add_load("peak_" + name + "_electric_work", "_j",
           "Largest magnitude of the electric work of the motor's supply since t = 0", 1.0,
           motor.electric_work);
}

void LinkageQuantities::add_speed(const std::string& name, FrameIndex i) {
  const std::size_t k = measured_.velocities.size();
  measured_.velocities.push_back(i);
  add_metric({.key = "mean_" + name + (is_translation(i) ? "_velocity_m_s" : "_velocity_rad_s"),
              .help = "Mean velocity of the coordinate in the steady window (t ≥ run_up_s)"},
             [k](const RunMetrics& metrics, const auto&) {
               return metrics.calc_mean_velocity(k);
             });
  add_metric({.key = name + "_speed_fluctuation",
              .help = "Coefficient of fluctuation of speed: difference of the coordinate's largest and least "
                      "velocity by the magnitude of its mean velocity, in the steady window"},
             [k](const RunMetrics& metrics, const auto&) {
               return metrics.calc_speed_fluctuation(k);
             });
}

void LinkageQuantities::add_normal_force(const LinkageFreedom& freedom, FrameIndex i) {
  const std::vector<Actuation>& actuations = built_.mechanism.actuations;
  const auto found = std::ranges::find_if(actuations, [i](const Actuation& actuation) {
    return actuation.coordinate == i && std::holds_alternative<JointFriction>(actuation.element);
  });
  const Eigen::Index index = found - actuations.begin();
  add_channel(freedom.name + "_normal_force_n", "Normal force of the joint's friction: preload and reaction",
              [index, preload = freedom.friction->normal_force](const Evaluation& at) {
                return preload + at.friction_reaction[index];
              });
}

void LinkageQuantities::add_joint(const LinkageJoint& joint, const BuiltJoint& built) {
  source_ = "joints." + joint.name;
  if (built.cut >= 0) {
    const auto cut = static_cast<std::size_t>(built.cut);
    add_reaction(joint, [cut](const Evaluation& at) {
      return Wrench{at.joints[cut].reaction_W, at.joints[cut].moment_W};
    });
    if (joint.clearance) add_clearance(joint, cut);
  } else if (built.count > 0) {
    const FrameIndex last = built.first + built.count - 1;
    add_reaction(joint, [this, last](const Evaluation&) { return reactions_.of(last); });
  }
}

void LinkageQuantities::add_reaction(const LinkageJoint& joint,
                                     const std::function<Wrench(const Evaluation&)>& wrench) {
  const std::string of = " of the joint on its second body: ";
  for (int axis = 0; axis < 3; ++axis)
    add_channel(joint.name + "_force_" + kAxisNames[axis] + "_n",
                "Force" + of + kAxisNames[axis] + " in the global frame",
                [=](const Evaluation& at) { return wrench(at).force[axis]; });
  for (int axis = 0; axis < 3; ++axis)
    add_channel(joint.name + "_moment_" + kAxisNames[axis] + "_n_m",
                "Moment" + of + kAxisNames[axis] + " in the global frame",
                [=](const Evaluation& at) { return wrench(at).moment[axis]; });
  add_sampled_load(joint.name + "_reaction", "_n", "Magnitude of the force in the joint",
                   "Largest magnitude of the force in the joint in the whole run",
                   [=](const Evaluation& at) { return wrench(at).force.norm(); });
}

void LinkageQuantities::add_clearance(const LinkageJoint& joint, std::size_t cut) {
  add_journal_motion(joint.name, cut);
  add_radial_contact(joint.name, cut);
  if (joint.clearance->geometry == ContactGeometry::kJournalInBore) add_sliding_work(joint, cut);
  if (std::isfinite(joint.clearance->c_a)) add_face_contact(joint.name, cut);
}

void LinkageQuantities::add_journal_motion(const std::string& name, std::size_t cut) {
  for (int axis = 0; axis < 3; ++axis)
    add_channel(name + "_journal_" + kAxisNames[axis] + "_mm",
                std::string("Journal centre in the bearing frame: ") + kAxisNames[axis],
                [=](const Evaluation& at) { return 1e3 * at.joints[cut].journal.p_bj[axis]; });
  add_channel(name + "_journal_tilt_mrad", "Angle between the axes of journal and bearing",
              [=](const Evaluation& at) { return 1e3 * calc_tilt(at.joints[cut].journal); });
}

void LinkageQuantities::add_radial_contact(const std::string& name, std::size_t cut) {
  add_sampled_load(name + "_contact_force", "_n", "Sum of the radial normal forces on the journal",
                   "Largest sum of the radial normal forces on the journal in the whole run",
                   [=](const Evaluation& at) { return at.joints[cut].load.radial_normal_sum; });
  add_sampled_load(name + "_friction_force", "_n",
                   "Sum of the magnitudes of the friction forces on the journal",
                   "Largest sum of the magnitudes of the friction forces on the journal in the whole run",
                   [=](const Evaluation& at) { return at.joints[cut].load.friction_sum; });
  add_load("max_" + name + "_penetration", "_um",
           "Largest radial penetration of the journal into the bore in the whole run", 1e6,
           [=](const Evaluation& at) { return at.joints[cut].load.max_penetration; });
  add_contact_time(name + "_contact_time_ratio",
                   "Fraction of the whole run in which the journal touches the bore", {.joint = cut});
}

void LinkageQuantities::add_face_contact(const std::string& name, std::size_t cut) {
  add_sampled_load(name + "_face_force", "_n",
                   "Sum of the normal forces of the shoulders on the journal's faces",
                   "Largest sum of the normal forces of the shoulders on the journal's faces in the whole "
                   "run",
                   [=](const Evaluation& at) { return at.joints[cut].load.face_normal_sum; });
  add_contact_time(name + "_face_contact_time_ratio",
                   "Fraction of the whole run in which a face of the journal touches its shoulder",
                   {.joint = cut, .of_faces = true});
}

void LinkageQuantities::add_sliding_work(const LinkageJoint& joint, std::size_t cut) {
  const SlidingWork& work = sliding_work_.emplace_back(*joint.clearance, cut);
  auto of_rings = work.channels(joint.name + "_");
  add_channels(of_rings);
  add_metric({.key = joint.name + "_sliding_work_j",
              .help = "Time integral of normal contact force × sliding speed over the whole run; by "
                      "Archard's law worn volume = wear coefficient × sliding work"},
             [&work](const auto&, const auto&) { return work.total(); });
}

void LinkageQuantities::add_contact_time(const std::string& key, const char* help,
                                         Measured::Contact contact) {
  const std::size_t index = measured_.contacts.size();
  measured_.contacts.push_back(contact);
  add_metric({.key = key, .help = help}, [=](const RunMetrics& metrics, const RunOutcome& outcome) {
    return metrics.contact_time(index) / outcome.t;
  });
}

void LinkageQuantities::add_spring(const LinkageSpring& spring, std::size_t index) {
  source_ = "springs." + spring.name;
  const auto motion = [this, index](const Evaluation& at) {
    return calc_spring_motion(built_.mechanism.springs[index], at.frames);
  };
  add_channel(spring.name + "_length_m", "Distance of the spring's ends",
              [motion](const Evaluation& at) { return motion(at).length; });
  add_sampled_load(spring.name + "_tension", "_n", "Tension of the spring with its damper",
                   "Largest magnitude of the spring's tension in the whole run",
                   [motion](const Evaluation& at) { return motion(at).tension; });
}

void LinkageQuantities::add_body_load(const LinkageLoad& load, std::size_t index) {
  source_ = "loads." + load.name;
  const bool is_force = !load.force.isZero(0.0);
  const auto behind = static_cast<Eigen::Index>(list_applied_forces(built_.mechanism).size() + index);
  add_channel(load.name + (is_force ? "_n" : "_n_m"),
              is_force ? "Force of the load, by its law" : "Moment of the load, by its law",
              [behind](const Evaluation& at) { return at.applied_force[behind]; });
}

void LinkageQuantities::add_accelerometer(const Linkage& linkage, std::size_t index) {
  const std::string& name = linkage.accelerometers[index].name;
  source_ = "accelerometers." + name;
  add_sampled_load(name + "_accelerometer", "_m_s2", "Acceleration that the accelerometer shows",
                   "Largest magnitude of the acceleration that the accelerometer shows in the whole run",
                   make_accelerometer_reading(linkage, index));
}

Reading LinkageQuantities::make_accelerometer_reading(const Linkage& linkage, std::size_t index) const {
  const LinkageAccelerometer& one = linkage.accelerometers[index];
  return [this, &place = built_.accelerometers[index], ground = linkage.ground_acceleration,
          gravity = linkage.gravity_W, follows_body = one.follows_body,
          shows_gravity = one.shows_gravity](const Evaluation& at) {
    const FrameMotion& body = reactions_.motion(place.frame);
    const Eigen::Vector3d arm = body.R * place.at;
    Eigen::Vector3d a = body.vd + body.wd.cross(arm) + body.w.cross(body.w.cross(arm));
    if (!shows_gravity) a += gravity;
    for (int axis = 0; axis < 3; ++axis)
      if (const auto& law = ground[static_cast<std::size_t>(axis)]) a[axis] += calc_signal(*law, at.t).value;
    return a.dot(follows_body ? Eigen::Vector3d(body.R * place.direction) : place.direction);
  };
}

void LinkageQuantities::add_energy_channels() {
  add_channel("kinetic_energy_j", "Kinetic energy of all bodies, and of rotors and windings of motors",
              [](const Evaluation& at) { return at.energy.kinetic; });
  add_channel("potential_energy_j", "Potential energy of gravity, of springs and of the elastic contacts",
              [](const Evaluation& at) { return at.energy.potential; });
  add_channel("drive_work_j", "Work of all drives and loads since t = 0",
              [](const Evaluation& at) { return at.energy.drive_work.sum(); });
  channels_.push_back(
      {.info = {.key = "energy_imbalance_j", .help = "E − E(0) − work of the drives + losses"},
       .kind = Channel::Kind::kImbalance});
  channel_sources_.push_back(source_);
}

void LinkageQuantities::add_run_metrics() {
  add_metric(
      {.key = "impact_count",
       .help = "Number of onsets of radial contact in the whole run, counted for each ring of each journal",
       .integer = true},
      [](const RunMetrics& metrics, const auto&) { return static_cast<double>(metrics.onsets()); });
  add_metric({.key = "face_impact_count",
              .help = "Number of onsets of contact of a journal's face with its shoulder in the whole run",
              .integer = true},
             [](const RunMetrics& metrics, const auto&) {
               return static_cast<double>(metrics.face_onsets());
             });
  add_metric({.key = "friction_work_j",
              .help = "Work done against the friction forces in the joints in the whole run, the energy of "
                      "bent bristles included"},
             [](const RunMetrics& metrics, const auto&) { return metrics.last_energy().friction_loss; });
  add_metric({.key = "impact_loss_j", .help = "Energy lost in the normal contact law in the whole run"},
             [](const RunMetrics& metrics, const auto&) { return metrics.last_energy().impact_loss; });
  add_metric({.key = "structural_loss_j",
              .help = "Energy lost in dampers, including those of flexible bodies, and in motors in the "
                      "whole run"},
             [](const RunMetrics& metrics, const auto&) { return metrics.last_energy().structural_loss; });
  add_metric({.key = "energy_imbalance_j",
              .help = "Largest |E − E(0) − work of the drives + losses| in the whole run"},
             [](const RunMetrics& metrics, const auto&) { return metrics.largest_imbalance(); });
  add_metric({.key = "energy_residual",
              .help = "energy_imbalance_j, divided by the largest of: work turned over in the whole run, "
                      "kinetic energy, change of potential energy; null if nothing moves"},
             [](const RunMetrics& metrics, const auto&) { return metrics.calc_energy_residual(); });
  add_metric(
      {.key = "redundant_constraints",
       .help = "Number of constraint equations that follow from others; reactions are then the smallest that "
               "satisfy the equations of motion",
       .integer = true},
      [](const auto&, const RunOutcome& outcome) {
        return static_cast<double>(outcome.redundant_constraints);
      });
  add_metric({.key = "steps", .help = "Number of accepted integration steps", .integer = true},
             [](const auto&, const RunOutcome& outcome) { return static_cast<double>(outcome.steps); });
  add_metric(
      {.key = "rhs_evaluations", .help = "Number of evaluations of the equations of motion", .integer = true},
      [](const auto&, const RunOutcome& outcome) { return static_cast<double>(outcome.evaluations); });
}

std::vector<QuantityInfo> LinkageQuantities::channel_table() const {
  std::vector<QuantityInfo> table;
  for (const Channel& channel : channels_) table.push_back(channel.info);
  for (QuantityInfo& pose : pose_channels(built_.mechanism.links)) table.push_back(std::move(pose));
  return table;
}

std::optional<KeyClash> LinkageQuantities::find_key_clash() const {
  const std::vector<QuantityInfo> table = channel_table();
  std::vector<std::string> sources = channel_sources_;
  const auto poses_of_one = (table.size() - sources.size()) / built_.mechanism.links.size();
  for (const NamedFrame& link : built_.mechanism.links)  // "rod,2" is an element of the beam rod
    sources.insert(sources.end(), poses_of_one, "bodies." + link.name.substr(0, link.name.find(',')));
  const auto clash = find_clash_of("channel", table, sources);
  return clash ? clash : find_clash_of("metric", metrics_, metric_sources_);
}

std::vector<double> LinkageQuantities::calc_metrics(const RunMetrics& metrics,
                                                    const RunOutcome& outcome) const {
  std::vector<double> values;
  for (const Result& result : results_) values.push_back(result(metrics, outcome));
  return values;
}

}  // namespace engine
