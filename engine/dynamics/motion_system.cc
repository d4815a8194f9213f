#include "engine/dynamics/motion_system.h"

#include <algorithm>
#include <cstddef>

namespace engine {

namespace {

std::vector<FrameIndex> driven_coordinates(const Mechanism& mechanism) {
  std::vector<FrameIndex> driven;
  if (mechanism.drive_rows == DriveRows::kEliminated)
    for (const Drive& drive : mechanism.drives) driven.push_back(drive.coordinate);
  return driven;
}

std::vector<FrameIndex> free_coordinates_of(const Mechanism& mechanism, const std::vector<FrameIndex>& driven) {
  std::vector<FrameIndex> free;
  for (FrameIndex i = 0; i < static_cast<FrameIndex>(mechanism.coordinates.size()); ++i)
    if (std::find(driven.begin(), driven.end(), i) == driven.end()) free.push_back(i);
  return free;
}

/// The tree of the free coordinates alone: each one's nearest free ancestor.
std::vector<int> free_parents(const Mechanism& mechanism, const std::vector<FrameIndex>& free) {
  std::vector<int> parents;
  for (const FrameIndex i : free) {
    FrameIndex ancestor = mechanism.coordinates[static_cast<std::size_t>(i)].parent;
    auto found = free.end();
    for (; ancestor != kGround && found == free.end(); ancestor = mechanism.coordinates[static_cast<std::size_t>(ancestor)].parent)
      found = std::find(free.begin(), free.end(), ancestor);
    parents.push_back(found == free.end() ? -1 : static_cast<int>(found - free.begin()));
  }
  return parents;
}

JournalMotion calc_relative(const FrameMotion& b, const FrameMotion& j) {
  const Eigen::Vector3d offset = j.p - b.p;
  JournalMotion relative;
  relative.R_bj.noalias() = b.R.transpose() * j.R;
  relative.p_bj = b.R.transpose() * offset;
  relative.v = b.R.transpose() * (j.v - b.v - b.w.cross(offset));
  relative.w = b.R.transpose() * (j.w - b.w);
  return relative;
}

}  // namespace

MotionSystem::MotionSystem(const Mechanism& mechanism)
    : mechanism_(mechanism),
      free_(free_coordinates_of(mechanism, driven_coordinates(mechanism))),
      driven_(driven_coordinates(mechanism)),
      tree_(mechanism),
      free_mass_(free_parents(mechanism, free_)),
      constraints_(mechanism) {
  for (std::size_t k = 0; k < mechanism.cut_joints.size(); ++k) {
    if (!mechanism.cut_joints[k].clearance) continue;
    clearance_joints_.emplace_back(*mechanism.cut_joints[k].clearance);
    clearance_joint_of_.push_back(k);
    bristles_ += clearance_joints_.back().bristle_count();
  }
  const Eigen::Index rows = constraints_.count();
  free_force_.setZero(free_count());
  free_Phi_q_t_.setZero(free_count(), rows);
  response_.setZero(free_count(), rows);
  A_.setZero(rows, rows);
  A_llt_.compute(Eigen::MatrixXd::Identity(rows, rows));  // has its memory, and a state that may be copied
  lambda_.setZero(rows);
}

Eigen::VectorXd MotionSystem::make_state(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(controlled_size() + static_cast<Eigen::Index>(mechanism_.drives.size()) + 3);
  for (Eigen::Index k = 0; k < free_count(); ++k) {
    y[k] = q[free_[static_cast<std::size_t>(k)]];
    y[free_count() + k] = qd[free_[static_cast<std::size_t>(k)]];
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
  at.energy.drive_work = at.drive_force;
  at.frames.resize(mechanism_.coordinates.size());
  at.joints.resize(mechanism_.cut_joints.size());
  return at;
}

void MotionSystem::read_state(double t, const Eigen::VectorXd& y, Evaluation& at) const {
  at.t = t;
  at.qdd.setZero();
  for (Eigen::Index k = 0; k < free_count(); ++k) {
    at.q[free_[static_cast<std::size_t>(k)]] = y[k];
    at.qd[free_[static_cast<std::size_t>(k)]] = y[free_count() + k];
  }
  for (std::size_t k = 0; k < driven_.size(); ++k) {
    const DrivenMotion motion = calc_driven_motion(mechanism_.drives[k].law, t);
    at.q[driven_[k]] = motion.q;
    at.qd[driven_[k]] = motion.qd;
    at.qdd[driven_[k]] = motion.qdd;
  }
  const Eigen::Index drives = at.drive_force.size();
  at.energy.drive_work = y.segment(controlled_size(), drives);
  at.energy.impact_loss = y[controlled_size() + drives];
  at.energy.friction_loss = y[controlled_size() + drives + 1];
  at.energy.structural_loss = y[controlled_size() + drives + 2];
}

EvaluationStatus MotionSystem::calc_derivative(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dydt, Evaluation& at) {
  read_state(t, y, at);
  calc_frame_motions(mechanism_, at.q, at.qd, at.qdd, at.frames);
  if (!calc_contacts(y, dydt, at)) {
    tree_.clear_loads();
    return EvaluationStatus::kBristleMissing;
  }
  tree_.calc(at.frames);
  const EvaluationStatus status = solve_accelerations(at);
  if (status != EvaluationStatus::kOk) return status;
  calc_drive_forces(at);
  calc_rates(dydt, at);
  return EvaluationStatus::kOk;
}

bool MotionSystem::calc_contacts(const Eigen::VectorXd& y, Eigen::VectorXd& dydt, Evaluation& at) {
  bool complete = true;
  Eigen::Index bristle = 2 * free_count();
  std::size_t next = 0;
  for (std::size_t k = 0; k < mechanism_.cut_joints.size(); ++k) {
    const CutJoint& joint = mechanism_.cut_joints[k];
    const FrameMotion b = calc_bearing_motion(mechanism_, joint, at.frames);
    const FrameMotion j = calc_journal_motion(mechanism_, joint, at.frames);
    JointState& state = at.joints[k];
    state.journal = calc_relative(b, j);
    if (!joint.clearance) continue;
    const ClearanceJoint& model = clearance_joints_[next++];
    complete = model.calc(state.journal, y.data() + bristle, dydt.data() + bristle, state.load) && complete;
    bristle += model.bristle_count();
    state.reaction_W = b.R * state.load.force;
    add_contact_load(joint, j, state.reaction_W, b.R * state.load.moment, at.frames);
  }
  return complete;
}

/// Force and moment about the journal's centre act on the journal, their opposites at the same point on the bearing.
void MotionSystem::add_contact_load(const CutJoint& joint, const FrameMotion& j, const Eigen::Vector3d& force_W,
                                    const Eigen::Vector3d& moment_W, const std::vector<FrameMotion>& frames) {
  const auto add = [&](FrameIndex frame, double sign) {
    if (frame == kGround) return;
    const Eigen::Vector3d arm = j.p - frames[static_cast<std::size_t>(frame)].p;
    tree_.add_load(frame, {sign * force_W, sign * (moment_W + arm.cross(force_W))});
  };
  add(joint.journal_frame, 1.0);
  add(joint.bearing_frame, -1.0);
}

EvaluationStatus MotionSystem::solve_accelerations(Evaluation& at) {
  const Eigen::Index n = free_count();
  TreeLtdl::Matrix& H = free_mass_.matrix();
  for (Eigen::Index a = 0; a < n; ++a) {
    const FrameIndex i = free_[static_cast<std::size_t>(a)];
    const Coordinate& c = mechanism_.coordinates[static_cast<std::size_t>(i)];
    free_force_[a] = -tree_.bias()[i] - c.stiffness * at.q[i] - c.damping * at.qd[i];
    for (Eigen::Index b = free_mass_.first(a); b <= a; ++b) H(a, b) = tree_.M()(i, free_[static_cast<std::size_t>(b)]);
  }
  if (!free_mass_.factor()) return EvaluationStatus::kNonFinite;
  free_mass_.solve_in_place(free_force_);
  if (constraints_.count() > 0) {
    const EvaluationStatus status = solve_multipliers(at);
    if (status != EvaluationStatus::kOk) return status;
    free_force_.noalias() += response_ * lambda_;
  }
  for (Eigen::Index a = 0; a < n; ++a) at.qdd[free_[static_cast<std::size_t>(a)]] = free_force_[a];
  for (std::size_t k = 0; k < at.joints.size(); ++k)
    if (const Eigen::Index row = constraints_.row_of_joint(k); row >= 0) at.joints[k].reaction_W = lambda_.segment<3>(row);
  return free_force_.allFinite() ? EvaluationStatus::kOk : EvaluationStatus::kNonFinite;
}

/// (Phi_q M^-1 Phi_q^T) lambda = -(Phi_q qdd_0 + bias) - 2 alpha Phi_d - beta^2 Phi, with qdd_0 the accelerations without constraints.
EvaluationStatus MotionSystem::solve_multipliers(const Evaluation& at) {
  constraints_.calc(at.frames, at.q, at.qd, at.t);
  for (Eigen::Index a = 0; a < free_count(); ++a)
    free_Phi_q_t_.row(a) = constraints_.Phi_q.col(free_[static_cast<std::size_t>(a)]).transpose();
  response_ = free_Phi_q_t_;
  for (Eigen::Index r = 0; r < response_.cols(); ++r) free_mass_.solve_in_place(response_.col(r));
  A_.noalias() = free_Phi_q_t_.transpose() * response_;
  A_llt_.compute(A_);
  if (A_llt_.info() != Eigen::Success) return EvaluationStatus::kLocked;
  constexpr double kSingular = 1e-12;  // of a pivot, relative to its row: the loop stands at the end of its reach
  for (Eigen::Index r = 0; r < A_.rows(); ++r) {
    const double pivot = A_llt_.matrixLLT()(r, r);
    if (!(pivot * pivot > kSingular * A_(r, r))) return EvaluationStatus::kLocked;
  }
  const double alpha = mechanism_.baumgarte_alpha;
  const double beta = mechanism_.baumgarte_beta;
  lambda_.noalias() = -(free_Phi_q_t_.transpose() * free_force_);
  lambda_ -= constraints_.bias + 2.0 * alpha * constraints_.Phi_d + beta * beta * constraints_.Phi;
  A_llt_.solveInPlace(lambda_);
  return EvaluationStatus::kOk;
}

void MotionSystem::calc_drive_forces(Evaluation& at) const {
  if (mechanism_.drive_rows == DriveRows::kMultipliers) {
    for (std::size_t k = 0; k < mechanism_.drives.size(); ++k)
      at.drive_force[static_cast<Eigen::Index>(k)] = lambda_[constraints_.row_of_drive(k)];
    return;
  }
  for (std::size_t k = 0; k < driven_.size(); ++k) {
    const FrameIndex d = driven_[k];
    const Coordinate& c = mechanism_.coordinates[static_cast<std::size_t>(d)];
    double force = tree_.bias()[d] + c.stiffness * at.q[d] + c.damping * at.qd[d];
    for (const FrameIndex f : free_) force += tree_.M(d, f) * at.qdd[f];
    if (constraints_.count() > 0) force -= constraints_.Phi_q.col(d).dot(lambda_);
    at.drive_force[static_cast<Eigen::Index>(k)] = force;
  }
}

void MotionSystem::calc_rates(Eigen::VectorXd& dydt, const Evaluation& at) const {
  for (Eigen::Index k = 0; k < free_count(); ++k) {
    dydt[k] = at.qd[free_[static_cast<std::size_t>(k)]];
    dydt[free_count() + k] = at.qdd[free_[static_cast<std::size_t>(k)]];
  }
  const Eigen::Index work = controlled_size();
  const Eigen::Index drives = at.drive_force.size();
  for (Eigen::Index k = 0; k < drives; ++k)
    dydt[work + k] = at.drive_force[k] * at.qd[mechanism_.drives[static_cast<std::size_t>(k)].coordinate];
  double impact = 0.0;
  double friction = 0.0;
  for (const JointState& joint : at.joints) {
    impact += joint.load.impact_power;
    friction += joint.load.friction_power;
  }
  double structural = 0.0;
  for (std::size_t i = 0; i < mechanism_.coordinates.size(); ++i) {
    const double rate = at.qd[static_cast<Eigen::Index>(i)];
    structural += mechanism_.coordinates[i].damping * rate * rate;
  }
  dydt[work + drives] = impact;
  dydt[work + drives + 1] = friction;
  dydt[work + drives + 2] = structural;
}

void MotionSystem::calc_energies(Evaluation& at) const {
  at.energy.kinetic = calc_kinetic_energy(mechanism_, at.frames);
  at.energy.potential = calc_potential_energy(mechanism_, at.frames, at.q);
  for (const JointState& joint : at.joints) at.energy.potential += joint.load.elastic_energy;
}

void MotionSystem::add_penetrations(const Evaluation& at, std::vector<Penetration>& rings) const {
  for (std::size_t k = 0; k < clearance_joints_.size(); ++k)
    clearance_joints_[k].add_penetrations(at.joints[clearance_joint_of_[k]].journal, rings);
}

bool MotionSystem::prepare_step(const Evaluation& at, double dt, Eigen::VectorXd& y) {
  bool moved = false;
  double* bristles = y.data() + 2 * free_count();
  for (std::size_t k = 0; k < clearance_joints_.size(); ++k) {
    moved |= clearance_joints_[k].follow(at.joints[clearance_joint_of_[k]].journal, dt, bristles);
    bristles += clearance_joints_[k].bristle_count();
  }
  return moved;
}

ContactChange MotionSystem::accept_step(const Evaluation& start, const Evaluation& end, Eigen::VectorXd& y) {
  ContactChange sum;
  double* bristles = y.data() + 2 * free_count();
  for (std::size_t k = 0; k < clearance_joints_.size(); ++k) {
    const std::size_t joint = clearance_joint_of_[k];
    const ContactChange change =
        clearance_joints_[k].advance(start.joints[joint].journal, end.joints[joint].journal, end.t - start.t, bristles);
    sum.any |= change.any;
    sum.ring_onsets += change.ring_onsets;
    bristles += clearance_joints_[k].bristle_count();
  }
  return sum;
}

void MotionSystem::widen_bristles(Eigen::VectorXd& y) {
  const Eigen::Index first = 2 * free_count();
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
  bristles_ = wide.size() - first - (y.size() - read);
  y = wide;
}

}  // namespace engine
