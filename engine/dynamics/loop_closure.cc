// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/loop_closure.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/QR>

#include "engine/clearance/clearance_joint.h"
#include "engine/kinematics/plain_frame.h"
#include "engine/math/quintic.h"

namespace engine {

namespace {

constexpr double kClosed = 1e-13;  // of Phi, [m] and [1]: rounding of positions near 1 m
constexpr double kPerturbation = 0.01, kSmallDisplacement = 1e-4;  // [rad] or [m]
constexpr int kMaxIterations = 100;
constexpr double kMaxStep = 0.5;  // of a Newton step, [rad] or [m]; a full one from afar may leave the branch

Mechanism make_ideal(Mechanism mechanism) {
  for (CutJoint& joint : mechanism.cut_joints) joint.clearance.reset();
  mechanism.drive_rows = DriveRows::kEliminated;
  return mechanism;
}

/// Coordinates that are not driven and for which `holds` is true.
template <typename Holds>
std::vector<FrameIndex> find_coordinates(const Mechanism& mechanism, const Holds& holds) {
  std::vector<FrameIndex> found;
  for (FrameIndex i = 0; i < static_cast<FrameIndex>(mechanism.coordinates.size()); ++i) {
    const bool driven = std::any_of(mechanism.drives.begin(), mechanism.drives.end(),
                                    [i](const Drive& d) { return d.coordinate == i; });
    if (!driven && holds(mechanism.coordinates[static_cast<std::size_t>(i)])) found.push_back(i);
  }
  return found;
}

bool is_unloaded_spring(const Coordinate& c) { return c.stiffness != 0.0 && !c.spring_yields; }
bool is_found_by_loops(const Coordinate& c) { return !is_unloaded_spring(c) && !c.start; }
bool is_rate_found_by_loops(const Coordinate& c) { return !is_unloaded_spring(c) && !c.start_rate; }
bool is_any(const Coordinate&) { return true; }

constexpr double kDependent = 1e-9;  // of the largest pivot
// Rows nearer to dependence bind so weakly that DelassusMatrix takes them for redundant: its e is the square.
constexpr double kBindsWeakly = 3e-5;

/// Complete orthogonal decomposition: J need not have full rank, and in a flat mechanism has not.
/// @param dependent  of the largest pivot: smaller ones count as zero
Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decompose(const Eigen::MatrixXd& J,
                                                                  double dependent = kDependent) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(dependent);
  decomposition.compute(J);
  return decomposition;
}

/// Displacement of the driven coordinates when the first of them has moved by a small amount; zero if none
/// moves soon.
Eigen::VectorXd calc_drive_displacement(const Mechanism& mechanism) {
  constexpr double kFirst = 1e-9, kSoon = 0.2;  // [s]; a drive that starts later finds the linkage elsewhere
  Eigen::VectorXd displacement =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mechanism.coordinates.size()));
  for (double t = kFirst; t < kSoon; t *= 1.1) {
    for (const Drive& drive : mechanism.drives)
      displacement[drive.coordinate] =
          calc_driven_motion(drive.law, t).q - calc_driven_motion(drive.law, 0.0).q;
    if (displacement.cwiseAbs().maxCoeff() >= kSmallDisplacement) return displacement;
  }
  return Eigen::VectorXd::Zero(displacement.size());
}

// Pattern of perturb() in which signs alternate.
constexpr double kAlternating = std::numbers::pi;

/// Moves each coordinate that is not driven off its position, by +-size or less.
Eigen::VectorXd perturb(const Mechanism& mechanism, Eigen::VectorXd q, double size, double pattern) {
  double phase = 0.0;
  for (const FrameIndex i : find_coordinates(mechanism, is_any)) {
    q[i] += size * std::cos(phase);
    phase += pattern;
  }
  return q;
}

/// Whether a journal is in its bore and between its shoulders; it may rest there, pressed in a little.
bool is_in_bore(const CutJoint& joint, const std::vector<FrameMotion>& frames) {
  constexpr double kPressed = 0.1;  // of the radial clearance
  const FrameMotion b = motion_of(joint.bearing_frame, frames), j = motion_of(joint.journal_frame, frames);
  const Eigen::Matrix3d R_b = b.R * joint.bearing.R;
  JournalMotion journal;
  journal.R_bj = R_b.transpose() * j.R * joint.journal.R;
  journal.p_bj = R_b.transpose() * (j.p + j.R * joint.journal.p - b.p - b.R * joint.bearing.p);
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
  return deepest <= kPressed * joint.clearance->c_r;
}

