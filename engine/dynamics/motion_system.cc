// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/motion_system.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/dynamics/energies.h"

namespace engine {

MotionSystem::MotionSystem(const Mechanism& mechanism, std::string_view instruction_set)
    : mechanism_(mechanism),
      model_(mechanism),
      instruction_set_(instruction_set.empty() ? instruction_sets().back() : instruction_set),
      layout_{static_cast<int>(model_.free.size()), 0, static_cast<int>(mechanism.drives.size()),
              model_.force_works + static_cast<int>(model_.body_loads.size())},
      applied_forces_(mechanism_, model_),
      reaction_friction_(mechanism_),
      friction_at_(make_evaluation()) {
  for (DrivesAt& each : last_drives_) each.motion.resize(mechanism.drives.size());
  add_clearance_joints();
  allocate();
}

void MotionSystem::add_clearance_joints() {
  for (std::size_t k = 0; k < mechanism_.cut_joints.size(); ++k) {
    if (!mechanism_.cut_joints[k].clearance) continue;
    clearance_joints_.emplace_back(*mechanism_.cut_joints[k].clearance);
    clearance_joint_of_.push_back(k);
    layout_.bristles += static_cast<int>(clearance_joints_.back().bristle_count());
  }
}

void MotionSystem::reload_mechanism() {
  model_ = TreeModel(mechanism_);
  allocate();
}

/// Allocates everything that depends on the number of bristles. Eigen's resize() would free the old entries
/// first and, without memory for the new ones, leave the vector to free them a second time: vectors that have
/// entries are replaced.
void MotionSystem::allocate() {
  kernel_ = make_dynamics_kernel(instruction_set_, model_, clearance_joints_, applied_forces_.values());
  forget_drives();
  solved_ = false;
  set_error_weights();
  for (Eigen::VectorXd* each : {&solved_y_, &dydt_, &time_derivative_})
    *each = Eigen::VectorXd(layout_.size());
}

/// All bristles of a ring together count as much as the two that a continuum has there: at first by shares,
/// of which the roots are taken.
void MotionSystem::set_error_weights() {
  error_weights_ = Eigen::VectorXd(Eigen::VectorXd::Ones(controlled_size()));
  Eigen::Index first = layout_.bristle();
  for (const ClearanceJoint& joint : clearance_joints_) {
    error_weights_.segment(first, joint.bristle_count())
        .setConstant(2.0 * joint.ring_count() / joint.bristle_count());
    first += joint.bristle_count();
  }
  error_weights_ = (error_weights_ / error_weights_.sum()).cwiseSqrt().eval();
}

Eigen::VectorXd MotionSystem::make_state(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(layout_.size());
  for (int k = 0; k < layout_.free; ++k) {
    y[layout_.q(k)] = q[model_.free[static_cast<std::size_t>(k)]];
    y[layout_.v(k)] = qd[model_.free[static_cast<std::size_t>(k)]];
  }
  return y;
}

Evaluation MotionSystem::make_evaluation() const {
  const auto n = static_cast<Eigen::Index>(mechanism_.coordinates.size());
  Evaluation at;
  at.q.setZero(n);
  at.qd.setZero(n);
  at.qdd.setZero(n);
  at.drive_force.setZero(static_cast<Eigen::Index>(mechanism_.drives.size()));
  at.applied_force.setZero(
      static_cast<Eigen::Index>(model_.applied_forces.size() + model_.body_loads.size()));
  at.applied_work = at.applied_force;
  at.friction_reaction.setZero(static_cast<Eigen::Index>(mechanism_.actuations.size()));
  at.energy.drive_work.setZero(static_cast<Eigen::Index>(
      mechanism_.drives.size() + mechanism_.actuations.size() + mechanism_.body_loads.size()));
  at.frames.resize(mechanism_.coordinates.size());
  at.joints.resize(mechanism_.cut_joints.size());
  return at;
}

void MotionSystem::follow_drives(const DrivePiece& piece) {
  piece_ = piece;
  forget_drives();
  solved_ = false;
}

void MotionSystem::forget_drives() {
  for (DrivesAt& each : last_drives_) each.t = std::numeric_limits<double>::quiet_NaN();
}

/// @returns true if the drives have moved since the last evaluation
bool MotionSystem::move_drives(double t) {
  if (t == drives().t) return false;
  const auto* const known = std::ranges::find(last_drives_, t, &DrivesAt::t);
  if (known != last_drives_.end()) {
    present_ = static_cast<std::size_t>(known - last_drives_.begin());
    return true;
  }
  newest_ = (newest_ + 1) % last_drives_.size();
  present_ = newest_;
  last_drives_[present_].t = t;
  for (std::size_t k = 0; k < mechanism_.drives.size(); ++k)
    last_drives_[present_].motion[k] = calc_driven_motion(mechanism_.drives[k].law, piece_.clamp(t));
  return true;
}

EvaluationStatus MotionSystem::calc_derivative(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt) {
  solved_ = false;
  if (!reaction_friction_.empty()) return solve(t, y, dydt);
  const bool moved = move_drives(t);
  calc_applied_forces(t, y);
  return kernel_->evaluate(y.data(), drives().motion.data(), moved, dydt.data());
}

void MotionSystem::calc_applied_forces(double t, const Eigen::VectorXd& y) {
  applied_forces_.calc(piece_.clamp(t), y, drives().motion, layout_, reaction_friction_.normal_forces());
}

EvaluationStatus MotionSystem::solve(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt) {
  const bool moved = move_drives(t);
  calc_applied_forces(t, y);
  EvaluationStatus status = kernel_->evaluate_and_keep(y.data(), drives().motion.data(), moved, dydt.data());
  if (status == EvaluationStatus::kOk && !reaction_friction_.empty()) status = solve_friction(t, y, dydt);
  solved_ = status == EvaluationStatus::kOk;
  solved_y_ = y;
  return status;
}

/// After an evaluation: repeats it until the friction that depends on reactions is that of its reactions.
EvaluationStatus MotionSystem::solve_friction(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt) {
  constexpr int kMostPasses = 60;
  EvaluationStatus status = EvaluationStatus::kOk;
  reaction_friction_.start();
  for (int pass = 0; pass < kMostPasses && status == EvaluationStatus::kOk; ++pass) {
    friction_at_.t = piece_.clamp(t);
    kernel_->read_out(friction_at_);
    if (reaction_friction_.improve(friction_at_)) return EvaluationStatus::kOk;
    calc_applied_forces(t, y);
    status = kernel_->evaluate_and_keep(y.data(), drives().motion.data(), false, dydt.data());
  }
  reaction_friction_.give_up();
  return status == EvaluationStatus::kOk ? EvaluationStatus::kWedged : status;
}

EvaluationStatus MotionSystem::calc_derivative(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt,
                                               Evaluation& at) {
  const EvaluationStatus status = solve(t, y, dydt);
  at.t = t;
  at.energy.drive_work.head(layout_.drives) = y.segment(layout_.work(), layout_.drives);
  at.energy.impact_loss = y[layout_.impact()];
  at.energy.friction_loss = y[layout_.friction()];
  at.energy.structural_loss = y[layout_.structural()];
  applied_forces_.read_out(y, layout_, at);
  at.friction_reaction = reaction_friction_.normal_forces();
  kernel_->read_out(at);
  return status;
}

EvaluationStatus MotionSystem::linearise(double t, const Eigen::VectorXd& y, NewtonSolver newton_solver) {
  const bool is_solved = solved_ && t == drives().t && y == solved_y_;
  const EvaluationStatus status = is_solved ? EvaluationStatus::kOk : solve(t, y, dydt_);
  if (status != EvaluationStatus::kOk) return status;
  kernel_->linearise(y.data(), drives().motion.data(), newton_solver, time_derivative_.data());
  return EvaluationStatus::kOk;
}

NewtonSolver MotionSystem::choose_newton_solver(Shifts shifts) const {
  // Break-even of whole runs by rodas5 and by radau5, measured with one joint and the continuum law. The cost
  // of each joint in contact (Woodbury) is about that of one such mechanism.
  const Eigen::Index many_coordinates = shifts == Shifts::kReal ? 26 : 47;
  const auto joints = static_cast<Eigen::Index>(std::max<std::size_t>(1, clearance_joints_.size()));
  return free_count() >= many_coordinates * joints && can_solve_recursively() ? NewtonSolver::kRecursive
                                                                              : NewtonSolver::kDense;
}

void MotionSystem::calc_energies(Evaluation& at) const {
  at.energy.kinetic = calc_kinetic_energy(mechanism_, at.frames, at.qd);
  at.energy.potential = calc_potential_energy(mechanism_, at.frames, at.q);
  for (const JointState& joint : at.joints) at.energy.potential += joint.load.elastic_energy;
}

void MotionSystem::add_penetrations(const Evaluation& at, std::vector<Penetration>& rings) const {
  for (std::size_t k = 0; k < clearance_joints_.size(); ++k)
    clearance_joints_[k].add_penetrations(at.joints[clearance_joint_of_[k]].journal, rings);
}

bool MotionSystem::prepare_step(const Evaluation& at, double dt, Eigen::VectorXd& y) {
  bool moved = false;
  double* bristles = y.data() + layout_.bristle();
  for (std::size_t k = 0; k < clearance_joints_.size(); ++k) {
    moved |= clearance_joints_[k].follow(at.joints[clearance_joint_of_[k]].journal, dt, bristles);
    bristles += clearance_joints_[k].bristle_count();
  }
  if (moved) solved_ = false;
  return moved;
}

ContactChange MotionSystem::accept_step(const Evaluation& start, const Evaluation& end, Eigen::VectorXd& y) {
  ContactChange sum;
  double* bristles = y.data() + layout_.bristle();
  for (std::size_t k = 0; k < clearance_joints_.size(); ++k) {
    const std::size_t joint = clearance_joint_of_[k];
    sum += clearance_joints_[k].advance(start.joints[joint].journal, end.joints[joint].journal,
                                        end.t - start.t, bristles);
    bristles += clearance_joints_[k].bristle_count();
  }
  if (sum.any) solved_ = false;
  return sum;
}

void MotionSystem::widen_bristles(Eigen::VectorXd& y) {
  const Eigen::Index first = layout_.bristle();
  Eigen::VectorXd wide = y.head(first);
  const auto append = [&wide](const Eigen::VectorXd& part) {
    wide.conservativeResize(wide.size() + part.size());
    wide.tail(part.size()) = part;
  };
  Eigen::Index read = first;
  for (ClearanceJoint& joint : clearance_joints_) {
    const Eigen::Index before = joint.bristle_count();
    append(joint.widen(y.data() + read));
    read += before;
  }
  append(y.tail(y.size() - read));
  layout_.bristles = static_cast<int>(wide.size() - first - (y.size() - read));
  y = std::move(wide);
  allocate();
}

}  // namespace engine
