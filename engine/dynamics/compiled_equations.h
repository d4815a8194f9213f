#pragma once

#include <algorithm>
#include <memory>

#include "engine/dynamics/equations_of_motion.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The equations of motion in plain numbers, and twice in numbers with derivatives: once where positions vary, once (much less work)
/// where only rates and bristles do.
template <typename Shapes>
class CompiledEquations final : public Equations {
 public:
  CompiledEquations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles)
      : model_(model),
        free_(static_cast<int>(model.free.size())),
        drives_(static_cast<int>(model.drives.size())),
        bristles_(static_cast<int>(bristles)),
        plain_(model, joints, bristles),
        by_position_(model, joints, bristles),
        by_rate_(model, joints, bristles),
        directions_(static_cast<std::size_t>(2 * free_ + 1) + bristles) {}

  EvaluationStatus evaluate(const double* y, const DrivenMotion* drives, bool drives_moved, double* dydt) override {
    set_state(y, drives, plain_);
    plain_.drives_moved = drives_moved;
    const EvaluationStatus status = plain_.evaluate(drives);
    if (status == EvaluationStatus::kOk) write_rates(dydt);
    return status;
  }

  void read_out(Evaluation& at) const override;

  EvaluationStatus linearise(const double* y, const DrivenMotion* drives, bool drives_moved, Linearisation& result) override {
    set_state(y, drives, plain_);
    plain_.drives_moved = drives_moved;
    const EvaluationStatus status = plain_.evaluate(drives);
    if (status != EvaluationStatus::kOk) return status;
    find_acting_bristles(y, result);
    const int positions = free_ + 1;
    const int count = list_directions(result);
    by_rate_.drives_moved = true;  // in the first of its chunks
    for (int first = 0; first < count; first += Dual::kDirections) {
      const Chunk chunk{directions_.data() + first, std::min(Dual::kDirections, count - first)};
      const EvaluationStatus sought =
          first < positions ? differentiate_chunk(chunk, y, drives, by_position_, result) : differentiate_chunk(chunk, y, drives, by_rate_, result);
      if (sought != EvaluationStatus::kOk) return sought;
    }
    return EvaluationStatus::kOk;
  }

 private:
  enum class Variable { kPosition, kTime, kRate, kBristle };
  struct Direction {
    Variable variable;
    int index;
  };
  struct Chunk {
    const Direction* directions;
    int count;
  };

  /// Sets q, qd, the driven qdd and the bristles; the free qdd to zero.
  template <typename P, typename V>
  RPSUP_INLINE void set_state(const double* y, const DrivenMotion* drives, EquationsOfMotion<P, V, Shapes>& equations) const {
    for (int a = 0; a < free_; ++a) {
      const auto i = static_cast<std::size_t>(model_.free[static_cast<std::size_t>(a)]);
      equations.q[i] = P(y[a]);
      equations.qd[i] = V(y[free_ + a]);
      equations.qdd[i] = V(0.0);
    }
    if (!model_.drive_rows)
      for (int k = 0; k < drives_; ++k) {
        const auto i = static_cast<std::size_t>(model_.drives[static_cast<std::size_t>(k)]);
        equations.q[i] = P(drives[k].q);
        equations.qd[i] = V(drives[k].qd);
        equations.qdd[i] = V(drives[k].qdd);
      }
    for (int b = 0; b < bristles_; ++b) equations.bristles[static_cast<std::size_t>(b)] = V(y[2 * free_ + b]);
  }

  void write_rates(double* dydt) const {
    for (int a = 0; a < free_; ++a) {
      const auto i = static_cast<std::size_t>(model_.free[static_cast<std::size_t>(a)]);
      dydt[a] = plain_.qd[i];
      dydt[free_ + a] = plain_.qdd[i];
    }
    double* next = dydt + 2 * free_;
    for (int b = 0; b < bristles_; ++b) *next++ = plain_.bristle_rates[static_cast<std::size_t>(b)];
    for (int k = 0; k < drives_; ++k) *next++ = calc_power(plain_, k);
    *next++ = plain_.losses.impact;
    *next++ = plain_.losses.friction;
    *next++ = plain_.losses.structural;
  }

  template <typename P, typename V>
  [[nodiscard]] RPSUP_INLINE V calc_power(const EquationsOfMotion<P, V, Shapes>& equations, int drive) const {
    const auto k = static_cast<std::size_t>(drive);
    return equations.drive_force[k] * equations.qd[static_cast<std::size_t>(model_.drives[k])];
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

  int list_directions(const Linearisation& result) {
    int count = 0;
    const auto add = [&](Variable variable, int index) { directions_[static_cast<std::size_t>(count++)] = {variable, index}; };
    for (int a = 0; a < free_; ++a) add(Variable::kPosition, a);
    add(Variable::kTime, 0);
    for (int a = 0; a < free_; ++a) add(Variable::kRate, a);
    for (int b = 0; b < result.bristle_count; ++b) add(Variable::kBristle, b);
    return count;
  }

  template <typename P>
  EvaluationStatus differentiate_chunk(const Chunk& chunk, const double* y, const DrivenMotion* drives, EquationsOfMotion<P, Dual, Shapes>& equations,
                                       Linearisation& result) {
    set_state(y, drives, equations);
    for (int lane = 0; lane < chunk.count; ++lane) seed(chunk.directions[lane], lane, drives, result, equations);
    const EvaluationStatus status = equations.evaluate(drives);
    equations.time = P(0.0);
    if constexpr (std::is_same_v<P, double>) equations.drives_moved = false;
    if (status != EvaluationStatus::kOk) return status;
    int row = 0;
    const auto take = [&](const Dual& output) {
      for (int lane = 0; lane < chunk.count; ++lane) *find_entry(chunk.directions[lane], row, result) = output.derivative(lane);
      ++row;
    };
    for (const int i : model_.free) take(equations.qdd[static_cast<std::size_t>(i)]);
    for (int b = 0; b < result.bristle_count; ++b) take(equations.bristle_rates[static_cast<std::size_t>(result.bristles[b])]);
    for (int k = 0; k < drives_; ++k) take(calc_power(equations, k));
    take(equations.losses.impact);
    take(equations.losses.friction);
    take(equations.losses.structural);
    return EvaluationStatus::kOk;
  }

  template <typename P>
  RPSUP_INLINE void seed(const Direction& direction, int lane, const DrivenMotion* drives, const Linearisation& result,
                         EquationsOfMotion<P, Dual, Shapes>& equations) const {
    const auto coordinate = [&] { return static_cast<std::size_t>(model_.free[static_cast<std::size_t>(direction.index)]); };
    if (direction.variable == Variable::kRate) equations.qd[coordinate()].set_derivative(lane, 1.0);
    if (direction.variable == Variable::kBristle)
      equations.bristles[static_cast<std::size_t>(result.bristles[direction.index])].set_derivative(lane, 1.0);
    if constexpr (std::is_same_v<P, Dual>) {
      if (direction.variable == Variable::kPosition) equations.q[coordinate()].set_derivative(lane, 1.0);
      if (direction.variable == Variable::kTime) seed_time(lane, drives, equations);
    }
  }

  RPSUP_INLINE void seed_time(int lane, const DrivenMotion* drives, EquationsOfMotion<Dual, Dual, Shapes>& equations) const {
    equations.time.set_derivative(lane, 1.0);
    if (model_.drive_rows) return;
    for (int k = 0; k < drives_; ++k) {
      const auto i = static_cast<std::size_t>(model_.drives[static_cast<std::size_t>(k)]);
      equations.q[i].set_derivative(lane, drives[k].qd);
      equations.qd[i].set_derivative(lane, drives[k].qdd);
      equations.qdd[i].set_derivative(lane, drives[k].qddd);
    }
  }

  RPSUP_INLINE double* find_entry(const Direction& direction, int row, Linearisation& result) const {
    switch (direction.variable) {
      case Variable::kPosition: return result.by_q + row * free_ + direction.index;
      case Variable::kTime: return result.by_t + row;
      case Variable::kRate: return result.by_v + row * free_ + direction.index;
      case Variable::kBristle: break;
    }
    return result.by_bristle + row * bristles_ + direction.index;
  }

  const TreeModel& model_;
  int free_, drives_, bristles_;
  EquationsOfMotion<double, double, Shapes> plain_;
  EquationsOfMotion<Dual, Dual, Shapes> by_position_;
  EquationsOfMotion<double, Dual, Shapes> by_rate_;
  Buffer<Direction> directions_;
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
    const JointAxes<double>& axes = plain_.axes[i];
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