/// Numerical rank of J.
Eigen::Index rank_of(const Eigen::MatrixXd& J) { return J.size() == 0 ? 0 : decompose(J).rank(); }

}  // namespace

LoopClosure::LoopClosure(const Mechanism& mechanism)
    : ideal_(make_ideal(mechanism)),
      unknown_(find_coordinates(ideal_, is_found_by_loops)),
      constraints_(ideal_),
      inverse_dynamics_(ideal_),
      J_(unknown_.size()) {
  Eigen::Index row = 0;
  for (const CutJoint& joint : mechanism.cut_joints) {
    const CutRows rows = rows_of(joint.kind);
    for (int k = 0; k < rows.count(); ++k, ++row) {
      if (joint.clearance) continue;
      rigid_rows_.push_back(row);
      blocks_.push_back(row - k + (k < rows.positions ? 0 : rows.positions));
    }
  }
  std::ranges::copy_if(mechanism.cut_joints, std::back_inserter(clearance_joints_),
                       [](const CutJoint& joint) { return joint.clearance.has_value(); });
  for (; row < constraints_.count(); ++row) {
    rigid_rows_.push_back(row);
    blocks_.push_back(row);
  }
  all_rows_.resize(static_cast<std::size_t>(constraints_.count()));
  std::iota(all_rows_.begin(), all_rows_.end(), Eigen::Index{0});
  J_.resize(unknown_.size());
  step_.setZero(static_cast<Eigen::Index>(unknown_.size()));
  lambda_.setZero(constraints_.count());
  find_active_rows();
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

/// Whether nothing but drives and constraints moves the mechanism.
bool LoopClosure::is_left_to_drives() const {
  const auto at_rest = [](const Coordinate& c) { return c.stiffness == 0.0 && c.damping == 0.0; };
  return ideal_.springs.empty() &&
         std::all_of(ideal_.coordinates.begin(), ideal_.coordinates.end(), at_rest) &&
         unknown_.size() + ideal_.drives.size() == ideal_.coordinates.size();
}

/// Numerical rank of Phi_q of the unknown coordinates.
Eigen::Index LoopClosure::calc_rank() const { return rank_of(calc_columns(unknown_)); }

LoopClosure::Determinacy LoopClosure::find_determinacy(const Evaluation& assembled) {
  if (!is_left_to_drives() || active_rows_.size() < unknown_.size()) return Determinacy::kFree;
  Evaluation at = assembled;
  calc_positions(at);
  const auto unknown = static_cast<Eigen::Index>(unknown_.size());
  const bool is_solvable = calc_rank() == unknown;
  if (is_solvable && active_rows_.size() != unknown_.size()) return Determinacy::kFree;
  // A linkage at rest has no rates that tell the branches apart next to a change point.
  const bool at_rest = assembled.qd.isZero(0.0);
  if (is_solvable && !(at_rest && calc_binding_rank() < unknown)) return Determinacy::kDetermined;
  const Eigen::VectorXd displacement = calc_drive_displacement(ideal_);
  const Eigen::VectorXd moved = perturb(ideal_, assembled.q + displacement, kPerturbation, kAlternating);
  const bool determined_elsewhere =
      !displacement.isZero(0.0) && close_from_perturbed(moved) && calc_rank() == unknown;
  if (determined_elsewhere) return Determinacy::kSingularStart;
  return is_solvable ? Determinacy::kDetermined : Determinacy::kFree;
}

LoopClosure::Start LoopClosure::find_start(const Evaluation& assembled) {
  constexpr double kMoved = 0.05;  // of the perturbation: more than what a taut chain yields
  if (rigid_rows_.empty()) return Start::kRegular;
  const bool can_start = can_accelerate(assembled);
  if (can_start && !assembled.qd.isZero(0.0)) return Start::kRegular;
  const Eigen::Index rank_here = calc_binding_rank();
  const Eigen::VectorXd displacement = calc_drive_displacement(ideal_) / kSmallDisplacement;
  bool moves = false;
  // The links may differ in length by orders of magnitude: rows bind farther away only.
  for (const double size : {kPerturbation, 30.0 * kPerturbation})
    for (const double pattern : {kAlternating, 1.7}) {
      const Eigen::VectorXd displaced = assembled.q + size * displacement;
      const std::optional<Eigen::VectorXd> closed =
          close_from_perturbed(perturb(ideal_, displaced, size, pattern));
      if (!closed) continue;
      if (calc_binding_rank() > rank_here) return Start::kChangePoint;
      moves |= (*closed - displaced).cwiseAbs().maxCoeff() > kMoved * size;
    }
  if (!can_start) return Start::kContradiction;
  const auto moving = static_cast<Eigen::Index>(find_coordinates(ideal_, is_any).size());
  const auto rigid = std::ranges::count_if(
      rigid_rows_, [&](Eigen::Index row) { return std::ranges::binary_search(active_rows_, row); });
  const bool binds_less = rank_here < std::min<Eigen::Index>(rigid, moving);
  return binds_less && !moves ? Start::kImmovable : Start::kRegular;
}

/// Rigid rows of Phi_q, of all coordinates that are not driven.
Eigen::MatrixXd LoopClosure::calc_rigid_rows() const {
  return calc_columns(find_coordinates(ideal_, is_any))(rigid_rows_, Eigen::all);
}

/// Weights that make the largest entry among the rows of a joint's position, or of its axes, one: ranks then
/// do not depend on the lengths of links.
Eigen::VectorXd LoopClosure::calc_row_weights() const {
  const Eigen::MatrixXd J = calc_rigid_rows();
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(J.rows());
  if (J.cols() == 0) return weights;
  const Eigen::VectorXd largest = J.cwiseAbs().rowwise().maxCoeff();
  for (Eigen::Index r = 0; r < largest.size(); ++r) {
    double of_block = 0.0;
    for (Eigen::Index s = 0; s < largest.size(); ++s)
      if (blocks_[static_cast<std::size_t>(s)] == blocks_[static_cast<std::size_t>(r)])
        of_block = std::max(of_block, largest[s]);
    if (of_block > 0.0) weights[r] = 1.0 / of_block;
  }
  return weights;
}

/// Number of rigid rows that bind more than weakly.
Eigen::Index LoopClosure::calc_binding_rank() const {
  const Eigen::MatrixXd J = calc_rigid_rows();
  return J.size() == 0 ? 0 : decompose(calc_row_weights().asDiagonal() * J, kBindsWeakly).rank();
}

/// Whether accelerations exist that keep the rigid joints closed, with the accelerations of the drives: where
/// rows of Phi_q are dependent, the velocities may leave none.
bool LoopClosure::can_accelerate(const Evaluation& assembled) {
  constexpr double kFits = 1e-3, kRounding = 1e-9;  // of the bias; of the squares of the rates
  Evaluation at = assembled;
  set_drives(at.t, at);
  for (const FrameIndex i : find_coordinates(ideal_, is_any)) at.qdd[i] = 0.0;
  calc_positions(at);
  calc_rates(at);
  const Eigen::VectorXd weights = calc_row_weights();
  const Eigen::VectorXd bias = weights.cwiseProduct(constraints_.bias(rigid_rows_));
  const Eigen::MatrixXd J = weights.asDiagonal() * calc_rigid_rows();
  const Eigen::VectorXd left = J.size() == 0 ? bias : bias - J * decompose(J, kBindsWeakly).solve(bias);
  return left.norm() <= kFits * bias.norm() + kRounding * at.qd.squaredNorm();
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
}

void LoopClosure::calc_rates(Evaluation& at) {
  calc_frame_rates(ideal_, at.qd, at.qdd, at.frames);
  constraints_.calc_rates(at.q, at.qd, at.qdd, at.frames);
}

bool LoopClosure::assemble(double t, Evaluation& at) {
  if (close_from_guess(t, at) && turned_over_ < 0) return assemble_rates(at);
  const Evaluation found = at;
  if (turned_over_ >= 0) {
    if (close_upright(t, at) && turned_over_ < 0) return assemble_rates(at);
    at = found;
    calc_positions(at);
    turned_over_ = constraints_.find_turned_over(at.frames);
    return false;
  }
  return close_within_clearances(at) && assemble_rates(at);
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
  const bool closed = close(at, AxisResiduals::kProducts, kClosed, all_rows_);
  turned_over_ = closed ? constraints_.find_turned_over(at.frames) : -1;
  return closed;
}

/// From the guess as well, with residuals that tell a half turn.
bool LoopClosure::close_upright(double t, Evaluation& at) {
  constexpr double kNearlyClosed = 1e-6;  // of Phi, [m] and [1]
  set_guess(t, at);
  const bool closed = close(at, AxisResiduals::kRotationVectors, kNearlyClosed, all_rows_) &&
                      close(at, AxisResiduals::kProducts, kClosed, all_rows_);
  turned_over_ = constraints_.find_turned_over(at.frames);
  return closed;
}

/// From a position in which given coordinates keep journals off the centres of their bearings: closes the
/// joints without clearance, in the nearest position. False unless every journal is then in its bore.
bool LoopClosure::close_within_clearances(Evaluation& at) {
  if (clearance_joints_.empty() || !close(at, AxisResiduals::kProducts, kClosed, rigid_rows_)) return false;
  turned_over_ = constraints_.find_turned_over(at.frames);
  return turned_over_ < 0 && std::ranges::all_of(clearance_joints_, [&](const CutJoint& joint) {
           return is_in_bore(joint, at.frames);
         });
}

/// Newton's method from the position that `at` holds, for some of the rows.
bool LoopClosure::close(Evaluation& at, AxisResiduals axes, double tolerance,
                        const std::vector<Eigen::Index>& rows) {
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    calc_positions(at, axes);
    const Eigen::VectorXd gaps = constraints_.Phi(rows);
    if (gaps.size() == 0 || gaps.cwiseAbs().maxCoeff() < tolerance) return true;
    if (unknown_.empty()) return false;
    Eigen::VectorXd step = -decompose(calc_columns(unknown_)(rows, Eigen::all)).solve(gaps);
    step *= std::min(1.0, kMaxStep / step.cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < unknown_.size(); ++k) at.q[unknown_[k]] += step[static_cast<Eigen::Index>(k)];
  }
  return false;
}

