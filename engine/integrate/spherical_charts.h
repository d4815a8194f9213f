// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/evaluation.h"
#include "engine/integrate/observer.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Charts of spherical joints: of three rotations in a row about z, y and x of one point, free of springs,
/// dampers, drives, actuators and couplings.
///
/// At theta = +-90 degrees two of the three axes coincide, and rates of the angles grow without bound (gimbal
/// lock). Before that, the angles begin anew from zero:
///
///     R = C R_z(psi) R_y(theta) R_x(phi),  C the rotation at the beginning of the chart
///
/// C becomes part of the joint's placement. Source of the singularity: A. A. Shabana, Dynamics of Multibody
/// Systems (2020), section 2.6.
///
/// Springs, dampers, drives, actuators and couplings act on the angles of one chart: with any of them there
/// is no other chart, and gimbal lock is a limit of the linkage.
class SphericalCharts {
 public:
  explicit SphericalCharts(const Mechanism& mechanism);

  [[nodiscard]] bool empty() const { return joints_.empty(); }
  /// @returns whether any angle is that of another chart than the given one
  [[nodiscard]] bool any_moved() const { return any_moved_; }

  /// Begins a new chart of each joint whose theta has gone far.
  /// @param mechanism  gets the placements  @param q, qd  get the angles and their rates
  /// @returns whether any chart is new
  bool update(Mechanism& mechanism, Eigen::VectorXd& q, Eigen::VectorXd& qd);

  /// psi, theta and phi of each joint.
  using Angles = std::vector<Eigen::Vector3d>;
  [[nodiscard]] Angles angles_of(const Eigen::VectorXd& q) const;

  /// Gives the evaluation the angles of the given chart. Of the many that are the same rotation, those
  /// nearest to `near` are taken. In gimbal lock itself, where rates would not be finite, they are those a
  /// little beside it.
  void restore_given(const Angles& near, Evaluation& at) const;

 private:
  struct Joint {
    FrameIndex psi = 0;  ///< coordinate; theta and phi follow
    Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  };

  Mechanism given_;
  std::vector<Joint> joints_;
  bool any_moved_ = false;
};

/// Passes evaluations on with the angles of the given charts.
class GivenChartObserver : public Observer {
 public:
  GivenChartObserver(Observer& observer, const SphericalCharts& charts)
      : observer_(observer), charts_(charts) {}

  /// @param at  at the start of the run
  void start(const Evaluation& at) { keep(at); }

  void on_step(const Evaluation& start, const Evaluation& end) override;
  [[nodiscard]] bool wants_middle() override { return observer_.wants_middle(); }
  void on_middle(const Evaluation& at) override { observer_.on_middle(restore(at, inside_)); }
  void on_sample(const Evaluation& at) override { observer_.on_sample(restore(at, inside_)); }
  void on_onsets(int rings, int faces) override { observer_.on_onsets(rings, faces); }
  [[nodiscard]] bool stop_requested(double t) override { return observer_.stop_requested(t); }

 private:
  const Evaluation& restore(const Evaluation& at, Evaluation& restored) const;
  void keep(const Evaluation& at);
  [[nodiscard]] SphericalCharts::Angles predict_angles(double t) const;

  Observer& observer_;
  const SphericalCharts& charts_;
  double last_t_ = 0.0;                         ///< end of the last step, [s]
  SphericalCharts::Angles last_, last_rates_;  ///< then
  Evaluation start_, end_, inside_;
};

/// Middle angle of a spherical joint that is in gimbal lock and has no other chart; empty: there is none.
/// @param near  cosine of the angle that counts as the lock
[[nodiscard]] std::optional<FrameIndex> find_gimbal_lock(const Mechanism& mechanism, const Eigen::VectorXd& q,
                                                         double near);

/// Sentence on such a joint, and on ways out.
[[nodiscard]] std::string describe_gimbal_lock(const Mechanism& mechanism, FrameIndex middle);

}  // namespace engine
