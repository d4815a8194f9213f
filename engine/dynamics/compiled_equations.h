#pragma once

#include <algorithm>
#include <memory>

#include "engine/dynamics/equations_of_motion.h"
#include "engine/dynamics/direction_plan.h"
#include "engine/dynamics/varied_equations.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The equations of motion and their derivatives between the plain arrays of states.
template <typename Shapes>
class CompiledEquations final : public Equations {
 public:
  CompiledEquations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles)
      : model_(model),
        free_(static_cast<int>(model.free.size())),
        drives_(static_cast<int>(model.drives.size())),
        bristles_(static_cast<int>(bristles)),
        plain_(model, joints, bristles),
        varied_(model, joints, plain_),
        plan_(model, bristles) {}

  EvaluationStatus evaluate(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) override {
    set_state(y, drives);
    plain_.drives_moved = drives_moved;
    const EvaluationStatus status = plain_.evaluate(drives);
    if (status == EvaluationStatus::kOk) write_rates(dydt);
    return status;
  }

  void read_out(Evaluation& at) const override;

  void linearise(const double* y, const DrivenMotion* drives, Linearisation& result) override {
    find_acting_bristles(y, result);
    varied_.hold(y + 2 * free_);
    plan_.start(drives, result.bristles, result.bristle_count);
    for (int group = 0; group < plan_.groups(); ++group) {
      const int bristle = plan_.first_bristle(group);
      varied_.differentiate(plan_.coordinates(group), plan_.bristles() + bristle, plan_.end_bristle(group) - bristle, plan_.time(group), drives);
      take_outputs(group, result);
    }
    plan_.sort(result);
  }

 private:
  /// Sets q, qd, the driven qdd and the bristles; the free qdd to zero.
  RPSUP_INLINE void set_state(const double* y, const DrivenMotion* drives) {
    for (int a = 0; a < free_; ++a) {
      const auto i = static_cast<std::size_t>(model_.free[static_cast<std::size_t>(a)]);
      plain_.q[i] = y[a];
      plain_.qd[i] = y[free_ + a];
      plain_.qdd[i] = 0.0;
    }
    if (!model_.drive_rows)
      for (int k = 0; k < drives_; ++k) {
        const auto i = static_cast<std::size_t>(model_.drives[static_cast<std::size_t>(k)]);
        plain_.q[i] = drives[k].q;
        plain_.qd[i] = drives[k].qd;
        plain_.qdd[i] = drives[k].qdd;
      }
    for (int b = 0; b < bristles_; ++b) plain_.bristles[static_cast<std::size_t>(b)] = y[2 * free_ + b];
  }

  void write_rates(double* dydt) const {
    for (int a = 0; a < free_; ++a) {
      const auto i = static_cast<std::size_t>(model_.free[static_cast<std::size_t>(a)]);
      dydt[a] = plain_.qd[i];
      dydt[free_ + a] = plain_.qdd[i];
    }
    double* next = dydt + 2 * free_;
    for (int b = 0; b < bristles_; ++b) *next++ = plain_.bristle_rates[static_cast<std::size_t>(b)];
    for (int k = 0; k < drives_; ++k) {
      const auto drive = static_cast<std::size_t>(k);
      *next++ = plain_.drive_force[drive] * plain_.qd[static_cast<std::size_t>(model_.drives[drive])];
    }
    *next++ = plain_.losses.impact;
    *next++ = plain_.losses.friction;
    *next++ = plain_.losses.structural;
  }

  /// Bristles whose contacts touch: the others neither move nor act.
  void find_acting_bristles(const double* y, Linearisation& result) const {
    int count = 0;
    for (int b = 0; b < bristles_; b += 2) {
      const bool acts = plain_.bristle_rates[static_cast<std::size_t>(b)] != 0.0 || plain_.bristle_rates[static_cast<std::size_t>(b + 1)] != 0.0 ||
                        y[2 * free_ + b] != 0.0 || y[2 * free_ + b + 1] != 0.0;
      if (!acts) continue;
      result.bristles[count++] = b;
      result.bristles[count++] = b + 1;
    }
    result.bristle_count = count;
    result.outputs = free_ + count + drives_ + 3;
  }

  void take_outputs(int group, const Linearisation& result) {
    int row = 0;
    for (const int i : model_.free) plan_.output(row++, group) = varied_.qdd[static_cast<std::size_t>(i)];
    for (int b = 0; b < result.bristle_count; ++b) plan_.output(row++, group) = varied_.bristle_rates[static_cast<std::size_t>(result.bristles[b])];
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const int drive = model_.drives[k];
      plan_.output(row++, group) = plain_.qd[static_cast<std::size_t>(drive)] * varied_.drive_force[k] +
                                   plain_.drive_force[k] * plan_.coordinates(group)[drive].qd;
    }
    plan_.output(row++, group) = varied_.losses.impact;
    plan_.output(row++, group) = varied_.losses.friction;
    plan_.output(row++, group) = varied_.losses.structural;
  }

  const TreeModel& model_;
  int free_, drives_, bristles_;
  EquationsOfMotion<Shapes> plain_;
  VariedEquations<Shapes> varied_;
  DirectionPlan plan_;
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
  for (std::size_t i = 0; i < plain_.q.size(); ++i) {
    at.q.data()[i] = plain_.q[i];
    at.qd.data()[i] = plain_.qd[i];
    at.qdd.data()[i] = plain_.qdd[i];
  }
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const TreeJoint& joint = model_.joints[i];
    const Frame<double, double>& from = plain_.frames[i];
    const JointAxes& axes = plain_.axes[i];
    for (int k = 0; k < joint.count(); ++k) {
      FrameMotion& to = at.frames.data()[joint.first + k];
      copy(axes.axis[k], to.axis.data());
      copy(k == 0 ? axes.r : Vec3<double>{}, to.p_parent.data());
      copy_matrix(from.R, to.R.data());
      copy(from.p, to.p.data());
      copy(from.w, to.w.data());
      copy(from.v, to.v.data());
      copy(from.wd, to.wd.data());
      copy(from.vd, to.vd.data());
    }
  }
  for (std::size_t k = 0; k < model_.drives.size(); ++k) at.drive_force.data()[k] = plain_.drive_force[k];
  for (std::size_t k = 0; k < plain_.cuts.size(); ++k) {
    const CutJointMotion<double, double>& from = plain_.cuts[k];
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