bool LoopClosure::assemble_rates(Evaluation& at) {
  calc_rates(at);
  if (constraints_.count() == 0) return true;
  const auto rigid = static_cast<Eigen::Index>(rigid_rows_.size());
  redundant_ = rigid - rank_of(calc_columns(find_coordinates(ideal_, is_any))(rigid_rows_, Eigen::all));
  // A journal that has clearance may also move in its bearing from the start.
  rates_fit_ = find_rates(all_rows_, at) || find_rates(rigid_rows_, at);
  return rates_fit_;
}

/// Minimum-norm solution for the rates that are not given. False if the given rates violate the constraint
/// rows.
bool LoopClosure::find_rates(const std::vector<Eigen::Index>& rows, Evaluation& at) {
  constexpr double kFits = 1e-9;  // of the residual that the given rates alone leave, [m/s] and [1/s]
  const std::vector<FrameIndex> open = find_coordinates(ideal_, is_rate_found_by_loops);
  for (const FrameIndex i : open) at.qd[i] = 0.0;
  calc_rates(at);
  if (rows.empty()) return true;
  const double given = constraints_.Phi_d(rows).cwiseAbs().maxCoeff();
  if (!open.empty()) {
    const Eigen::VectorXd rates =
        -decompose(calc_columns(open)(rows, Eigen::all)).solve(constraints_.Phi_d(rows));
    for (std::size_t k = 0; k < open.size(); ++k) at.qd[open[k]] = rates[static_cast<Eigen::Index>(k)];
    calc_rates(at);
  }
  return constraints_.Phi_d(rows).cwiseAbs().maxCoeff() <= kFits * std::max(1.0, given);
}

