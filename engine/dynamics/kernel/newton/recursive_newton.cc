// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/newton/recursive_newton.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

template <typename Scalar>
RecursiveNewtonSolver<Scalar>::RecursiveNewtonSolver(const TreeModel& model,
                                                     const std::vector<ClearanceJoint>& joints,
                                                     const StateLayout& layout)
    : model_(model),
      layout_(layout),
      drive_rates_(model.drives.size()),
      tree_(model),
      contacts_(model, joints),
      work_(model) {}

template <typename Scalar>
void RecursiveNewtonSolver<Scalar>::set_operating_point(const OperatingPointView& point) {
  for (const TreeJoint& joint : model_.joints)
    if (joint.driven) drive_rates_[joint.drive] = point.qd[joint.first];
  tree_.set_operating_point(point);
  contacts_.set_operating_point(point);
}

template <typename Scalar>
bool RecursiveNewtonSolver<Scalar>::factor(const Scalar& shift) {
  inverse_shift_ = 1.0 / shift;
  return tree_.factor(shift) && contacts_.factor(tree_, shift);
}

template <typename Scalar>
void RecursiveNewtonSolver<Scalar>::solve_in_place(NumbersAt<Scalar> x) {
  const NumbersAt<Scalar> z = x.from(layout_.bristle());
  LossPowers<Scalar> losses;
  work_.bias_force.fill({});
  contacts_.add_bristle_loads(tree_, z, work_, losses);
  tree_.solve(x, work_);
  // Rows of bristles that do not act; apply_woodbury() writes the others.
  for (int b = 0; b < layout_.bristles; ++b) z.set(b, inverse_shift_ * z[b]);
  contacts_.apply_woodbury(tree_, z, work_, losses);
  losses.structural = tree_.calc_damper_power(work_.qd);
  write_state(losses, x);
}

/// Writes q, v and the works; the bristles are set by then.
template <typename Scalar>
void RecursiveNewtonSolver<Scalar>::write_state(const LossPowers<Scalar>& losses, NumbersAt<Scalar> x) const {
  for (int i = 0; i < layout_.free; ++i) {
    const Scalar qd = work_.qd[i];
    x.set(layout_.q(i), inverse_shift_ * (qd + x[layout_.q(i)]));  // (K28)
    x.set(layout_.v(i), qd);
  }
  const auto add = [&](int i, const Scalar& power) { x.set(i, inverse_shift_ * (x[i] + power)); };
  for (int d = 0; d < layout_.drives; ++d)
    add(layout_.work(d),
        drive_rates_[d] * work_.drive_force[d]);
  add(layout_.impact(), losses.impact);
  add(layout_.friction(), losses.friction);
  add(layout_.structural(), losses.structural);
}

template class RecursiveNewtonSolver<double>;
template class RecursiveNewtonSolver<Complex<double>>;

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
