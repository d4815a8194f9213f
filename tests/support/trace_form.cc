#include "tests/support/trace_form.h"

#include <cmath>
#include <vector>

namespace support {

namespace {

using Eigen::Matrix4d;

/// The joint's own transform, differentiated `order` times by its coordinate.
Matrix4d joint_transform(const engine::Coordinate& c, double q, int order) {
  Matrix4d T = order == 0 ? Matrix4d(Matrix4d::Identity()) : Matrix4d(Matrix4d::Zero());
  const int axis = static_cast<int>(c.axis);
  if (c.motion == engine::Motion::kTranslation) {
    if (order < 2) T(axis, 3) = order == 0 ? q : 1.0;
    return T;
  }
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  const double shifted = q + order * std::acos(0.0);  // each derivative turns sine and cosine by a right angle
  T(i, i) = T(j, j) = std::cos(shifted);
  T(j, i) = std::sin(shifted);
  T(i, j) = -std::sin(shifted);
  return T;
}

Matrix4d placement_transform(const engine::Placement& placement) {
  Matrix4d T = Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = placement.R;
  T.topRightCorner<3, 1>() = placement.p;
  return T;
}

/// True if the coordinate `ancestor` moves the frame `frame`.
bool moves(const engine::Mechanism& mechanism, int ancestor, int frame) {
  while (frame > ancestor) frame = mechanism.coordinates[static_cast<std::size_t>(frame)].parent;
  return frame == ancestor;
}

/// T of one frame, differentiated by coordinate m and coordinate n (-1: not).
Matrix4d transform(const engine::Mechanism& mechanism, int frame, const Eigen::VectorXd& q, int m, int n) {
  Matrix4d T = Matrix4d::Identity();
  if ((m >= 0 && !moves(mechanism, m, frame)) || (n >= 0 && !moves(mechanism, n, frame))) return Matrix4d::Zero();
  for (int k = frame; k >= 0; k = mechanism.coordinates[static_cast<std::size_t>(k)].parent) {
    const engine::Coordinate& c = mechanism.coordinates[static_cast<std::size_t>(k)];
    const int order = (k == m ? 1 : 0) + (k == n ? 1 : 0);
    T = placement_transform(c.placement) * joint_transform(c, q[k], order) * T;
  }
  return T;
}

/// H = integral of r r^T dm over the body, r = (x, y, z, 1).
Matrix4d pseudo_inertia(const engine::Coordinate& body) {
  Matrix4d H;
  H.topLeftCorner<3, 3>() = 0.5 * body.inertia.trace() * Eigen::Matrix3d::Identity() - body.inertia;
  H.topRightCorner<3, 1>() = body.mass * body.com;
  H.bottomLeftCorner<1, 3>() = (body.mass * body.com).transpose();
  H(3, 3) = body.mass;
  return H;
}

}  // namespace

TraceForm calc_trace_form(const engine::Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
  const auto n = static_cast<int>(mechanism.coordinates.size());
  TraceForm form{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), 0.0, 0.0};
  for (int l = 0; l < n; ++l) {
    const engine::Coordinate& body = mechanism.coordinates[static_cast<std::size_t>(l)];
    if (body.mass == 0.0) continue;
    const Matrix4d H = pseudo_inertia(body);
    const Eigen::Vector4d r_C(body.com.x(), body.com.y(), body.com.z(), 1.0);
    const Eigen::Vector4d gravity(mechanism.gravity_W.x(), mechanism.gravity_W.y(), mechanism.gravity_W.z(), 0.0);
    Matrix4d T_d = Matrix4d::Zero();   // of time
    Matrix4d T_dd = Matrix4d::Zero();  // of time, without the accelerations
    std::vector<Matrix4d> T_i;
    for (int i = 0; i < n; ++i) {
      T_i.push_back(transform(mechanism, l, q, i, -1));
      T_d += T_i.back() * qd[i];
      for (int m = 0; m < n; ++m) T_dd += transform(mechanism, l, q, i, m) * qd[i] * qd[m];
    }
    for (int i = 0; i < n; ++i) {
      const Matrix4d T_i_H = T_i[static_cast<std::size_t>(i)] * H;
      for (int j = 0; j < n; ++j) form.M(i, j) += (T_i_H * T_i[static_cast<std::size_t>(j)].transpose()).trace();
      form.h[i] += (T_i_H * T_dd.transpose()).trace();
      form.g[i] -= body.mass * gravity.dot(T_i[static_cast<std::size_t>(i)] * r_C);
    }
    form.kinetic_energy += 0.5 * (T_d * H * T_d.transpose()).trace();
    form.potential_energy -= body.mass * gravity.dot(transform(mechanism, l, q, -1, -1) * r_C);
  }
  return form;
}

}  // namespace support
