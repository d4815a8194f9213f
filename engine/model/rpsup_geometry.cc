// SPDX-License-Identifier: Apache-2.0
#include "engine/model/rpsup_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace engine {

namespace {

Eigen::Vector3d to_guide(const RpsupParameters& p, const Eigen::Vector3d& p_W) {
  const Placement guide = guide_frame(p);
  return guide.R.transpose() * (p_W - guide.p);
}

double round_to_millionth(double x) { return std::round(1e6 * x) / 1e6; }

/// Angles of R = R_z(psi) R_y(theta) R_x(phi).
Eigen::Vector3d calc_zyx_angles(const Eigen::Matrix3d& R) {
  return {std::atan2(R(1, 0), R(0, 0)), std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
          std::atan2(R(2, 1), R(2, 2))};
}

Eigen::Matrix3d rotation_about_z(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// Rotation to a frame with its x along a vector and its z a unit vector at right angles to that.
Eigen::Matrix3d rotation_to_axes(const Eigen::Vector3d& along_x, const Eigen::Vector3d& z) {
  Eigen::Matrix3d R;
  R.col(0) = along_x.normalized();
  R.col(2) = z;
  R.col(1) = z.cross(R.col(0));
  return R;
}

/// The axis of joint R is at right angles to the guide and to the coupler, and the S joint is the cross
/// link's length ahead along it:
///
///     z_22 = (a / rho) e + sqrt(1 - (a / rho)^2) x cross e,  e = (0, y, z) / rho,  in {g}
AssemblyGuess calc_guess_about_guide(const RpsupParameters& p) {
  const Eigen::Vector3d S = to_guide(p, calc_s_joint_W(p, 0.0));
  const Eigen::Vector3d e = Eigen::Vector3d(0.0, S.y(), S.z()).normalized();
  const double along = std::min(1.0, p.cross_length / std::hypot(S.y(), S.z()));
  const Eigen::Vector3d z_22 = along * e + std::sqrt(1.0 - along * along) * Eigen::Vector3d::UnitX().cross(e);
  const double slider = S.x() + std::sqrt(std::max(0.0, calc_coupler_projection_squared(p, S)));
  const Eigen::Vector3d J(slider, p.cross_length * z_22.y(), p.cross_length * z_22.z());
  const Eigen::Matrix3d R_g13 = rotation_to_axes(J - S, z_22);
  const Eigen::Matrix3d R_crank = rotation_about_z(calc_crank_motion(p, 0.0).q);
  const Eigen::Vector3d angles = calc_zyx_angles(R_crank.transpose() * guide_frame(p).R * R_g13);
  return {round_to_millionth(angles[0]), round_to_millionth(angles[1]), round_to_millionth(angles[2]),
          round_to_millionth(slider), round_to_millionth(std::atan2(-z_22.y(), z_22.z()))};
}

}  // namespace

RunUp crank_law(const RpsupParameters& p) {
  return {.omega = p.crank_velocity, .run_up = p.run_up, .start = p.crank_start};
}

RiseReturnPause rod_law(const RpsupParameters& p) {
  return {.stroke = p.rod_stroke,
          .stroke_time = p.rod_stroke_time,
          .pause = p.rod_pause,
          .law = p.rod_law,
          .start = p.rod_start - p.rod_length};
}

DrivenMotion calc_crank_motion(const RpsupParameters& p, double t) {
  if (p.crank_actuator) return {.q = p.crank_start};
  return p.crank_drive ? calc_driven_motion(*p.crank_drive, t) : calc_driven_motion(crank_law(p), t);
}

DrivenMotion calc_rod_motion(const RpsupParameters& p, double t) {
  if (p.rod_actuator) return {.q = p.rod_start - p.rod_length};
  return p.rod_drive ? calc_driven_motion(*p.rod_drive, t) : calc_driven_motion(rod_law(p), t);
}

Placement guide_frame(const RpsupParameters& p) {
  Placement guide{.p = {0.0, p.guide_offset_y, p.guide_offset_z}};
  const double c = std::cos(p.guide_angle), s = std::sin(p.guide_angle);
  if (p.guide_angle != 0.0) guide.R << c, 0, -s, 0, 1, 0, s, 0, c;
  return guide;
}

Eigen::Vector3d gravity_direction_W(Direction direction) {
  switch (direction) {
    case Direction::kX: return Eigen::Vector3d::UnitX();
    case Direction::kMinusX: return -Eigen::Vector3d::UnitX();
    case Direction::kY: return Eigen::Vector3d::UnitY();
    case Direction::kMinusY: return -Eigen::Vector3d::UnitY();
    case Direction::kZ: return Eigen::Vector3d::UnitZ();
    case Direction::kMinusZ: return -Eigen::Vector3d::UnitZ();
  }
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d calc_s_joint_W(const RpsupParameters& p, double t) {
  const double psi = calc_crank_motion(p, t).q;
  const double r = p.rod_length + calc_rod_motion(p, t).q;
  return {r * std::cos(psi), r * std::sin(psi), 0.0};
}

double calc_coupler_projection_squared(const RpsupParameters& p, const Eigen::Vector3d& p_gS) {
  const double y = p_gS.y(), z = p_gS.z(), a = p.cross_length, l = p.coupler_length;
  if (p.yoke_axis == YokeAxis::kGuide) return l * l - (y * y + z * z) + a * a;
  return l * l - y * y - std::max(0.0, z * z - a * a);
}

double calc_coupler_projection_squared(const RpsupParameters& p, double t) {
  return calc_coupler_projection_squared(p, to_guide(p, calc_s_joint_W(p, t)));
}

double calc_yoke_arm(const RpsupParameters& p, double t) {
  const Eigen::Vector3d S = to_guide(p, calc_s_joint_W(p, t));
  return std::hypot(S.y(), S.z()) - p.cross_length;
}

AssemblyGuess calc_assembly_guess(const RpsupParameters& p) {
  if (p.yoke_axis == YokeAxis::kGuide) return calc_guess_about_guide(p);
  const double along_guide = to_guide(p, calc_s_joint_W(p, 0.0)).x();
  return {.psi_13 = 0.0 - calc_crank_motion(p, 0.0).q,
          .theta_13 = 0.0 - p.guide_angle,
          .z_21 = along_guide + p.coupler_length};
}

}  // namespace engine
