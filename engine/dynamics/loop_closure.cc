// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/loop_closure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>

#include "engine/clearance/clearance_joint.h"
#include "engine/dynamics/loop_closure_parts.h"

namespace engine {

using namespace loop_closure;

namespace {

Mechanism make_ideal(Mechanism mechanism) {
  for (CutJoint& joint : mechanism.cut_joints) joint.clearance.reset();
  mechanism.drive_rows = DriveRows::kEliminated;
  return mechanism;
}

bool is_unloaded_spring(const Coordinate& c) { return c.stiffness != 0.0 && !c.spring_yields; }
bool is_found_by_loops(const Coordinate& c) { return !is_unloaded_spring(c) && !c.start; }
bool is_rate_found_by_loops(const Coordinate& c) { return !is_unloaded_spring(c) && !c.start_rate; }

/// A journal as seen from its bearing, but for velocities.
JournalMotion calc_journal_pose(const CutJoint& joint, const std::vector<FrameMotion>& frames) {
  const FrameMotion b = motion_of(joint.bearing_frame, frames), j = motion_of(joint.journal_frame, frames);
  const Eigen::Matrix3d R_b = b.R * joint.bearing.R;
  JournalMotion journal;
  journal.R_bj = R_b.transpose() * j.R * joint.journal.R;
  journal.p_bj = R_b.transpose() * (j.p + j.R * joint.journal.p - b.p - b.R * joint.bearing.p);
  return journal;
}

/// @returns whether a journal is in its bore and between its shoulders, or rests there, pressed in a little
bool is_in_bore(const CutJoint& joint, const std::vector<FrameMotion>& frames) {
  constexpr double kPressed = 0.1;  // of the clearance, of a block the smaller one
  const JournalMotion journal = calc_journal_pose(joint, frames);
  const ClearanceJoint clearance(*joint.clearance);
  const AxialFaces& faces = clearance.faces();
  std::vector<Penetration> rings;
  clearance.add_penetrations(journal, rings);
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Penetration& ring : rings) deepest = std::max(deepest, ring.delta);
  const Eigen::Vector3d axial = journal.R_bj.row(2);
  for (const int face : {0, 1})
    deepest = std::max(deepest, faces.calc_farthest_point(AxialFaces::side(face), journal.p_bj.z(), axial.x(),
                                                          axial.y(), axial.z()) - faces.limit());
  const ClearanceParameters& parameters = *joint.clearance;
  const bool is_block = parameters.geometry == ContactGeometry::kBlockInSlot;
  return deepest <= kPressed * (is_block ? std::min(parameters.c_r, parameters.c_y) : parameters.c_r);
}

}  // namespace

LoopClosure::LoopClosure(const Mechanism& mechanism)
    : ideal_(make_ideal(mechanism)),
      unknown_(find_coordinates(ideal_, is_found_by_loops)),
      constraints_(ideal_),
      inverse_dynamics_(ideal_),
      J_(unknown_.size()) {
  list_rigid_rows(mechanism.cut_joints);
  list_position_rows(mechanism.cut_joints);
  std::ranges::copy_if(mechanism.cut_joints, std::back_inserter(clearance_joints_),
                       [](const CutJoint& joint) { return joint.clearance.has_value(); });
  all_rows_.resize(static_cast<std::size_t>(constraints_.count()));
  std::iota(all_rows_.begin(), all_rows_.end(), Eigen::Index{0});
  J_.resize(unknown_.size());
  step_.setZero(static_cast<Eigen::Index>(unknown_.size()));
  lambda_.setZero(constraints_.count());
  find_active_rows();
}

/// Lists rigid rows and their blocks. @param joints  with the clearances that ideal_ is without
void LoopClosure::list_rigid_rows(const std::vector<CutJoint>& joints) {
  Eigen::Index row = 0;
  for (const CutJoint& joint : joints) {
    const CutRows rows = rows_of(joint.kind);
    for (int k = 0; k < rows.count(); ++k, ++row) {
      if (joint.clearance) continue;
      rigid_rows_.push_back(row);
      blocks_.push_back(row - k + (k < rows.positions ? 0 : rows.positions));
    }
  }
  for (; row < constraints_.count(); ++row) {
    rigid_rows_.push_back(row);
    blocks_.push_back(row);
  }
}

void LoopClosure::list_position_rows(const std::vector<CutJoint>& joints) {
  Eigen::Index row = 0;
  for (const CutJoint& joint : joints) {
    const CutRows rows = rows_of(joint.kind);
    for (int k = 0; k < rows.positions; ++k) position_rows_.push_back(row + k);
    row += rows.count();
    reach_ = std::max({reach_, joint.bearing.p.norm(), joint.journal.p.norm()});
  }
  for (const Coordinate& c : ideal_.coordinates) reach_ = std::max(reach_, c.com.norm());
}

