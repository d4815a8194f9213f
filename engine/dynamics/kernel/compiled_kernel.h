// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "engine/dynamics/dynamics_kernel.h"
#include "engine/dynamics/kernel/forward/forward_dynamics.h"
#include "engine/dynamics/kernel/newton/newton_matrix.h"
#include "engine/dynamics/kernel/newton/recursive_newton.h"
#include "engine/dynamics/kernel/tangent/bristle_jacobian.h"
#include "engine/dynamics/kernel/tangent/linearised_dynamics.h"
#include "engine/dynamics/kernel/tangent/seed_schedule.h"
#include "engine/dynamics/kernel/tangent/state_jacobian.h"
#include "engine/math/complex.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The equations of motion and their derivatives between the plain arrays of states. What is kept stands in memory anyhow: there rods in series are
/// visited in loops.
template <typename Shapes>
class CompiledEquations final : public Equations {
 public:
  CompiledEquations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles)
      : model_(model),
        free_(static_cast<int>(model.free.size())),
        bristles_(static_cast<int>(bristles)),
        joints_(joints),
        bristle_rates_(bristles),
        kept_(model, joints),
        varied_(model, joints, bristles, kept_),
        jacobian_(free_, bristles_, static_cast<int>(model.drives.size())),
        plan_(model, BristleDerivatives::kMostLoads * joints.size(), jacobian_.by_t.size()),
        bristle_derivatives_(joints, plan_.moving_groups(), jacobian_.by_t.size()),
        bodies_(fits_bodies(model) ? std::make_unique<Bodies>(model, joints) : nullptr) {
    kept_.drive_force.fill(0.0);  // to be read if the first evaluation fails
  }

  EvaluationStatus evaluate(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) override {
    if constexpr (Shapes::known) {
      EquationsOfMotion<Shapes> at(model_, joints_);
      at.bristle_rates = dydt + 2 * free_;
      return evaluate(y, drives, at, dydt);
    } else {
      return evaluate_and_keep(y, drives, drives_moved, dydt);
    }
  }

  EvaluationStatus evaluate_and_keep(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) override {
    kept_.drives_moved = Shapes::known || drives_moved;
    kept_.bristle_rates = bristle_rates_.data();
    const EvaluationStatus status = evaluate(y, drives, kept_, dydt);
    kept_.bristles = nullptr;
    for (int b = 0; b < bristles_; ++b) dydt[2 * free_ + b] = bristle_rates_[static_cast<std::size_t>(b)];
    return status;
  }

  void read_out(Evaluation& at) const override;

  bool can_solve_by_bodies() const override { return bodies_ != nullptr; }

  void linearise(const double* y, const DrivenMotion* drives, Elimination elimination, double* by_t) override {
    elimination_ = elimination;
    find_acting_bristles(y);
    varied_.hold(y + 2 * free_, jacobian_.acting.data(), 2 * jacobian_.pairs);
    if (elimination == Elimination::kBodies)
      linearise_bodies(drives);
    else
      linearise_matrix(drives);
    jacobian_.write_time_derivative(by_t);
  }

  bool factor(double shift) override { return elimination_ == Elimination::kBodies ? bodies_->real.factor(shift) : shifted_->real.factor(shift); }
  bool factor(double real, double imag) override {
    const Complex<double> shift{real, imag};
    return elimination_ == Elimination::kBodies ? bodies_->complex.factor(shift) : shifted_->complex.factor(shift);
  }
  void solve(double* x) override {
    if (elimination_ == Elimination::kBodies)
      bodies_->real.solve_in_place({x});
    else
      shifted_->real.solve_in_place({x});
  }
  void solve(double* real, double* imag) override {
    if (elimination_ == Elimination::kBodies)
      bodies_->complex.solve_in_place({real, imag});
    else
      shifted_->complex.solve_in_place({real, imag});
  }

 private:
  template <typename Visited>
  RPSUP_INLINE EvaluationStatus evaluate(const double* y, const DrivenMotion* drives, EquationsOfMotion<Visited>& at, double* dydt) const {
    set_state(y, drives, at);
    const EvaluationStatus status = at.evaluate(drives);
    if (status == EvaluationStatus::kOk) write_rates(at, dydt);
    return status;
  }

  /// Sets q, qd, the driven qdd and the bristles; the free qdd to zero.
  template <typename Visited>
  RPSUP_INLINE void set_state(const double* y, const DrivenMotion* drives, EquationsOfMotion<Visited>& at) const {
    Visited::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA {
        const auto i = static_cast<std::size_t>(joint.first + k);
        at.q[i] = joint.driven ? drives[joint.drive].q : y[joint.first_free + k];
        at.qd[i] = joint.driven ? drives[joint.drive].qd : y[free_ + joint.first_free + k];
        at.qdd[i] = joint.driven ? drives[joint.drive].qdd : 0.0;
      });
    });
    at.bristles = y + 2 * free_;
  }

  template <typename Visited>
  RPSUP_INLINE void write_rates(const EquationsOfMotion<Visited>& at, double* dydt) const {
    Visited::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.driven) return;
      each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA {
        dydt[joint.first_free + k] = at.qd[static_cast<std::size_t>(joint.first + k)];
        dydt[free_ + joint.first_free + k] = at.qdd[static_cast<std::size_t>(joint.first + k)];
      });
    });
    double* next = dydt + 2 * free_ + bristles_;
    if constexpr (!Shapes::known) {
      for (std::size_t k = 0; k < at.drive_force.size(); ++k) next[k] = at.drive_force[k] * at.qd[static_cast<std::size_t>(model_.drives[k])];
    } else {
      Visited::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
        if (joint.driven) next[joint.drive] = at.drive_force[static_cast<std::size_t>(joint.drive)] * at.qd[static_cast<std::size_t>(joint.first)];
      });
    }
    next += at.drive_force.size();
    *next++ = at.losses.impact;
    *next++ = at.losses.friction;
    *next++ = at.losses.structural;
  }

  /// Bristles whose contacts touch: the others neither move nor act.
  void find_acting_bristles(const double* y) {
    std::size_t count = 0;
    for (int b = 0; b < bristles_; b += 2) {
      const bool acts = bristle_rates_[static_cast<std::size_t>(b)] != 0.0 || bristle_rates_[static_cast<std::size_t>(b + 1)] != 0.0 ||
                        y[2 * free_ + b] != 0.0 || y[2 * free_ + b + 1] != 0.0;
      if (!acts) continue;
      jacobian_.acting[count++] = b;
      jacobian_.acting[count++] = b + 1;
    }
    jacobian_.pairs = static_cast<int>(count / 2);
  }

  void linearise_matrix(const DrivenMotion* drives) {
    if (!shifted_) {
      jacobian_.make_matrices();
      shifted_ = std::make_unique<Shifted>(jacobian_);
    }
    bristle_derivatives_.find_loads(varied_.contacts(), varied_.acting(), jacobian_);
    plan_.start(drives, bristle_derivatives_.loads(), bristle_derivatives_.load_count(), jacobian_);
    for (int group = 0; group < plan_.groups(); ++group) {
      const int load = plan_.first_load(group);
      varied_.differentiate(plan_.coordinates(group), plan_.loads() + load, plan_.end_load(group) - load, plan_.time(group), drives);
      take_outputs(group);
    }
    bristle_derivatives_.write(plan_, varied_.contacts(), varied_.acting(), jacobian_);
  }

  /// The derivatives by time alone.
  void linearise_bodies(const DrivenMotion* drives) {
    plan_.start(drives, nullptr, 0, jacobian_);
    varied_.differentiate(plan_.coordinates(0), nullptr, 0, plan_.time(0), drives);
    take_outputs(0);
    bristle_derivatives_.write_by_time(varied_.contacts(), varied_.acting(), jacobian_);
    const BodiesSolution solution{kept_.frames.data(), kept_.axes.data(), varied_.held(),   varied_.held_coordinates(),
                                  kept_.cuts.data(),   varied_.contacts(), varied_.acting(), kept_.qd.data()};
    bodies_->real.take_up(solution);
    bodies_->complex.take_up(solution);
  }

  void take_outputs(int group) {
    if (group < plan_.moving_groups()) bristle_derivatives_.take_journals(group, varied_.journals.data());
    int row = 0;
    for (const int i : model_.free) plan_.output(row++) = varied_.qdd[static_cast<std::size_t>(i)];
    row = jacobian_.first_work;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const int drive = model_.drives[k];
      plan_.output(row++) = kept_.qd[static_cast<std::size_t>(drive)] * varied_.drive_force[k] +
                            kept_.drive_force[k] * plan_.coordinates(group)[drive].qd;
    }
    plan_.output(row++) = varied_.losses.impact;
    plan_.output(row++) = varied_.losses.friction;
    plan_.output(row++) = varied_.losses.structural;
    plan_.store(group);
  }

  /// Solves with the Jacobian's matrices.
  struct Shifted {
    explicit Shifted(const StateJacobian& J) : real(J), complex(J) {}
    ShiftedJacobian<double> real;
    ShiftedJacobian<Complex<double>> complex;
  };

  /// Solves body by body.
  struct Bodies {
    Bodies(const TreeModel& model, const std::vector<ClearanceJoint>& joints) : real(model, joints), complex(model, joints) {}
    ShiftedBodies<double> real;
    ShiftedBodies<Complex<double>> complex;
  };

  const TreeModel& model_;
  int free_, bristles_;
  const std::vector<ClearanceJoint>& joints_;
  Buffer<double> bristle_rates_;                ///< of the solution that is kept
  EquationsOfMotion<typename Shapes::Looped> kept_;
  VariedEquations<typename Shapes::Looped> varied_;
  StateJacobian jacobian_;
  DirectionPlan plan_;
  BristleDerivatives bristle_derivatives_;
  std::unique_ptr<Bodies> bodies_;              ///< null: the tree is none for them
  std::unique_ptr<Shifted> shifted_;            ///< null until it is needed
  Elimination elimination_ = Elimination::kMatrix;  ///< of the last linearise()
};