bool LoopClosure::drives_can_start(const Evaluation& assembled) {
  const bool at_rest = assembled.qd.isZero(0.0);  // if not, assemble() has checked the velocities
  if (rigid_rows_.empty() || ideal_.drives.empty() || !at_rest) return true;
  const Eigen::VectorXd displacement = calc_drive_displacement(ideal_);
  const Eigen::VectorXd start = perturb(ideal_, assembled.q + displacement, kPerturbation, kAlternating);
  return is_free(displacement) || close_from_perturbed(start).has_value();
}

/// Whether the other coordinates can follow a small displacement of the drives, to first order.
bool LoopClosure::is_free(const Eigen::VectorXd& displacement) const {
  constexpr double kTorn = 0.5;  // of the residual of each drive alone: drives may differ a little
  constexpr double kFar = 1e3;   // of the drives' displacement: nearer to a dead position counts as one
  const Eigen::MatrixXd Phi_q = constraints_.Phi_q(rigid_rows_, Eigen::all);
  const Eigen::VectorXd change = minimum_norm_correction(Phi_q * displacement);
  const Eigen::VectorXd left = Phi_q * (displacement + change);
  return change.norm() <= kFar * displacement.norm() &&
         left.norm() <= kTorn * (Phi_q.cwiseAbs() * displacement.cwiseAbs()).norm();
}

