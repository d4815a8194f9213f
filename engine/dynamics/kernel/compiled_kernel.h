// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "engine/dynamics/dynamics_kernel.h"
#include "engine/dynamics/kernel/forward/forward_dynamics.h"
#include "engine/dynamics/kernel/newton/newton_matrix.h"
#include "engine/dynamics/kernel/newton/recursive_newton.h"
#include "engine/dynamics/kernel/read_out.h"
#include "engine/dynamics/kernel/tangent/bristle_jacobian.h"
#include "engine/dynamics/kernel/tangent/linearised_dynamics.h"
#include "engine/dynamics/kernel/tangent/operating_point.h"
#include "engine/dynamics/kernel/tangent/seed_schedule.h"
#include "engine/dynamics/kernel/tangent/state_jacobian.h"
#include "engine/dynamics/state_layout.h"
#include "engine/math/complex.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The dynamics kernel of a topology: state vectors in and out, around ForwardDynamics, LinearisedDynamics
/// and the Newton solvers.
/// @tparam Topology  DynamicTopology or a StaticTopology; of the evaluations that are kept, which are in
/// memory anyway, the rolled one
template <typename Topology>
class CompiledKernel final : public DynamicsKernel {
 public:
  CompiledKernel(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles,
                 AppliedValues applied)
      : model_(model),
        layout_{static_cast<int>(model.free.size()), static_cast<int>(bristles),
                static_cast<int>(model.drives.size()),
                model.force_works + static_cast<int>(model.body_loads.size())},
        joints_(joints), applied_(applied), bristle_rates_(bristles),
        kept_(model, joints, applied),
        point_(model, joints, bristles, kept_),
        linearised_(model, kept_, point_, joints.size(), applied),
        jacobian_(layout_),
        schedule_(model, BristleJacobian::kMaxLoads * joints.size(), jacobian_.by_t.size()),
        bristle_jacobian_(joints, schedule_.motion_chunks(), jacobian_.by_t.size()),
        recursive_(fits_recursive_solver(model) ? std::make_unique<RecursiveSolvers>(model, joints, layout_)
                                                : nullptr) {
    kept_.drive_force.fill(0.0);  // to be read if the first evaluation fails
  }

  EvaluationStatus evaluate(const double* y, const DrivenMotion* drives, bool drives_moved,
                            double* dydt) override {
    if constexpr (Topology::is_static) {
      ForwardDynamics<Topology> at(model_, joints_, applied_);
      at.bristle_rates = dydt + layout_.bristle();
      return evaluate(y, drives, at, dydt);
    } else {
      return evaluate_and_keep(y, drives, drives_moved, dydt);
    }
  }

  EvaluationStatus evaluate_and_keep(const double* y, const DrivenMotion* drives, bool drives_moved,
                                     double* dydt) override {
    kept_.drives_moved = Topology::is_static || drives_moved;
    kept_.bristle_rates = bristle_rates_.data();
    const EvaluationStatus status = evaluate(y, drives, kept_, dydt);
    kept_.bristles = nullptr;
    for (int b = 0; b < layout_.bristles; ++b)
      dydt[layout_.bristle(b)] = bristle_rates_[b];
    return status;
  }

  void read_out(Evaluation& at) const override;

  bool can_solve_recursively() const override { return recursive_ != nullptr; }

  void linearise(const double* y, const DrivenMotion* drives, NewtonSolver newton_solver,
                 double* by_t) override {
    newton_solver_ = newton_solver;
    find_acting_bristles(y);
    point_.set(y + layout_.bristle(), jacobian_.acting.data(), 2 * jacobian_.pairs);
    if (newton_solver == NewtonSolver::kRecursive)
      linearise_for_recursive(drives);
    else
      linearise_for_dense(drives);
    jacobian_.write_time_derivative(by_t);
  }

  bool factor(double shift) override {
    return with_solvers([&](auto& solvers) { return solvers.real.factor(shift); });
  }
  bool factor(double real, double imag) override {
    return with_solvers([&](auto& solvers) { return solvers.complex.factor({real, imag}); });
  }
  void solve(double* x) override {
    with_solvers([&](auto& solvers) { solvers.real.solve_in_place({x}); });
  }
  void solve(double* real, double* imag) override {
    with_solvers([&](auto& solvers) { solvers.complex.solve_in_place({real, imag}); });
  }