/// Copies numbers one by one: functions of Eigen would be shared between instruction sets by the linker.
template <typename Shapes>
void CompiledEquations<Shapes>::read_out(Evaluation& at) const {
  const auto copy = [](const Vec3<double>& v, double* to) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  };
  const auto copy_matrix = [&](const Mat3<double>& m, double* to) {
    copy(m.x, to);
    copy(m.y, to + 3);
    copy(m.z, to + 6);
  };
  for (std::size_t i = 0; i < kept_.q.size(); ++i) {
    at.q.data()[i] = kept_.q[i];
    at.qd.data()[i] = kept_.qd[i];
    at.qdd.data()[i] = kept_.qdd[i];
  }
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const TreeJoint& joint = model_.joints[i];
    const Frame<double, double>& from = kept_.frames[i];
    const JointAxes& axes = kept_.axes[i];
    for (int k = 0; k < joint.count(); ++k) {
      FrameMotion& to = at.frames.data()[joint.first + k];
      copy(axes.axis[k], to.axis.data());
      copy(k == 0 ? axes.r : Vec3<double>{}, to.p_parent.data());
      copy_matrix(from.R, to.R.data());
      copy(from.p, to.p.data());
      copy(from.w, to.w.data());
      copy(from.v, to.v.data());
    }
  }
  for (std::size_t k = 0; k < model_.drives.size(); ++k) at.drive_force.data()[k] = kept_.drive_force[k];
  for (std::size_t k = 0; k < kept_.cuts.size(); ++k) {
    const CutJointMotion<double, double>& from = kept_.cuts[k];
    JointState& to = at.joints.data()[k];
    copy_matrix(from.journal.R, to.journal.R_bj.data());
    copy(from.journal.p, to.journal.p_bj.data());
    copy(from.journal.v, to.journal.v.data());
    copy(from.journal.w, to.journal.w.data());
    copy(from.reaction, to.reaction_W.data());
    copy(from.moment, to.moment_W.data());
    copy(from.load.force, to.load.force.data());
    copy(from.load.moment, to.load.moment.data());
    to.load.radial_normal_sum = from.load.radial_normal_sum;
    to.load.friction_sum = from.load.friction_sum;
    to.load.max_penetration = from.load.max_penetration;
    to.load.elastic_energy = from.load.elastic_energy;
    to.load.impact_power = from.load.impact_power;
    to.load.friction_power = from.load.friction_power;
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
