// SPDX-License-Identifier: Apache-2.0
#include "validation/reference/contact_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace validation {

namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using std::numbers::pi;

class FreshContacts {
 public:
  FreshContacts(const RpsupParameters& parameters, const PartMotion& b, const PartMotion& j)
      : p_(parameters), b_(b), j_(j) {
    b_inverse_ = b.T.inverse();
    // Velocity of a journal's material point less that of the bearing's at the same place: V (x, y, z, 1).
    V_ = j.T_d * j.T.inverse() - b.T_d * b_inverse_;
  }

  std::vector<ContactPoint> find() {
    for (int ring = 0; ring < p_.radial_levels; ++ring)
      add_ring(p_.radial_levels == 1 ? 0.0 : p_.bearing_length * (ring / (p_.radial_levels - 1.0) - 0.5));
    for (const double side : {1.0, -1.0})
      for (int circle = 1; circle <= p_.axial_levels; ++circle)
        for (int k = 0; k < p_.axial_elements; ++k)
          add_face_point(side, r_j() * circle / p_.axial_levels, 2.0 * pi * k / p_.axial_elements);
    return points_;
  }

 private:
  [[nodiscard]] double r_j() const { return p_.bearing_radius - p_.c_r; }
  [[nodiscard]] Vector3d velocity(const Vector4d& p) const { return (V_ * p).head<3>(); }
  /// 1 + chi rate / rate at onset; the latter is at least the floor.
  [[nodiscard]] double damping(double rate) const {
    return std::max(0.0, 1.0 + 0.75 * (1.0 - p_.restitution * p_.restitution) * rate /
                                   std::max(rate, p_.minimum_impact_velocity));
  }
  [[nodiscard]] double hertz_stiffness() const {
    const double nu = p_.youngs_modulus / (2.0 * p_.shear_modulus) - 1.0;
    const double both = 2.0 * (1.0 - nu * nu) / (pi * p_.youngs_modulus);
    return 4.0 / (3.0 * pi * both) * std::sqrt(p_.bearing_radius * r_j() / p_.c_r);
  }

  void add_ring(double s) {
    const Vector4d centre = j_.T * Vector4d(0.0, 0.0, s, 1.0);
    const Vector4d in_b = b_inverse_ * centre;
    const double offset = std::hypot(in_b.x(), in_b.y());
    const double delta = offset - p_.c_r;
    if (delta <= 0.0) return;
    const Vector3d n = b_.T.topLeftCorner<3, 3>() * Vector3d(in_b.x() / offset, in_b.y() / offset, 0.0);
    const double f_n =
        hertz_stiffness() / p_.radial_levels * std::pow(delta, 1.5) * damping(n.dot(velocity(centre)));
    Vector4d K = centre;
    K.head<3>() += r_j() * n;
    // Unbent bristles bend with the sliding velocity: z_d = v.
    const Vector3d v = velocity(K);
    const Vector3d sliding = v - n * n.dot(v);
    points_.push_back({K.head<3>(), -f_n * (n + (p_.sigma_1 + p_.sigma_2) * sliding)});
  }

  void add_face_point(double side, double radius, double angle) {
    const Vector4d K = j_.T * Vector4d(radius * std::cos(angle), radius * std::sin(angle),
                                       0.5 * side * p_.bearing_length, 1.0);
    const double delta = side * (b_inverse_ * K).z() - 0.5 * p_.bearing_length - p_.c_a;
    if (delta <= 0.0) return;
    const Vector3d n = side * b_.T.block<3, 1>(0, 2);
    const double stiffness = p_.axial_stiffness / (p_.axial_levels * p_.axial_elements);
    points_.push_back({K.head<3>(), -stiffness * delta * damping(n.dot(velocity(K))) * n});
  }

  const RpsupParameters& p_;
  const PartMotion& b_;
  const PartMotion& j_;
  Eigen::Matrix4d b_inverse_, V_;
  std::vector<ContactPoint> points_;
};

}  // namespace

std::vector<ContactPoint> find_fresh_contacts(const RpsupParameters& parameters, const PartMotion& b,
                                              const PartMotion& j) {
  return FreshContacts(parameters, b, j).find();
}

}  // namespace validation