 private:
  /// Calls f with the solvers, dense or recursive, of the last linearise().
  template <typename Function>
  auto with_solvers(const Function& f) {
    return newton_solver_ == NewtonSolver::kRecursive ? f(*recursive_) : f(*dense_);
  }

  template <typename Visited>
  RPSUP_INLINE EvaluationStatus evaluate(const double* y, const DrivenMotion* drives,
                                         ForwardDynamics<Visited>& at, double* dydt) const {
    set_state(y, drives, at);
    const EvaluationStatus status = at.evaluate(drives);
    if (status == EvaluationStatus::kOk) write_rates(at, dydt);
    return status;
  }

  /// Sets q, qd, the driven qdd and the bristles; the free qdd to zero.
  template <typename Visited>
  RPSUP_INLINE void set_state(const double* y, const DrivenMotion* drives,
                              ForwardDynamics<Visited>& at) const {
    Visited::for_each_joint(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      for_each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA {
        const int i = joint.first + k;
        at.q[i] = joint.driven ? drives[joint.drive].q : y[layout_.q(joint.first_free + k)];
        at.qd[i] = joint.driven ? drives[joint.drive].qd : y[layout_.v(joint.first_free + k)];
        at.qdd[i] = joint.driven ? drives[joint.drive].qdd : 0.0;
      });
    });
    at.bristles = y + layout_.bristle();
  }

  template <typename Visited>
  RPSUP_INLINE void write_rates(const ForwardDynamics<Visited>& at, double* dydt) const {
    Visited::for_each_joint(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.driven) return;
      for_each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA {
        dydt[layout_.q(joint.first_free + k)] = at.qd[joint.first + k];
        dydt[layout_.v(joint.first_free + k)] = at.qdd[joint.first + k];
      });
    });
    double* works = dydt + layout_.work();
    if constexpr (!Topology::is_static) {
      for (std::size_t k = 0; k < at.drive_force.size(); ++k)
        works[k] = at.drive_force[k] * at.qd[model_.drives[k]];
    } else {
      Visited::for_each_joint(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
        if (!joint.driven) return;
        works[joint.drive] = at.drive_force[joint.drive] * at.qd[joint.first];
      });
    }
    if constexpr (Topology::has_applied_forces)
      for (std::size_t k = 0; k < model_.applied_forces.size(); ++k) {
        const AppliedForce& force = model_.applied_forces[k];
        if (force.work >= 0)
          works[layout_.drives + force.work] = applied_.forces[k].force * at.qd[force.coordinate];
      }
    if constexpr (Topology::has_point_springs)
      for (std::size_t k = 0; k < at.body_loads.size(); ++k)
        works[layout_.drives + model_.force_works + k] = at.body_loads[k].power;
    works[layout_.impact_in_works()] = at.losses.impact;
    works[layout_.friction_in_works()] = at.losses.friction;
    works[layout_.structural_in_works()] = at.losses.structural;
  }

  /// Pairs of bristles that touch or are bent. The others have no rate and no force.
  void find_acting_bristles(const double* y) {
    std::size_t count = 0;
    const double* bristles = y + layout_.bristle();
    for (int b = 0; b < layout_.bristles; b += 2) {
      const bool acts = bristle_rates_[b] != 0.0 ||
                        bristle_rates_[b + 1] != 0.0 || bristles[b] != 0.0 ||
                        bristles[b + 1] != 0.0;
      if (!acts) continue;
      jacobian_.acting[count++] = b;
      jacobian_.acting[count++] = b + 1;
    }
    jacobian_.pairs = static_cast<int>(count / 2);
  }

  /// Computes all blocks of the Jacobian, chunk by chunk of seeds.
  void linearise_for_dense(const DrivenMotion* drives) {
    if (!dense_) {
      jacobian_.make_matrices();
      dense_ = std::make_unique<DenseSolvers>(jacobian_);
    }
    bristle_jacobian_.collect_load_seeds(point_.contacts.data(), point_.acting.data(), jacobian_);
    schedule_.start(drives, bristle_jacobian_.loads(), bristle_jacobian_.load_count(), jacobian_);
    for (int chunk = 0; chunk < schedule_.chunks(); ++chunk) {
      const int load = schedule_.first_load(chunk);
      linearised_.calc_tangents(schedule_.coordinate_seeds(chunk), schedule_.loads() + load,
                                schedule_.end_load(chunk) - load, schedule_.time(chunk), drives);
      store_outputs(chunk);
    }
    bristle_jacobian_.write(schedule_, point_.contacts.data(), point_.acting.data(), jacobian_);
  }

  /// Computes df/dt alone: the recursive solvers take the operating point in the place of the Jacobian.
  void linearise_for_recursive(const DrivenMotion* drives) {
    schedule_.start(drives, nullptr, 0, jacobian_);
    linearised_.calc_tangents(schedule_.coordinate_seeds(0), nullptr, 0, schedule_.time(0), drives);
    store_outputs(0);
    bristle_jacobian_.write_by_time(point_.contacts.data(), point_.acting.data(), jacobian_);
    recursive_->real.set_operating_point(point_.view());
    recursive_->complex.set_operating_point(point_.view());
  }

  void store_outputs(int chunk) {
    if (chunk < schedule_.motion_chunks())
      bristle_jacobian_.store_journal_tangents(chunk, linearised_.journals.data());
    int row = 0;
    for (const int i : model_.free) schedule_.output(row++) = linearised_.qdd[i];
    row = jacobian_.first_work;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const int drive = model_.drives[k];
      schedule_.output(row++) = kept_.qd[drive] * linearised_.drive_force[k] +
                                kept_.drive_force[k] * schedule_.coordinate_seeds(chunk)[drive].qd;
    }
    for (std::size_t k = 0; k < model_.applied_forces.size(); ++k) {
      const AppliedForce& force = model_.applied_forces[k];
      if (force.work < 0) continue;
      schedule_.output(row++) =
          kept_.qd[force.coordinate] * linearised_.applied_force[k] +
          applied_.forces[k].force * schedule_.coordinate_seeds(chunk)[force.coordinate].qd;
    }
    for (const TangentPack& power : linearised_.body_load_power) schedule_.output(row++) = power;
    schedule_.output(row++) = linearised_.losses.impact;
    schedule_.output(row++) = linearised_.losses.friction;
    schedule_.output(row++) = linearised_.losses.structural;
    schedule_.store(chunk);
  }

  struct DenseSolvers {
    explicit DenseSolvers(const StateJacobian& J) : real(J), complex(J) {}
    NewtonMatrix<double> real;
    NewtonMatrix<Complex<double>> complex;
  };

  struct RecursiveSolvers {
    RecursiveSolvers(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                     const StateLayout& layout)
        : real(model, joints, layout), complex(model, joints, layout) {}
    RecursiveNewtonSolver<double> real;
    RecursiveNewtonSolver<Complex<double>> complex;
  };

  const TreeModel& model_;
  StateLayout layout_;
  const std::vector<ClearanceJoint>& joints_;
  AppliedValues applied_;
  Buffer<double> bristle_rates_;                ///< of the kept evaluation
  ForwardDynamics<typename Topology::Rolled> kept_;
  OperatingPoint<typename Topology::Rolled> point_;
  LinearisedDynamics<typename Topology::Rolled> linearised_;
  StateJacobian jacobian_;
  SeedSchedule schedule_;
  BristleJacobian bristle_jacobian_;
  std::unique_ptr<RecursiveSolvers> recursive_; ///< null: see fits_recursive_solver()
  std::unique_ptr<DenseSolvers> dense_;         ///< null until it is needed
  NewtonSolver newton_solver_ = NewtonSolver::kDense;  ///< of the last linearise()
};

template <typename Topology>
void CompiledKernel<Topology>::read_out(Evaluation& at) const {
  for (int i = 0; i < model_.coordinates; ++i) {
    at.q.data()[i] = kept_.q[i];
    at.qd.data()[i] = kept_.qd[i];
    at.qdd.data()[i] = kept_.qdd[i];
  }
  for (std::size_t i = 0; i < kept_.frames.size(); ++i)
    for (int k = 0; k < model_.joints[i].count(); ++k)
      read_out_frame(kept_.frames[i], kept_.axes[i], k, at.frames.data()[model_.joints[i].first + k]);
  Topology::for_each_auxiliary(model_, [&](std::size_t, const auto& joint) {
    read_out_auxiliary(joint, kept_.ground(), &kept_.q[joint.first], &kept_.qd[joint.first],
                       at.frames.data()[joint.first]);
  });
  for (std::size_t k = 0; k < model_.drives.size(); ++k) at.drive_force.data()[k] = kept_.drive_force[k];
  for (std::size_t k = 0; k < kept_.cuts.size(); ++k) read_out_joint(kept_.cuts[k], at.joints.data()[k]);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
