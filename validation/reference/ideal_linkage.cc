// SPDX-License-Identifier: Apache-2.0
#include "validation/reference/ideal_linkage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "validation/reference/paper_linkage.h"
#include "validation/reference/pseudo_inertia.h"

namespace validation {

namespace {

using Vector3t = std::array<Taylor, 3>;
using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Vector3t operator+(const Vector3t& a, const Vector3t& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector3t operator-(const Vector3t& a, const Vector3t& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector3t operator*(const Taylor& s, const Vector3t& a) { return {s * a[0], s * a[1], s * a[2]}; }
Taylor dot(const Vector3t& a, const Vector3t& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector3t cross(const Vector3t& a, const Vector3t& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector3t make_constant(double x, double y, double z) { return {Taylor(x), Taylor(y), Taylor(z)}; }

/// Axes of the guide and of the slider.
struct GuideAxes {
  Vector3t x, y, z;
};

GuideAxes guide_axes(const RpsupParameters& p) {
  const double c = std::cos(p.guide_angle), s = std::sin(p.guide_angle);
  return {make_constant(c, 0.0, s), make_constant(0.0, 1.0, 0.0), make_constant(-s, 0.0, c)};
}

/// The triangle that S joint, guide and slider make.
struct Triangle {
  Taylor psi, r;
  Vector3t S, J;        ///< S joint and slider in the global frame
  Vector3t across;      ///< from the guide to the S joint, at right angles to the guide
  Taylor slider;        ///< z^(2,1)
};

Triangle calc_triangle(const RpsupParameters& p, double t, Side side) {
  Triangle triangle{calc_crank_angle(p, t), p.rod_length + calc_rod_displacement(p, t, side), {}, {}, {}, {}};
  triangle.S = {triangle.r * cos(triangle.psi), triangle.r * sin(triangle.psi), Taylor(0.0)};
  const Vector3t guide = make_constant(0.0, p.guide_offset_y, p.guide_offset_z);
  const Vector3t d = guide_axes(p).x;
  const Taylor along = dot(triangle.S - guide, d);
  triangle.across = triangle.S - guide - along * d;
  triangle.slider =
      along + sqrt(Taylor(p.coupler_length * p.coupler_length) - dot(triangle.across, triangle.across));
  triangle.J = guide + triangle.slider * d;
  return triangle;
}

LinkMotion make_motion(const Vector3t& x, const Vector3t& y, const Vector3t& z, const Vector3t& origin) {
  LinkMotion motion{Matrix4d::Zero(), Matrix4d::Zero(), Matrix4d::Zero()};
  const std::array<const Vector3t*, 4> columns{&x, &y, &z, &origin};
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) {
      const Taylor& entry = (*columns[static_cast<std::size_t>(column)])[static_cast<std::size_t>(row)];
      motion.T(row, column) = entry.value();
      motion.T_d(row, column) = entry.derivative(1);
      motion.T_dd(row, column) = entry.derivative(2);
    }
  motion.T(3, 3) = 1.0;
  return motion;
}

/// Rates of momentum and of angular momentum about the global origin, less those that gravity gives.
struct Needed {
  Vector3d force, moment;
};

Needed calc_needed(const LinkMotion& motion, const Matrix4d& H, const Vector3d& gravity) {
  const Matrix4d integral = motion.T_dd * H * motion.T.transpose();  // of r_dd r^T dm
  const Vector3d weight = H(3, 3) * gravity;
  const Vector3d mc = (motion.T * H.col(3)).head<3>();
  return {(motion.T_dd * H.col(3)).head<3>() - weight,
          Vector3d(integral(2, 1) - integral(1, 2), integral(0, 2) - integral(2, 0),
                   integral(1, 0) - integral(0, 1)) -
              mc.cross(gravity)};
}

/// @param first_half  of the parabolic law
Taylor calc_rise(StrokeLaw law, bool first_half, const Taylor& u) {
  if (law == StrokeLaw::kCycloidal) return calc_cycloid(u);
  if (law == StrokeLaw::kCosine) return 0.5 * (Taylor(1.0) - cos(0.5 * kTwoPi * u));
  return first_half ? 2.0 * u * u : Taylor(1.0) - 2.0 * (Taylor(1.0) - u) * (Taylor(1.0) - u);
}

}  // namespace

Taylor calc_cycloid(const Taylor& u) { return u - 1.0 / kTwoPi * sin(kTwoPi * u); }

Taylor calc_crank_angle(const RpsupParameters& p, double t) {
  const Taylor time = Taylor::time(t);
  if (t >= p.run_up) return p.crank_start + p.crank_velocity * (time - 0.5 * p.run_up);
  const Taylor u = 1.0 / p.run_up * time;
  return p.crank_start +
         p.crank_velocity * p.run_up * (0.5 * u * u + 1.0 / (kTwoPi * kTwoPi) * (cos(kTwoPi * u) - 1.0));
}

Taylor calc_rod_displacement(const RpsupParameters& p, double t, Side side) {
  constexpr double kAside = 1e-9;  // [s]
  // the piece of the law that counts is the one there
  const double inside = side == Side::kBefore ? std::max(0.0, t - kAside) : t;
  const double cycle = 2.0 * p.rod_stroke_time + p.rod_pause;
  const double begin = cycle * std::floor(inside / cycle);
  const double halves = std::floor(2.0 * (inside - begin) / p.rod_stroke_time);
  const Taylor u = 1.0 / p.rod_stroke_time * (Taylor::time(t) - begin);
  const double rest = p.rod_start - p.rod_length;
  if (halves >= 4.0) return rest;
  if (halves < 2.0) return rest + p.rod_stroke * calc_rise(p.rod_law, halves < 1.0, u);
  return rest + p.rod_stroke * (Taylor(1.0) - calc_rise(p.rod_law, halves < 3.0, u - 1.0));
}

Taylor calc_slider(const RpsupParameters& p, double t, Side side) { return calc_triangle(p, t, side).slider; }

std::array<LinkMotion, kLinkCount> calc_ideal_motion(const RpsupParameters& p, double t, Side side) {
  const Triangle triangle = calc_triangle(p, t, side);
  const Taylor c = cos(triangle.psi);
  const Taylor s = sin(triangle.psi);
  const Vector3t x_11{c, s, 0.0};
  const Vector3t y_11{-1.0 * s, c, 0.0};
  const Vector3t z = make_constant(0.0, 0.0, 1.0);
  const GuideAxes slider = guide_axes(p);
  const Taylor z_12 = triangle.r - p.rod_length;

  const Vector3t x_13 = 1.0 / p.coupler_length * (triangle.J - triangle.S);
  const bool about_guide = p.yoke_axis == YokeAxis::kGuide;
  const Vector3t along_z_13 = about_guide ? cross(slider.x, triangle.across) : cross(x_13, slider.y);
  const Vector3t z_13 = 1.0 / sqrt(dot(along_z_13, along_z_13)) * along_z_13;
  const Vector3t x_22 = about_guide ? slider.x : cross(slider.y, z_13);
  const Vector3t y_22 = about_guide ? cross(z_13, slider.x) : slider.y;
  return {make_motion(x_11, y_11, z, make_constant(0.0, 0.0, 0.0)), make_motion(x_11, y_11, z, z_12 * x_11),
          make_motion(x_13, cross(z_13, x_13), z_13, triangle.S),
          make_motion(slider.x, slider.y, slider.z, triangle.J), make_motion(x_22, y_22, z_13, triangle.J)};
}

IdealForces calc_ideal_forces(const RpsupParameters& p, double t, Side side) {
  const std::array<LinkMotion, kLinkCount> motion = calc_ideal_motion(p, t, side);
  const Vector3d gravity = calc_gravity(p);
  const std::array<double, kLinkCount> length{p.crank_length, p.rod_length, p.coupler_length, 0.0, 0.0};
  IdealForces forces{};
  std::array<Needed, kLinkCount> needed;
  for (std::size_t k = 0; k < kLinkCount; ++k) {
    const Matrix4d H =
        calc_pseudo_inertia(p.links[k].mass, {0.5 * length[k], 0.0, 0.0}, p.links[k].inertia.asDiagonal());
    const LinkMotion& m = motion[k];
    needed[k] = calc_needed(m, H, gravity);
    forces.kinetic_energy += 0.5 * (m.T_d * H * m.T_d.transpose()).trace();
    forces.potential_energy -= gravity.dot((m.T * H.col(3)).head<3>());
    forces.power += (m.T_d * H * m.T_dd.transpose()).trace() - gravity.dot((m.T_d * H.col(3)).head<3>());
  }
  const auto& [crank, rod, coupler, slider, cross_link] = needed;
  const Vector3d S = motion[2].T.topRightCorner<3, 1>();
  const Vector3d J = motion[3].T.topRightCorner<3, 1>();

  // Unknown: force f on the journal at J and moment m k + n o on it, k the yoke's axis and o at right angles
  // to it and to joint R's axis, about which that joint carries none. The guide takes no force along itself,
  // the yoke no moment about its axis, the S joint no moment at all: -f and the opposite moment turn the
  // coupler about S.
  const Vector3d guide = motion[3].T.block<3, 1>(0, 0);
  const int yoke_column = p.yoke_axis == YokeAxis::kGuide ? 0 : 1;
  const Vector3d k = motion[4].T.block<3, 1>(0, yoke_column), o = motion[4].T.block<3, 1>(0, 1 - yoke_column);
  Eigen::Matrix<double, 5, 5> A = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> b;
  A.block<1, 3>(0, 0) = guide.transpose();
  b[0] = guide.dot(slider.force + cross_link.force);
  A(1, 4) = 1.0;
  b[1] = k.dot(cross_link.moment - J.cross(cross_link.force));
  const Vector3d arm = J - S;
  for (int i = 0; i < 3; ++i) A.block<3, 1>(2, i) = -arm.cross(Vector3d::Unit(i));
  A.block<3, 1>(2, 3) = -o;
  A.block<3, 1>(2, 4) = -k;
  b.tail<3>() = coupler.moment - S.cross(coupler.force);
  const Eigen::Matrix<double, 5, 1> x = A.partialPivLu().solve(b);
  forces.reaction_W = x.head<3>();

  // The rod pushes the coupler at S, the crank the rod along its axis; about z the motor turns them all.
  const Vector3d at_S = coupler.force + forces.reaction_W;
  forces.rod_force = motion[0].T.block<3, 1>(0, 0).dot(rod.force + at_S);
  forces.crank_torque = (crank.moment + rod.moment + S.cross(at_S)).z();
  return forces;
}

}  // namespace validation
