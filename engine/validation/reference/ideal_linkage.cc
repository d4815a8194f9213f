#include "engine/validation/reference/ideal_linkage.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "engine/validation/reference/pseudo_inertia.h"

namespace engine::validation {

namespace {

using Vector3t = std::array<Taylor, 3>;
using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// The triangle that S joint, guide and slider make.
struct Triangle {
  Taylor psi, r, W, Y;  ///< crank angle, its length; from the S joint along x and y to the guide's point that the coupler reaches
};

Triangle calc_triangle(const RpsupParameters& p, double t) {
  Triangle triangle{calc_crank_angle(p, t), p.rod_length + calc_rod_displacement(p, t), {}, {}};
  triangle.Y = p.guide_offset_y - triangle.r * sin(triangle.psi);
  const double l = p.coupler_length;
  triangle.W = sqrt(Taylor(l * l - p.guide_offset_z * p.guide_offset_z) - triangle.Y * triangle.Y);
  return triangle;
}

Vector3t cross(const Vector3t& a, const Vector3t& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
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
          Vector3d(integral(2, 1) - integral(1, 2), integral(0, 2) - integral(2, 0), integral(1, 0) - integral(0, 1)) - mc.cross(gravity)};
}

}  // namespace

Taylor calc_cycloid(const Taylor& u) { return u - 1.0 / kTwoPi * sin(kTwoPi * u); }

Taylor calc_crank_angle(const RpsupParameters& p, double t) {
  const Taylor time = Taylor::time(t);
  if (t >= p.run_up) return p.crank_velocity * (time - 0.5 * p.run_up);
  const Taylor u = 1.0 / p.run_up * time;
  return p.crank_velocity * p.run_up * (0.5 * u * u + 1.0 / (kTwoPi * kTwoPi) * (cos(kTwoPi * u) - 1.0));
}

Taylor calc_rod_displacement(const RpsupParameters& p, double t) {
  const double cycle = 2.0 * p.rod_stroke_time + p.rod_pause;
  const double begin = cycle * std::floor(t / cycle);
  const Taylor u = 1.0 / p.rod_stroke_time * (Taylor::time(t) - begin);
  if (u.value() >= 2.0) return 0.0;
  return p.rod_stroke * (u.value() < 1.0 ? calc_cycloid(u) : Taylor(1.0) - calc_cycloid(u - 1.0));
}

Taylor calc_slider(const RpsupParameters& p, double t) {
  const Triangle triangle = calc_triangle(p, t);
  return triangle.r * cos(triangle.psi) + triangle.W;
}

std::array<LinkMotion, kLinkCount> calc_ideal_motion(const RpsupParameters& p, double t) {
  const Triangle triangle = calc_triangle(p, t);
  const Taylor c = cos(triangle.psi);
  const Taylor s = sin(triangle.psi);
  const Vector3t x_11{c, s, 0.0};
  const Vector3t y_11{-1.0 * s, c, 0.0};
  const Vector3t x{1.0, 0.0, 0.0};
  const Vector3t y{0.0, 1.0, 0.0};
  const Vector3t z{0.0, 0.0, 1.0};
  const Taylor z_12 = triangle.r - p.rod_length;
  const Vector3t S{triangle.r * c, triangle.r * s, 0.0};

  const double per_length = 1.0 / p.coupler_length;
  const Vector3t x_13{per_length * triangle.W, per_length * triangle.Y, Taylor(per_length * p.guide_offset_z)};
  const Taylor width = sqrt(x_13[0] * x_13[0] + x_13[2] * x_13[2]);
  const Vector3t z_13{-1.0 * x_13[2] / width, 0.0, x_13[0] / width};
  const Vector3t J{calc_slider(p, t), p.guide_offset_y, p.guide_offset_z};
  return {make_motion(x_11, y_11, z, {0.0, 0.0, 0.0}), make_motion(x_11, y_11, z, {z_12 * c, z_12 * s, 0.0}),
          make_motion(x_13, cross(z_13, x_13), z_13, S), make_motion(x, y, z, J), make_motion(cross(y, z_13), y, z_13, J)};
}

IdealForces calc_ideal_forces(const RpsupParameters& p, double t) {
  const std::array<LinkMotion, kLinkCount> motion = calc_ideal_motion(p, t);
  const Vector3d gravity(0.0, -p.gravity, 0.0);
  const std::array<double, kLinkCount> length{p.crank_length, p.rod_length, p.coupler_length, 0.0, 0.0};
  IdealForces forces{};
  std::array<Needed, kLinkCount> needed;
  for (std::size_t k = 0; k < kLinkCount; ++k) {
    const Matrix4d H = calc_pseudo_inertia(p.links[k].mass, {0.5 * length[k], 0.0, 0.0}, p.links[k].inertia.asDiagonal());
    const LinkMotion& m = motion[k];
    needed[k] = calc_needed(m, H, gravity);
    forces.kinetic_energy += 0.5 * (m.T_d * H * m.T_d.transpose()).trace();
    forces.potential_energy -= gravity.dot((m.T * H.col(3)).head<3>());
    forces.power += (m.T_d * H * m.T_dd.transpose()).trace() - gravity.dot((m.T_d * H.col(3)).head<3>());
  }
  const auto& [crank, rod, coupler, slider, cross_link] = needed;
  const Vector3d S = motion[2].T.topRightCorner<3, 1>();
  const Vector3d J = motion[3].T.topRightCorner<3, 1>();

  // Unknown: force f on the journal at J and moment n_x x_22 + n_y y on it (joint R carries none about its axis). The guide takes no
  // force along x, the cross link's joint no moment about y, the S joint no moment at all: -f and -n turn the coupler about S.
  Eigen::Matrix<double, 5, 5> A = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> b;
  A(0, 0) = 1.0;
  b[0] = slider.force.x() + cross_link.force.x();
  A(1, 4) = 1.0;
  b[1] = (cross_link.moment - J.cross(cross_link.force)).y();
  const Vector3d arm = J - S;
  for (int k = 0; k < 3; ++k) A.block<3, 1>(2, k) = -arm.cross(Vector3d::Unit(k));
  A.block<3, 1>(2, 3) = -motion[4].T.block<3, 1>(0, 0);
  A(3, 4) = -1.0;
  b.tail<3>() = coupler.moment - S.cross(coupler.force);
  const Eigen::Matrix<double, 5, 1> x = A.partialPivLu().solve(b);
  forces.reaction_W = x.head<3>();

  // The rod pushes the coupler at S, the crank the rod along its axis; about z the motor turns them all.
  const Vector3d at_S = coupler.force + forces.reaction_W;
  forces.rod_force = motion[0].T.block<3, 1>(0, 0).dot(rod.force + at_S);
  forces.crank_torque = (crank.moment + rod.moment + S.cross(at_S)).z();
  return forces;
}

}  // namespace engine::validation
