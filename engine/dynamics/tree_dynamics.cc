#include "engine/dynamics/tree_dynamics.h"

#include <algorithm>
#include <cstddef>

namespace engine {

namespace {

void add(const SpatialInertia& inertia, SpatialInertia& sum) {
  sum.mass += inertia.mass;
  sum.mc += inertia.mc;
  sum.I += inertia.I;
}

/// The same inertia about a point from which the present origin is seen at r.
void add_shifted(const SpatialInertia& inertia, const Eigen::Vector3d& r, SpatialInertia& sum) {
  const Eigen::Vector3d both = 2.0 * inertia.mc + inertia.mass * r;
  const Eigen::Matrix3d outer = r * (inertia.mc + 0.5 * inertia.mass * r).transpose();
  sum.mass += inertia.mass;
  sum.mc += inertia.mc + inertia.mass * r;
  sum.I += inertia.I - outer - outer.transpose();
  sum.I.diagonal().array() += r.dot(both);
}

}  // namespace

TreeDynamics::TreeDynamics(const Mechanism& mechanism)
    : mechanism_(mechanism),
      loads_(mechanism.coordinates.size()),
      forces_(mechanism.coordinates.size()),
      composite_(mechanism.coordinates.size()) {
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  M_.setZero(n, n);
  bias_.setZero(n);
  for (const Coordinate& c : mechanism.coordinates) nodes_.push_back({c.parent, c.motion == Motion::kRotation, is_inside_joint(c)});
}

void TreeDynamics::add_load(FrameIndex frame, const Wrench& about_origin) {
  Wrench& load = loads_[static_cast<std::size_t>(frame)];
  load.force += about_origin.force;
  load.moment += about_origin.moment;
}

void TreeDynamics::clear_loads() { std::fill(loads_.begin(), loads_.end(), Wrench{}); }

void TreeDynamics::calc(const std::vector<FrameMotion>& frames) {
  calc_body_forces(frames);
  clear_loads();
  carry_to_parents(frames);
  calc_mass_matrix(frames);
}

/// Newton and Euler for each body about its frame's origin, less the loads on it.
void TreeDynamics::calc_body_forces(const std::vector<FrameMotion>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Coordinate& body = mechanism_.coordinates[i];
    const FrameMotion& f = frames[i];
    SpatialInertia& inertia = composite_[i];
    Wrench& force = forces_[i];
    force.force = -loads_[i].force;
    force.moment = -loads_[i].moment;
    inertia = SpatialInertia{};
    if (body.mass == 0.0) continue;
    inertia.mass = body.mass;
    inertia.mc = f.R * (body.mass * body.com);
    inertia.I.noalias() = f.R * body.inertia * f.R.transpose();
    force.force += body.mass * f.vd + f.wd.cross(inertia.mc) + f.w.cross(f.w.cross(inertia.mc));
    force.moment += inertia.I * f.wd + f.w.cross(inertia.I * f.w) + inertia.mc.cross(f.vd);
  }
}

void TreeDynamics::carry_to_parents(const std::vector<FrameMotion>& frames) {
  for (std::size_t i = frames.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    const FrameMotion& f = frames[i];
    bias_[static_cast<Eigen::Index>(i)] = f.axis.dot(node.rotates ? forces_[i].moment : forces_[i].force);
    if (node.parent == kGround) continue;
    const auto parent = static_cast<std::size_t>(node.parent);
    forces_[parent].force += forces_[i].force;
    forces_[parent].moment += forces_[i].moment;
    if (node.inside_joint) {
      add(composite_[i], composite_[parent]);
    } else {
      forces_[parent].moment += f.p_parent.cross(forces_[i].force);
      add_shifted(composite_[i], f.p_parent, composite_[parent]);
    }
  }
}

/// Row i: the force that a unit acceleration of coordinate i asks for, projected on the axes of i and its ancestors.
void TreeDynamics::calc_mass_matrix(const std::vector<FrameMotion>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Eigen::Vector3d& axis = frames[i].axis;
    const SpatialInertia& carried = composite_[i];
    Eigen::Vector3d force, moment;
    if (nodes_[i].rotates) {
      force = axis.cross(carried.mc);
      moment.noalias() = carried.I * axis;
    } else {
      force = carried.mass * axis;
      moment = carried.mc.cross(axis);
    }
    double* row = M_.row(static_cast<Eigen::Index>(i)).data();
    for (auto j = static_cast<FrameIndex>(i); j != kGround;) {
      const Node& node = nodes_[static_cast<std::size_t>(j)];
      const FrameMotion& f = frames[static_cast<std::size_t>(j)];
      row[j] = f.axis.dot(node.rotates ? moment : force);
      if (!node.inside_joint) moment += f.p_parent.cross(force);
      j = node.parent;
    }
  }
}

double calc_kinetic_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames) {
  double twice = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Coordinate& body = mechanism.coordinates[i];
    if (body.mass == 0.0) continue;
    const FrameMotion& f = frames[i];
    const Eigen::Vector3d w_F = f.R.transpose() * f.w;
    const Eigen::Vector3d v_F = f.R.transpose() * f.v;
    twice += body.mass * (v_F.squaredNorm() + 2.0 * v_F.dot(w_F.cross(body.com))) + w_F.dot(body.inertia * w_F);
  }
  return 0.5 * twice;
}

double calc_potential_energy(const Mechanism& mechanism, const std::vector<FrameMotion>& frames, const Eigen::VectorXd& q) {
  double energy = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    const double qi = q[static_cast<Eigen::Index>(i)];
    energy += 0.5 * c.stiffness * qi * qi;
    if (c.mass > 0.0) energy -= c.mass * mechanism.gravity_W.dot(frames[i].p + frames[i].R * c.com);
  }
  return energy;
}

}  // namespace engine