/// Whether the loops close, with the drives fixed, from a perturbed position. In a dead position no
/// displacement is free to first order, but the linkage may still move.
/// @returns the position in which they close; empty: they do not
std::optional<Eigen::VectorXd> LoopClosure::close_from_perturbed(Eigen::VectorXd q) {
  constexpr double kMeets = 1e-9;   // [m] and [1]
  Evaluation at;
  at.qd = at.qdd = Eigen::VectorXd::Zero(q.size());
  at.q = std::move(q);
  at.frames.resize(ideal_.coordinates.size());
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    calc_positions(at);
    const Eigen::VectorXd gaps = constraints_.Phi(rigid_rows_);
    if (gaps.cwiseAbs().maxCoeff() < kMeets) return at.q;
    const Eigen::VectorXd step = minimum_norm_correction(gaps);
    const double size = step.cwiseAbs().maxCoeff();
    if (size == 0.0) return std::nullopt;
    at.q += std::min(1.0, kMaxStep / size) * step;
  }
  return std::nullopt;
}

/// Minimum-norm change of the coordinates that are not driven, to first order, that closes gaps in the rigid
/// rows.
Eigen::VectorXd LoopClosure::minimum_norm_correction(const Eigen::VectorXd& gaps) const {
  const std::vector<FrameIndex> others = find_coordinates(ideal_, is_any);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(ideal_.coordinates.size()));
  if (!others.empty()) change(others) = -decompose(calc_columns(others)(rigid_rows_, Eigen::all)).solve(gaps);
  return change;
}