/// Rows that no coordinate moves, those out of the plane of a planar linkage say, have no entries in any
/// position: two positions tell.
void LoopClosure::find_active_rows() {
  constexpr double kInactive = 1e-10;  // of a row's entries, [m/rad] or [1]
  const auto n = static_cast<Eigen::Index>(ideal_.coordinates.size());
  Evaluation at;
  at.frames.resize(ideal_.coordinates.size());
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(constraints_.count());
  for (const double irregular : {0.7, 1.9}) {
    at.q = Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index i) {
      return std::sin(irregular * static_cast<double>(i + 1));
    });
    calc_positions(at);
    if (n > 0) largest = largest.cwiseMax(constraints_.Phi_q.cwiseAbs().rowwise().maxCoeff());
  }
  for (Eigen::Index r = 0; r < constraints_.count(); ++r)
    if (largest[r] > kInactive) active_rows_.push_back(r);
}

void LoopClosure::set_drives(double t, Evaluation& at) const {
  at.t = t;
  for (const Drive& drive : ideal_.drives) {
    const DrivenMotion motion = calc_driven_motion(drive.law, piece_.clamp(t));
    at.q[drive.coordinate] = motion.q;
    at.qd[drive.coordinate] = motion.qd;
    at.qdd[drive.coordinate] = motion.qdd;
  }
}

void LoopClosure::calc_positions(Evaluation& at, AxisResiduals axes) {
  calc_frame_poses(ideal_, at.q, at.frames);
  constraints_.calc_positions(at.q, at.frames, axes);
  size_ = reach_;
  for (const FrameMotion& frame : at.frames) size_ = std::max(size_, reach_ + frame.p.norm());
}

void LoopClosure::calc_rates(Evaluation& at) {
  calc_frame_rates(ideal_, at.qd, at.qdd, at.frames);
  constraints_.calc_rates(at.q, at.qd, at.qdd, at.frames);
}

bool LoopClosure::assemble(double t, Evaluation& at) {
  const bool closes = close_from_guess(t, at);
  if (closes && turned_over_ < 0) return assemble_rates(at);
  const Evaluation found = at;
  // Products of axes are zero after a half turn as well, and pull nowhere where an axis is a right angle off.
  if (close_by_rotations(t, at) && turned_over_ < 0) return assemble_rates(at);
  at = found;
  calc_positions(at);
  if (closes) {
    turned_over_ = constraints_.find_turned_over(at.frames);
    return false;
  }
  turned_over_ = -1;
  return close_rigid_joints(at) && assemble_rates(at);
}

void LoopClosure::set_guess(double t, Evaluation& at) const {
  at.q.setZero();
  at.qd.setZero();
  at.qdd.setZero();
  for (std::size_t i = 0; i < ideal_.coordinates.size(); ++i) {
    const Coordinate& c = ideal_.coordinates[i];
    at.q[static_cast<Eigen::Index>(i)] = c.start ? *c.start : is_unloaded_spring(c) ? 0.0 : c.assembly_guess;
    at.qd[static_cast<Eigen::Index>(i)] = c.start_rate.value_or(0.0);
  }
  set_drives(t, at);
}

bool LoopClosure::close_from_guess(double t, Evaluation& at) {
  set_guess(t, at);
  const bool closed = close(at, AxisResiduals::kProducts, kClosed, all_rows_, unknown_);
  turned_over_ = closed ? constraints_.find_turned_over(at.frames) : -1;
  return closed;
}

/// From the guess as well, with residuals that grow with the angle between axes.
bool LoopClosure::close_by_rotations(double t, Evaluation& at) {
  constexpr double kNearlyClosed = 1e-6;  // of Phi, [m] and [1]
  set_guess(t, at);
  const bool closed = close(at, AxisResiduals::kRotationVectors, kNearlyClosed, all_rows_, unknown_) &&
                      close(at, AxisResiduals::kProducts, kClosed, all_rows_, unknown_);
  turned_over_ = constraints_.find_turned_over(at.frames);
  return closed;
}

/// From a position in which given coordinates keep journals off the centres of their bearings, or leave
/// loops open by their last digits: closes the joints without clearance, in the nearest position. False
/// unless every journal is then in its bore.
bool LoopClosure::close_rigid_joints(Evaluation& at) {
  const auto close_by = [&](const std::vector<FrameIndex>& moved) {
    return close(at, AxisResiduals::kProducts, kClosed, rigid_rows_, moved);
  };
  const bool closed = (!clearance_joints_.empty() && close_by(unknown_)) ||
                      (is_closed_but_for_rounding() && close_by(find_coordinates(ideal_, is_any)));
  if (!closed) return false;
  turned_over_ = constraints_.find_turned_over(at.frames);
  return turned_over_ < 0 && std::ranges::all_of(clearance_joints_, [&](const CutJoint& joint) {
           return is_in_bore(joint, at.frames);
         });
}

