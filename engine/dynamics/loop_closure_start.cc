// SPDX-License-Identifier: Apache-2.0
// Judges the start of a mechanism: whether drives determine its motion, and whether it can move at all.
#include "engine/dynamics/loop_closure.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "engine/dynamics/loop_closure_parts.h"

namespace engine {

using namespace loop_closure;

namespace {

constexpr double kPerturbation = 0.01, kSmallDisplacement = 1e-4;  // [rad] or [m]
// Relative pivot below which a row of the Jacobian counts as dependent. DelassusMatrix takes rows below the
// square of this for redundant: the pivots of J M^-1 J^T are squares of these.
constexpr double kBindsWeakly = 3e-5;

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

Evaluation make_at_rest(Eigen::VectorXd q) {
  Evaluation at;
  at.frames.resize(static_cast<std::size_t>(q.size()));
  at.qd = at.qdd = Eigen::VectorXd::Zero(q.size());
  at.q = std::move(q);
  return at;
}

}  // namespace

/// @returns whether nothing but drives and constraints moves the mechanism
bool LoopClosure::is_left_to_drives() const {
  const auto has_no_spring_or_damper = [](const Coordinate& c) {
    return c.stiffness == 0.0 && c.damping == 0.0;
  };
  return ideal_.springs.empty() && ideal_.actuations.empty() && ideal_.body_loads.empty() &&
         std::ranges::all_of(ideal_.coordinates, has_no_spring_or_damper) &&
         unknown_.size() + ideal_.drives.size() == ideal_.coordinates.size();
}

/// Numerical rank of Phi_q of the unknown coordinates.
Eigen::Index LoopClosure::calc_rank() const { return rank_of(calc_columns_above_noise(unknown_)); }

/// @returns whether the drives, when they have moved a little, determine the motion
bool LoopClosure::is_determined_elsewhere(const Evaluation& assembled) {
  const Eigen::VectorXd displacement = calc_drive_displacement(ideal_);
  const Eigen::VectorXd moved = perturb(ideal_, assembled.q + displacement, kPerturbation, kAlternating);
  return !displacement.isZero(0.0) && close_from_perturbed(moved) &&
         calc_rank() == static_cast<Eigen::Index>(unknown_.size());
}

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
  if (is_determined_elsewhere(assembled)) return Determinacy::kSingularStart;
  return is_solvable ? Determinacy::kDetermined : Determinacy::kFree;
}

LoopClosure::Start LoopClosure::find_start(const Evaluation& assembled) {
  constexpr double kMoved = 0.05;  // of the perturbation: more than what a taut chain yields
  if (rigid_rows_.empty() || ideal_.coordinates.empty()) return Start::kRegular;
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
  return calc_columns_above_noise(find_coordinates(ideal_, is_any))(rigid_rows_, Eigen::all);
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

/// @returns whether accelerations exist that keep the rigid joints closed, with the accelerations of the
/// drives: where rows of Phi_q are dependent, the velocities may leave none
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

bool LoopClosure::drives_can_start(const Evaluation& assembled) {
  const bool at_rest = assembled.qd.isZero(0.0);  // if not, assemble() has checked the velocities
  if (rigid_rows_.empty() || ideal_.drives.empty() || !at_rest) return true;
  const Eigen::VectorXd displacement = calc_drive_displacement(ideal_);
  const Eigen::VectorXd start = perturb(ideal_, assembled.q + displacement, kPerturbation, kAlternating);
  return is_free(displacement) || close_from_perturbed(start).has_value();
}

/// @returns whether the other coordinates can follow a small displacement of the drives, to first order
bool LoopClosure::is_free(const Eigen::VectorXd& displacement) const {
  constexpr double kTorn = 0.5;  // of the residual of each drive alone: drives may differ a little
  constexpr double kFar = 1e3;   // of the drives' displacement: nearer to a dead position counts as one
  const Eigen::MatrixXd Phi_q = constraints_.Phi_q(rigid_rows_, Eigen::all);
  const Eigen::VectorXd change = minimum_norm_correction(Phi_q * displacement);
  const Eigen::VectorXd left = Phi_q * (displacement + change);
  return change.norm() <= kFar * displacement.norm() &&
         left.norm() <= kTorn * (Phi_q.cwiseAbs() * displacement.cwiseAbs()).norm();
}

/// Closes the loops, with the drives fixed, from a perturbed position. In a dead position no displacement is
/// free to first order, but the linkage may still move.
/// @returns the position in which they close; empty: they do not
std::optional<Eigen::VectorXd> LoopClosure::close_from_perturbed(Eigen::VectorXd q) {
  constexpr double kMeets = 1e-9;   // [m] and [1]
  Evaluation at = make_at_rest(std::move(q));
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

}  // namespace engine
