// SPDX-License-Identifier: Apache-2.0
#include "validation/reference/trace_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "validation/reference/pseudo_inertia.h"

namespace validation {

namespace {

using Eigen::Matrix4d;

/// The joint's own transform, differentiated `order` times by its coordinate.
Matrix4d joint_transform(const Coordinate& c, double q, int order) {
  Matrix4d T = order == 0 ? Matrix4d(Matrix4d::Identity()) : Matrix4d(Matrix4d::Zero());
  const int axis = static_cast<int>(c.axis);
  if (c.motion == Motion::kTranslation) {
    if (order < 2) T(axis, 3) = order == 0 ? q : 1.0;
    return T;
  }
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  // each derivative turns sine and cosine by a right angle
  const double shifted = q + order * std::acos(0.0);
  T(i, i) = T(j, j) = std::cos(shifted);
  T(j, i) = std::sin(shifted);
  T(i, j) = -std::sin(shifted);
  return T;
}

Matrix4d placement_transform(const Placement& placement) {
  Matrix4d T = Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = placement.R;
  T.topRightCorner<3, 1>() = placement.p;
  return T;
}

/// The factors of Eq. (2) from the ground to one frame: A T for each coordinate on the way, and what its
/// derivatives put in that place.
class Path {
 public:
  Path(const Mechanism& mechanism, FrameIndex frame, const Eigen::VectorXd& q) {
    for (FrameIndex k = frame; k != kGround; k = mechanism.coordinates[static_cast<std::size_t>(k)].parent)
      coordinates_.push_back(k);
    std::reverse(coordinates_.begin(), coordinates_.end());
    for (const FrameIndex k : coordinates_) {
      const Coordinate& c = mechanism.coordinates[static_cast<std::size_t>(k)];
      const Matrix4d A = placement_transform(c.placement);
      for (std::size_t order = 0; order < 3; ++order)
        factors_[order].push_back(A * joint_transform(c, q[k], static_cast<int>(order)));
    }
    before_.push_back(Matrix4d::Identity());
    for (const Matrix4d& factor : factors_[0]) before_.push_back(before_.back() * factor);
    behind_.assign(length() + 1, Matrix4d::Identity());
    for (std::size_t a = length(); a-- > 0;) behind_[a] = factors_[0][a] * behind_[a + 1];
  }

  [[nodiscard]] std::size_t length() const { return coordinates_.size(); }
  [[nodiscard]] FrameIndex coordinate(std::size_t place) const { return coordinates_[place]; }
  [[nodiscard]] Matrix4d T() const { return before_.back(); }
  [[nodiscard]] Matrix4d first_derivative(std::size_t a) const {
    return before_[a] * factors_[1][a] * behind_[a + 1];
  }

  /// Sum of T_mn qd_m qd_n over all m and n.
  [[nodiscard]] Matrix4d calc_convective(const Eigen::VectorXd& qd) const {
    Matrix4d sum = Matrix4d::Zero();
    for (std::size_t m = 0; m < length(); ++m) {
      const double rate = qd[coordinates_[m]];
      sum += before_[m] * factors_[2][m] * behind_[m + 1] * (rate * rate);
      Matrix4d between = before_[m] * factors_[1][m];  // up to coordinate n
      for (std::size_t n = m + 1; n < length(); ++n) {
        // T_mn and T_nm
        sum += between * factors_[1][n] * behind_[n + 1] * (2.0 * rate * qd[coordinates_[n]]);
        between = between * factors_[0][n];
      }
    }
    return sum;
  }

 private:
  std::vector<FrameIndex> coordinates_;                ///< from the ground to the frame
  /// A times the joint's transform, differentiated 0, 1, 2 times
  std::array<std::vector<Matrix4d>, 3> factors_;
  /// products of the factors before a place, and from it on
  std::vector<Matrix4d> before_, behind_;
};

}  // namespace

FrameTransforms calc_transforms(const Mechanism& mechanism, FrameIndex frame, const Eigen::VectorXd& q) {
  const Path path(mechanism, frame, q);
  FrameTransforms transforms{path.T(), std::vector<Matrix4d>(mechanism.coordinates.size(), Matrix4d::Zero())};
  for (std::size_t a = 0; a < path.length(); ++a)
    transforms.T_i[static_cast<std::size_t>(path.coordinate(a))] = path.first_derivative(a);
  return transforms;
}

Matrix4d calc_convective_transform(const Mechanism& mechanism, FrameIndex frame, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& qd) {
  return Path(mechanism, frame, q).calc_convective(qd);
}

TraceForm calc_trace_form(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  TraceForm form{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), 0.0, 0.0};
  const Eigen::Vector4d gravity(mechanism.gravity_W.x(), mechanism.gravity_W.y(), mechanism.gravity_W.z(),
                                0.0);
  for (std::size_t l = 0; l < mechanism.coordinates.size(); ++l) {
    const Coordinate& body = mechanism.coordinates[l];
    if (body.mass == 0.0) continue;
    const Matrix4d H = calc_pseudo_inertia(body.mass, body.com, body.inertia);
    const Eigen::Vector4d r_C(body.com.x(), body.com.y(), body.com.z(), 1.0);
    const Path path(mechanism, static_cast<FrameIndex>(l), q);
    const Matrix4d convective = path.calc_convective(qd);
    std::vector<Matrix4d> T_i;
    Matrix4d T_d = Matrix4d::Zero();
    for (std::size_t a = 0; a < path.length(); ++a) {
      T_i.push_back(path.first_derivative(a));
      T_d += T_i.back() * qd[path.coordinate(a)];
    }
    for (std::size_t a = 0; a < path.length(); ++a) {
      const FrameIndex i = path.coordinate(a);
      const Matrix4d T_i_H = T_i[a] * H;
      for (std::size_t b = 0; b < path.length(); ++b)
        form.M(i, path.coordinate(b)) += (T_i_H * T_i[b].transpose()).trace();
      form.h[i] += (T_i_H * convective.transpose()).trace();
      form.g[i] -= body.mass * gravity.dot(T_i[a] * r_C);
    }
    form.kinetic_energy += 0.5 * (T_d * H * T_d.transpose()).trace();
    form.potential_energy -= body.mass * gravity.dot(path.T() * r_C);
  }
  return form;
}

}  // namespace validation