Eigen::MatrixXd LoopClosure::calc_columns(const std::vector<FrameIndex>& coordinates) const {
  Eigen::MatrixXd columns(constraints_.count(), static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = constraints_.Phi_q.col(coordinates[k]);
  return columns;
}

void LoopClosure::extrapolate(double t, const Evaluation& before, const Evaluation& nearby,
                              Evaluation& at) const {
  constexpr double kFar = 5.0;  // intervals: beyond, the rounding of the two instants counts
  const double interval = nearby.t - before.t;
  const double s = (t - before.t) / interval;
  if (interval > 0.0 && std::abs(s) < kFar) {
    for (const FrameIndex i : unknown_) {
      const Quintic q(interval, before.q[i], before.qd[i], before.qdd[i],
                      nearby.q[i], nearby.qd[i], nearby.qdd[i]);
      at.q[i] = q.value(s);
    }
    at.t = t;
  } else {
    at.q = nearby.q;
    at.t = nearby.t;
  }
  at.qd = nearby.qd;
  at.qdd = nearby.qdd;
}

bool LoopClosure::solve(double t, Evaluation& at) {
  if (!solve_motion(t, at)) return false;
  solve_forces(at);
  return true;
}

bool LoopClosure::solve_motion(double t, Evaluation& at) {
  assert(active_rows_.size() == unknown_.size());
  predict(t, at);
  set_drives(t, at);
  if (!close_position(at)) return false;
  solve_rates(at);
  calc_rates(at);
  take_active(constraints_.bias);
  apply_newton_step(at.qdd);
  return at.qdd.allFinite();
}

/// Taylor series of the unknown coordinates; their accelerations are set to zero, to be solved for.
void LoopClosure::predict(double t, Evaluation& at) const {
  const double dt = t - at.t;
  for (const FrameIndex i : unknown_) {
    at.q[i] += dt * (at.qd[i] + 0.5 * dt * at.qdd[i]);
    at.qdd[i] = 0.0;
  }
}

/// step_ <- the entries of the active rows
void LoopClosure::take_active(const Eigen::Ref<const Eigen::VectorXd>& rows) {
  for (std::size_t r = 0; r < active_rows_.size(); ++r)
    step_[static_cast<Eigen::Index>(r)] = rows[active_rows_[r]];
}

/// Newton step: solves J step = residual, which step_ holds, and subtracts the step from the unknown
/// coordinates.
void LoopClosure::apply_newton_step(Eigen::VectorXd& coordinates) {
  J_.solve_in_place(step_.data());
  for (std::size_t k = 0; k < unknown_.size(); ++k)
    coordinates[unknown_[k]] -= step_[static_cast<Eigen::Index>(k)];
}

/// Newton's method from the predicted position. The solution is near only if the steps contract from the
/// first one on. After many revolutions of an angle, its rounding bounds how well the loops close.
bool LoopClosure::close_position(Evaluation& at) {
  constexpr int kMaxNear = 12;
  constexpr double kContraction = 0.25;
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();  // of the largest coordinate
  constexpr double kNearSingular = 1e-2;  // a small residual leaves a large error then: one more step
  double last = kMaxStep;
  for (int iteration = 0; iteration < kMaxNear; ++iteration) {
    calc_positions(at);
    if (!factor()) return false;
    if (residual() < kClosed && (iteration > 0 || J_.pivot_ratio() > kNearSingular)) return true;
    take_active(constraints_.Phi);
    apply_newton_step(at.q);
    const double size = step_.cwiseAbs().maxCoeff();
    if (size <= kRounding * at.q.cwiseAbs().maxCoeff()) {
      calc_positions(at);
      return factor();
    }
    if (!(size < kContraction * last)) return false;
    last = size;
  }
  return false;
}

/// Factors Phi_q of the unknown coordinates. False if it is singular.
bool LoopClosure::factor() {
  for (std::size_t r = 0; r < J_.size(); ++r)
    for (std::size_t k = 0; k < J_.size(); ++k)
      J_(r, k) = constraints_.Phi_q(active_rows_[r], unknown_[k]);
  return J_.factor();
}

/// Solves Phi_q qd = 0 for the unknown rates; those of the drives are given.
void LoopClosure::solve_rates(Evaluation& at) {
  for (const FrameIndex i : unknown_) at.qd[i] = 0.0;
  for (std::size_t r = 0; r < active_rows_.size(); ++r)
    step_[static_cast<Eigen::Index>(r)] = constraints_.Phi_q.row(active_rows_[r]).dot(at.qd);
  apply_newton_step(at.qd);
}

/// With all accelerations known the recursion gives every generalised force. On the unknown coordinates the
/// reactions alone act: Phi_q^T lambda equals their forces.
void LoopClosure::solve_forces(Evaluation& at) {
  calc_frame_rates(ideal_, at.qd, at.qdd, at.frames);
  const Eigen::VectorXd& forces = inverse_dynamics_.calc(at.frames);
  for (std::size_t k = 0; k < unknown_.size(); ++k)
    step_[static_cast<Eigen::Index>(k)] = forces[unknown_[k]];
  J_.solve_transposed_in_place(step_.data());
  for (std::size_t r = 0; r < active_rows_.size(); ++r)
    lambda_[active_rows_[r]] = step_[static_cast<Eigen::Index>(r)];
  for (std::size_t k = 0; k < at.joints.size(); ++k) {
    const auto [force, moment] = constraints_.calc_reaction(k, lambda_, at.frames);
    at.joints[k].reaction_W = to_eigen(force);
    at.joints[k].moment_W = to_eigen(moment);
  }
  for (std::size_t k = 0; k < ideal_.drives.size(); ++k) {
    const FrameIndex d = ideal_.drives[k].coordinate;
    at.drive_force[static_cast<Eigen::Index>(k)] = forces[d] - constraints_.Phi_q.col(d).dot(lambda_);
  }
}

void LoopClosure::interpolate(double t, const Evaluation& before, const Evaluation& after,
                              Evaluation& at) const {
  const double interval = after.t - before.t, since = t - before.t, s = since / interval;
  for (const FrameIndex i : unknown_) {
    if (!(interval > 0.0)) {
      at.q[i] = before.q[i] + since * (before.qd[i] + 0.5 * since * before.qdd[i]);
      at.qd[i] = before.qd[i] + since * before.qdd[i];
      at.qdd[i] = before.qdd[i];
      continue;
    }
    const Quintic q(interval, before.q[i], before.qd[i], before.qdd[i], after.q[i], after.qd[i],
                    after.qdd[i]);
    at.q[i] = q.value(s);
    at.qd[i] = q.rate(s);
    at.qdd[i] = q.acceleration(s);
  }
  set_drives(t, at);
  calc_frame_motions(ideal_, at.q, at.qd, at.qdd, at.frames);
  const auto mix = [w = interval > 0.0 ? s : 0.0](const auto& from, const auto& to, auto& mixed) {
    mixed = (1.0 - w) * from + w * to;
  };
  mix(before.drive_force, after.drive_force, at.drive_force);
  for (std::size_t k = 0; k < at.joints.size(); ++k) {
    mix(before.joints[k].reaction_W, after.joints[k].reaction_W, at.joints[k].reaction_W);
    mix(before.joints[k].moment_W, after.joints[k].moment_W, at.joints[k].moment_W);
  }
}

}  // namespace engine