/// @returns whether the rigid joints are open by no more than what starts with seven digits leave
bool LoopClosure::is_closed_but_for_rounding() const {
  return std::ranges::all_of(rigid_rows_, [&](Eigen::Index row) {
    const bool is_position = std::ranges::binary_search(position_rows_, row);
    return std::abs(constraints_.Phi[row]) <= kRounded * (is_position ? size_ : 1.0);
  });
}

double LoopClosure::closed() const { return kClosed * std::max(1.0, 0.1 * size_); }

/// Newton's method from the position that `at` holds, for some of the rows.
/// @param tolerance  of Phi, for mechanisms of up to 10 m  @param moved  coordinates that may move
bool LoopClosure::close(Evaluation& at, AxisResiduals axes, double tolerance,
                        const std::vector<Eigen::Index>& rows, const std::vector<FrameIndex>& moved) {
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    calc_positions(at, axes);
    const Eigen::VectorXd gaps = constraints_.Phi(rows);
    if (gaps.size() == 0 || gaps.cwiseAbs().maxCoeff() < tolerance / kClosed * closed()) return true;
    if (moved.empty()) return false;
    Eigen::VectorXd step = -decompose(calc_columns(moved)(rows, Eigen::all)).solve(gaps);
    step *= std::min(1.0, kMaxStep / step.cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < moved.size(); ++k) at.q[moved[k]] += step[static_cast<Eigen::Index>(k)];
  }
  return false;
}

Eigen::Index LoopClosure::count_independent(const Evaluation& assembled) {
  Evaluation at = assembled;
  calc_positions(at);
  return rank_of(calc_rigid_rows());
}

bool LoopClosure::assemble_rates(Evaluation& at) {
  calc_rates(at);
  if (constraints_.count() == 0) return true;
  // A journal that has clearance may also move in its bearing from the start.
  rates_fit_ = find_rates(all_rows_, at) || find_rates(rigid_rows_, at);
  return rates_fit_;
}

/// Minimum-norm solution for the rates that are not given. Given ones are corrected too where only their
/// rounding violates the rows. False if more than their rounding does.
bool LoopClosure::find_rates(const std::vector<Eigen::Index>& rows, Evaluation& at) {
  constexpr double kFits = 1e-9;  // of the residual that the given rates alone leave, [m/s] and [1/s]
  const std::vector<FrameIndex> open = find_coordinates(ideal_, is_rate_found_by_loops);
  for (const FrameIndex i : open) at.qd[i] = 0.0;
  calc_rates(at);
  if (rows.empty()) return true;
  const auto residual = [&] { return constraints_.Phi_d(rows).cwiseAbs().maxCoeff(); };
  const auto correct = [&](const std::vector<FrameIndex>& moved) {
    if (moved.empty()) return;
    const Eigen::VectorXd rates =
        -decompose(calc_columns(moved)(rows, Eigen::all)).solve(constraints_.Phi_d(rows));
    for (std::size_t k = 0; k < moved.size(); ++k) at.qd[moved[k]] += rates[static_cast<Eigen::Index>(k)];
    calc_rates(at);
  };
  const double allowed = kFits * std::max(1.0, residual());
  correct(open);
  if (residual() <= allowed) return true;
  const double speed = (constraints_.Phi_q(rows, Eigen::all).cwiseAbs() * at.qd.cwiseAbs()).maxCoeff();
  if (residual() > kRounded * std::max(1.0, speed)) return false;
  correct(find_coordinates(ideal_, is_any));
  return residual() <= allowed;
}

Eigen::MatrixXd LoopClosure::calc_columns(const std::vector<FrameIndex>& coordinates) const {
  Eigen::MatrixXd columns(constraints_.count(), static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = constraints_.Phi_q.col(coordinates[k]);
  return columns;
}

/// calc_columns() for ranks: entries below rounding are zero.
Eigen::MatrixXd LoopClosure::calc_columns_above_noise(const std::vector<FrameIndex>& coordinates) const {
  constexpr double kNoise = 1e-13;  // of entries between axes; of those of positions, of the size
  Eigen::MatrixXd columns = calc_columns(coordinates);
  Eigen::VectorXd noise = Eigen::VectorXd::Constant(columns.rows(), kNoise);
  noise(position_rows_) *= size_;
  for (Eigen::Index r = 0; r < columns.rows(); ++r)
    columns.row(r) = (columns.row(r).array().abs() < noise[r]).select(0.0, columns.row(r));
  return columns;
}

}  // namespace engine
