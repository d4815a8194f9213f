// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/applied_forces.h"

#include <algorithm>
#include <cstddef>

namespace engine {

namespace {

/// @param drive_work  of the force element
void add_work(PowerKind kind, double work, double& drive_work, EnergyAccount& energy) {
  if (kind == PowerKind::kLoss)
    energy.structural_loss -= work;
  else if (kind == PowerKind::kFriction)
    energy.friction_loss -= work;
  else
    drive_work += work;
}

}  // namespace

AppliedForces::AppliedForces(const Mechanism& mechanism, const TreeModel& model)
    : mechanism_(mechanism),
      forces_(model.applied_forces),
      values_(forces_.size()),
      body_loads_(mechanism.body_loads.size()) {
  std::size_t first = 0;
  for (const Actuation& actuation : mechanism.actuations) {
    const std::size_t end = first + list_applied_forces(actuation).size();
    groups_.push_back({find_source(model, actuation.coordinate), find_source(model, actuation.winding),
                       find_source(model, actuation.memory), first, end});
    first = end;
  }
}

AppliedForces::Source AppliedForces::find_source(const TreeModel& model, FrameIndex coordinate) {
  Source source;
  const auto free = std::ranges::find(model.free, coordinate);
  if (free != model.free.end()) source.free = static_cast<int>(free - model.free.begin());
  const auto drive = std::ranges::find(model.drives, coordinate);
  if (source.free < 0 && drive != model.drives.end())
    source.drive = static_cast<int>(drive - model.drives.begin());
  return source;
}

void AppliedForces::calc(double t, const Eigen::VectorXd& y, const std::vector<DrivenMotion>& drives,
                         const StateLayout& layout, const Eigen::VectorXd& reactions) {
  const auto rate_of = [&](const Source& source) { return source.free < 0 ? 0.0 : y[layout.v(source.free)]; };
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const Group& group = groups_[k];
    ElementState state{.current = rate_of(group.winding), .memory = rate_of(group.memory),
                       .reaction = reactions[static_cast<Eigen::Index>(k)]};
    if (group.coordinate.free >= 0) {
      state.q = y[layout.q(group.coordinate.free)];
      state.v = y[layout.v(group.coordinate.free)];
    } else {
      state.q = drives[static_cast<std::size_t>(group.coordinate.drive)].q;
      state.v = drives[static_cast<std::size_t>(group.coordinate.drive)].qd;
    }
    calc_applied_forces(mechanism_.actuations[k], t, state, &values_[group.first]);
  }
  for (std::size_t k = 0; k < body_loads_.size(); ++k)
    body_loads_[k] = calc_signal(mechanism_.body_loads[k].law, t);
}

void AppliedForces::read_out(const Eigen::VectorXd& y, const StateLayout& layout, Evaluation& at) const {
  read_out_elements(y, layout, at);
  read_out_body_loads(y, layout, at);
}

void AppliedForces::read_out_elements(const Eigen::VectorXd& y, const StateLayout& layout,
                                      Evaluation& at) const {
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    double& work = at.energy.drive_work[layout.drives + static_cast<Eigen::Index>(k)];
    work = 0.0;
    for (std::size_t i = groups_[k].first; i < groups_[k].end; ++i) {
      const auto index = static_cast<Eigen::Index>(i);
      at.applied_force[index] = values_[i].force;
      if (forces_[i].work < 0) continue;
      at.applied_work[index] = y[layout.work(layout.applied_in_works(forces_[i].work))];
      add_work(forces_[i].power, at.applied_work[index], work, at.energy);
    }
  }
}

void AppliedForces::read_out_body_loads(const Eigen::VectorXd& y, const StateLayout& layout,
                                        Evaluation& at) const {
  const auto behind = static_cast<Eigen::Index>(forces_.size());
  const int first_load = layout.applied - static_cast<int>(body_loads_.size());
  for (std::size_t k = 0; k < body_loads_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    at.applied_force[behind + i] = body_loads_[k].value;
    at.applied_work[behind + i] = y[layout.work(layout.applied_in_works(first_load + static_cast<int>(k)))];
    at.energy.drive_work[layout.drives + static_cast<Eigen::Index>(groups_.size()) + i] =
        at.applied_work[behind + i];
  }
}

}  // namespace engine
