// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/reaction_friction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include <Eigen/Geometry>

namespace engine {

namespace {

/// Coordinates of a coordinate's joint, in their order.
std::vector<FrameIndex> list_freedoms(const Mechanism& mechanism, FrameIndex of) {
  const auto continues_joint = [&](FrameIndex i) {
    return mechanism.coordinates[static_cast<std::size_t>(i)].continues_joint;
  };
  while (continues_joint(of)) --of;
  std::vector<FrameIndex> freedoms{of};
  const auto count = static_cast<FrameIndex>(mechanism.coordinates.size());
  for (FrameIndex i = of + 1; i < count && continues_joint(i); ++i) freedoms.push_back(i);
  return freedoms;
}

std::vector<FrameIndex> find_other_slides(const Mechanism& mechanism, FrameIndex of) {
  std::vector<FrameIndex> slides = list_freedoms(mechanism, of);
  std::erase_if(slides, [&](FrameIndex i) {
    const bool is_coupled = std::ranges::any_of(
        mechanism.couplings, [i](const Coupling& c) { return c.coordinate == i || c.follows == i; });
    return i == of || is_coupled ||
           mechanism.coordinates[static_cast<std::size_t>(i)].motion != Motion::kTranslation;
  });
  return slides;
}

}  // namespace

ReactionFriction::ReactionFriction(const Mechanism& mechanism) : reactions_(mechanism) {
  for (std::size_t k = 0; k < mechanism.actuations.size(); ++k) {
    const auto* const friction = std::get_if<JointFriction>(&mechanism.actuations[k].element);
    if (!friction || !friction->by_reaction) continue;
    const FrameIndex coordinate = mechanism.actuations[k].coordinate;
    joints_.push_back(
        {.actuation = static_cast<Eigen::Index>(k),
         .coordinate = coordinate,
         .last = list_freedoms(mechanism, coordinate).back(),
         .turns = mechanism.coordinates[static_cast<std::size_t>(coordinate)].motion == Motion::kRotation,
         .length = friction->length,
         .slides = find_other_slides(mechanism, coordinate)});
  }
  const auto n = static_cast<Eigen::Index>(joints_.size());
  normal_forces_.setZero(static_cast<Eigen::Index>(mechanism.actuations.size()));
  last_solution_ = normal_forces_;
  inverse_.setIdentity(n, n);
  for (Eigen::VectorXd* vector : {&residual_, &last_residual_, &step_, &image_, &row_}) vector->setZero(n);
}

double ReactionFriction::calc_normal_force(const Joint& joint, const Evaluation& at) const {
  const Wrench& reaction = reactions_.of(joint.coordinate);
  const Eigen::Vector3d& axis = at.frames[static_cast<std::size_t>(joint.coordinate)].axis;
  Eigen::Vector3d force = reaction.force;
  for (const FrameIndex slide : joint.slides) {
    const Eigen::Vector3d& along = at.frames[static_cast<std::size_t>(slide)].axis;
    force -= along.dot(force) * along;
  }
  const double axial = axis.dot(force);
  const Eigen::Vector3d radial = force - axial * axis;
  const double thrust = joint.turns ? std::abs(axial) : 0.0;
  if (joint.length == 0.0) return radial.norm() + thrust;
  const Eigen::Vector3d arm = at.frames[static_cast<std::size_t>(joint.last)].p -
                              at.frames[static_cast<std::size_t>(joint.coordinate)].p;
  const Eigen::Vector3d moment = reaction.moment - arm.cross(reaction.force);
  const Eigen::Vector3d couple = axis.cross(moment) / joint.length;
  return (0.5 * radial + couple).norm() + (0.5 * radial - couple).norm() + thrust;
}

bool ReactionFriction::improve(const Evaluation& at) {
  constexpr double kSolved = 1e-10;  // of the largest normal force, or of 1 N
  reactions_.calc(at);
  double largest = 1.0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double assumed = normal_forces_[joints_[i].actuation];
    residual_[static_cast<Eigen::Index>(i)] = calc_normal_force(joints_[i], at) - assumed;
    largest = std::max(largest, std::abs(assumed));
  }
  if (residual_.cwiseAbs().maxCoeff() <= kSolved * largest) {
    last_solution_ = normal_forces_;
    return true;
  }
  if (has_last_) update_inverse();
  step_.noalias() = inverse_ * residual_;
  for (std::size_t i = 0; i < joints_.size(); ++i)
    normal_forces_[joints_[i].actuation] += step_[static_cast<Eigen::Index>(i)];
  last_residual_ = residual_;
  has_last_ = true;
  return false;
}

void ReactionFriction::give_up() {
  normal_forces_ = last_solution_;
  inverse_.setIdentity();
}

/// inverse += (step - inverse y) (step^T inverse) / (step^T inverse y),  y = last residual - residual
///
/// The determinant of inverse keeps its sign if step^T inverse y > 0: then steps do not lead to a solution on
/// which reactions do not settle. Else shorter steps follow the residual.
void ReactionFriction::update_inverse() {
  last_residual_ -= residual_;
  image_.noalias() = inverse_ * last_residual_;
  row_.noalias() = inverse_.transpose() * step_;
  const double scale = step_.dot(image_);
  if (!(scale > 1e-3 * step_.squaredNorm())) {
    inverse_ *= 0.5;
    return;
  }
  image_ = (step_ - image_) / scale;
  inverse_.noalias() += image_ * row_.transpose();
}

}  // namespace engine
