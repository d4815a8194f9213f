// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/analysis/actuator_readings.h"
#include "engine/dynamics/joint_reactions.h"
#include "engine/analysis/run_channels.h"
#include "engine/analysis/run_metrics.h"
#include "engine/analysis/sliding_work.h"
#include "engine/integrate/run_outcome.h"
#include "engine/model/linkage.h"

namespace engine {

/// Two channels or two metrics of one key, to which names such as "elbow" with its drive and "elbow_drive_n"
/// lead.
struct KeyClash {
  std::string field;   ///< "joints.NAME", "springs.NAME" or "bodies.NAME", as of InvalidInput
  std::string detail;  ///< the key and what else has it
};

/// Channels and metrics of a described linkage, by the names of its joints: coordinates and
/// drives, reactions of all joints, clearance joints, poses of the bodies.
class LinkageQuantities {
 public:
  /// @param linkage, built  must outlive what is made of them
  LinkageQuantities(const Linkage& linkage, const BuiltLinkage& built, double steady_from);
  LinkageQuantities(const LinkageQuantities&) = delete;
  LinkageQuantities& operator=(const LinkageQuantities&) = delete;

  [[nodiscard]] const std::vector<Channel>& channels() const { return channels_; }
  [[nodiscard]] const Measured& measured() const { return measured_; }
  [[nodiscard]] Preparation prepare();
  /// Sliding work in each joint with a bore: channels and metrics read it, a run moves it on.
  [[nodiscard]] std::span<SlidingWork> sliding_work() { return sliding_work_; }
  /// All channels, those of the poses with them.
  [[nodiscard]] std::vector<QuantityInfo> channel_table() const;
  [[nodiscard]] const std::vector<QuantityInfo>& metric_table() const { return metrics_; }
  [[nodiscard]] std::optional<KeyClash> find_key_clash() const;

  /// In the order of metric_table(). @param metrics  of measured()
  [[nodiscard]] std::vector<double> calc_metrics(const RunMetrics& metrics, const RunOutcome& outcome) const;

 private:
  [[nodiscard]] bool is_translation(FrameIndex coordinate) const;
  void add_joints(const std::vector<LinkageJoint>& joints);
  void add_coordinates(const LinkageJoint& joint, const BuiltJoint& built);
  void add_coordinate(const LinkageFreedom& freedom, FrameIndex coordinate);
  void add_acceleration(const std::string& name, const std::string& unit, FrameIndex coordinate);
  void add_acceleration_metrics(const std::string& stem, const std::string& unit, FrameIndex coordinate);
  void add_normal_force(const LinkageFreedom& freedom, FrameIndex coordinate);
  void add_drive(const LinkageFreedom& freedom, FrameIndex coordinate);
  void add_driving_force(const std::string& name, FrameIndex coordinate, const Reading& force);
  void add_force_elements(const LinkageFreedom& freedom, FrameIndex coordinate);
  void add_friction(const LinkageFreedom& freedom, FrameIndex coordinate, const Reading& force);
  void add_actuator(const std::string& name, FrameIndex coordinate, const ActuatorReadings& readings);
  void add_motor(const std::string& name, const ActuatorReadings& readings);
  void add_speed(const std::string& name, FrameIndex coordinate);
  void add_joint(const LinkageJoint& joint, const BuiltJoint& built);
  void add_reaction(const LinkageJoint& joint, const std::function<Wrench(const Evaluation&)>& wrench);
  void add_clearance(const LinkageJoint& joint, std::size_t cut);
  void add_journal_motion(const std::string& name, std::size_t cut);
  void add_radial_contact(const std::string& name, std::size_t cut);
  void add_face_contact(const std::string& name, std::size_t cut);
  void add_sliding_work(const LinkageJoint& joint, std::size_t cut);
  void add_contact_time(const std::string& key, const char* help, Measured::Contact contact);
  void add_spring(const LinkageSpring& spring, std::size_t index);
  void add_body_load(const LinkageLoad& load, std::size_t index);
  void add_accelerometer(const Linkage& linkage, std::size_t index);
  [[nodiscard]] Reading make_accelerometer_reading(const Linkage& linkage, std::size_t index) const;
  void add_energy_channels();
  void add_run_metrics();
  void add_channel(std::string key, std::string help, Reading read);
  /// Adds the metrics of a peak, STEM and UNIT in one word, and of its time.
  void add_peak(const std::string& stem, const std::string& unit, std::string help, double scale,
                const std::function<Peak(const RunMetrics&)>& find);
  /// Adds a load without channel, and the metrics of its peak.
  std::size_t add_load(const std::string& stem, const std::string& unit, std::string help, double scale,
                       Reading read);
  /// Adds a load with its channel STEM and UNIT in one word, those of its extremes between samples, and the
  /// metrics of its peak.
  void add_sampled_load(const std::string& stem, const std::string& unit, std::string help,
                        std::string peak_help, const Reading& read);
  void add_channels(std::span<Channel> channels);
  void add_extremes(const std::string& stem, const std::string& unit, const Reading& read,
                    Channel::Kind kind, std::size_t index);

  /// Value of a metric, from the measured quantities of a run.
  using Result = std::function<double(const RunMetrics&, const RunOutcome&)>;
  void add_metric(QuantityInfo info, Result result);

  const BuiltLinkage& built_;
  JointReactions reactions_;
  std::string source_;  ///< of what is added, as KeyClash::field; empty: every linkage has it
  std::vector<std::string> channel_sources_, metric_sources_;
  std::vector<Channel> channels_;
  Measured measured_;
  std::vector<QuantityInfo> metrics_;
  std::vector<Result> results_;
  std::vector<SlidingWork> sliding_work_;  ///< stays where it is: channels refer to it
};

}  // namespace engine
