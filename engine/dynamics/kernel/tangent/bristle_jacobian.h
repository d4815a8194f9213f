// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/clearance/contact_derivative.h"
#include "engine/dynamics/kernel/tangent/linearised_dynamics.h"
#include "engine/dynamics/kernel/tangent/seed_schedule.h"
#include "engine/dynamics/kernel/tangent/state_jacobian.h"
#include "engine/math/buffer.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The derivatives by the bristles, and those of their rates. However many bristles a joint has, they act on the motion by the six numbers of its
/// load alone, and the motion acts on them by the twelve of its journal: what each of these does is found once.
class BristleDerivatives {
 public:
  static constexpr int kMostLoads = 6;  ///< of a joint

  /// @param stride  of the columns of outputs
  BristleDerivatives(const std::vector<ClearanceJoint>& joints, int moving_groups, std::size_t stride)
      : joint_count_(joints.size()),
        columns_(static_cast<std::size_t>(moving_groups) * Directions::kCount),
        loads_(joint_count_ * kMostLoads),
        effects_(joint_count_ * kMostLoads * stride),
        journals_(joint_count_ * kJournal * columns_) {}

  /// Of a joint's bristles the loads, or, of more than six, the six of which all loads consist.
  /// @param J  with its matrices, to which the effects of the loads will be written
  void find_loads(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting, StateJacobian& J) {
    load_count_ = 0;
    double* by_bristle = J.matrices->by_bristle.data();
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const ActingBristles& own = acting[joint];
      for (int i = 0; i < count_loads(own); ++i, ++load_count_) {
        LoadDirection& load = loads_[static_cast<std::size_t>(load_count_)];
        load.joint = joint;
        load.load = has_few(own) ? contacts[joint]->load_by_bristle(own.own[i]) : kUnitLoads[i];
        load.effect = has_few(own) ? by_bristle + i * J.stride : effects_.data() + load_count_ * J.stride;
      }
      by_bristle += own.count * J.stride;
    }
  }
  [[nodiscard]] LoadDirection* loads() { return loads_.data(); }
  [[nodiscard]] int load_count() const { return load_count_; }

  /// Takes note of how the journals vary in a group's directions.
  RPSUP_INLINE void take_journals(int group, const JournalVariation<Directions>* journals) {
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      std::size_t row = 0;
      const Vec3<Directions>* vectors[] = {&journals[joint].turn, &journals[joint].p, &journals[joint].v, &journals[joint].w};
      double* to = &journals_[joint * kJournal * columns_ + static_cast<std::size_t>(group) * Directions::kCount];
      for (const Vec3<Directions>* vector : vectors)
        for (const Directions* number : {&vector->x, &vector->y, &vector->z}) number->store(to + columns_ * row++);
    }
  }

  /// Writes the rates' derivatives by time.
  void write_by_time(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting, StateJacobian& J) const {
    each_block(contacts, acting, [&](const auto& block) {
      write_column(find_rates(block), block, DirectionPlan::kTime, J.rates_by_t.data(), J.pair_stride);
    });
  }

  /// Writes all, after the plan's store() of every group.
  void write(const DirectionPlan& plan, const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting, StateJacobian& J) const {
    each_block(contacts, acting, [&](const auto& block) { write_rates(plan, block, J); });
    write_effects(contacts, acting, J);
  }

 private:
  using FourLanes = LaneBlock<4>;
  static constexpr int kJournal = 12;
  static constexpr double kUnitLoads[kMostLoads][kMostLoads] = {{1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0},
                                                                {0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1}};

  /// Pairs of a joint's bristles: their first bristles, one a lane, then their second ones; the last pair twice if they are fewer.
  template <typename Wide>
  struct Block {
    static constexpr int kPairs = Wide::kCount / 2;

    std::size_t joint;
    const ContactDerivative& contact;
    const ActingBristles& acting;
    int first;  ///< of the block's pairs among those of the joint
    int pair;   ///< the same among all

    [[nodiscard]] RPSUP_INLINE int bristle(int lane) const {
      const int i = 2 * (first + lane % kPairs);
      return acting.own[(i < acting.count ? i : acting.count - 2) + lane / kPairs];
    }
    /// A number of each bristle. @param number  (bristle) -> double
    template <typename Number>
    [[nodiscard]] RPSUP_INLINE Wide collect(const Number& number) const {
      Wide numbers;
      for (int lane = 0; lane < Wide::kCount; ++lane) numbers.set(lane, number(bristle(lane)));
      return numbers;
    }
    /// @param to  where those of the first bristles of all pairs go; those of the second ones stand a stride behind
    RPSUP_INLINE void store(const Wide& numbers, double* to, int stride) const { store_halves(numbers, to + pair, to + stride + pair); }
  };

  /// ContactRow of several bristles side by side.
  template <typename Wide>
  struct RateRows {
    [[nodiscard]] RPSUP_INLINE Wide apply(const JournalVariation<double>& varies) const {
      return dot3(0, varies.turn) + dot3(3, varies.p) + dot3(6, varies.v) + dot3(9, varies.w);
    }
    [[nodiscard]] RPSUP_INLINE Wide dot3(int first, const Vec3<double>& v) const {
      return by[first] * v.x + by[first + 1] * v.y + by[first + 2] * v.z;
    }
    Wide by[kJournal];
  };

  [[nodiscard]] static bool has_few(const ActingBristles& acting) { return acting.count <= kMostLoads; }
  [[nodiscard]] static int count_loads(const ActingBristles& acting) { return has_few(acting) ? acting.count : kMostLoads; }

  /// Calls f of blocks that hold all pairs, each joint's in their order.
  template <typename Function>
  RPSUP_INLINE void each_block(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting, const Function& f) const {
    int pair = 0;
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const ActingBristles& own = acting[joint];
      const int pairs = own.count / 2;
      int first = 0;
      for (; first + Block<Lanes>::kPairs <= pairs; first += Block<Lanes>::kPairs)
        f(Block<Lanes>{joint, *contacts[joint], own, first, pair + first});
      for (; first < pairs; first += Block<FourLanes>::kPairs)
        f(Block<FourLanes>{joint, *contacts[joint], own, first, pair + first});
      pair += pairs;
    }
  }

  template <typename Wide>
  [[nodiscard]] RPSUP_INLINE RateRows<Wide> find_rates(const Block<Wide>& block) const {
    RateRows<Wide> rates;
    for (int i = 0; i < 6; ++i) {
      rates.by[i] = block.collect([&](int b) RPSUP_INLINE_LAMBDA { return block.contact.rate_row(b).by_position[i]; });
      rates.by[i + 6] = block.collect([&](int b) RPSUP_INLINE_LAMBDA { return block.contact.rate_row(b).by_rate[i]; });
    }
    return rates;
  }

  /// How a journal varies in a direction.
  [[nodiscard]] RPSUP_INLINE JournalVariation<double> read_journal(std::size_t joint, int column) const {
    const double* numbers = &journals_[joint * kJournal * columns_ + static_cast<std::size_t>(column)];
    const auto vector = [&](std::size_t first) RPSUP_INLINE_LAMBDA {
      return Vec3<double>{numbers[first * columns_], numbers[(first + 1) * columns_], numbers[(first + 2) * columns_]};
    };
    return {vector(0), vector(3), vector(6), vector(9)};
  }

  template <typename Wide>
  RPSUP_INLINE void write_column(const RateRows<Wide>& rates, const Block<Wide>& block, int column, double* to, int stride) const {
    block.store(rates.apply(read_journal(block.joint, column)), to, stride);
  }

  template <typename Wide>
  RPSUP_INLINE void write_rates(const DirectionPlan& plan, const Block<Wide>& block, StateJacobian& J) const {
    const int stride = J.pair_stride;
    const RateRows<Wide> rates = find_rates(block);
    write_column(rates, block, DirectionPlan::kTime, J.rates_by_t.data(), stride);
    for (int a = 0; a < J.free; ++a) {
      write_column(rates, block, plan.column_of_q(a), J.matrices->rates_by_q.data() + 2 * a * stride, stride);
      write_column(rates, block, plan.column_of_v(a), J.matrices->rates_by_v.data() + 2 * a * stride, stride);
    }
    for (int k = 0; k < 2; ++k) {
      const auto by_one_of_pair = [&](int b) RPSUP_INLINE_LAMBDA { return block.contact.rate_by_bristle(b, (b & ~1) + k); };
      block.store(block.collect(by_one_of_pair), J.matrices->rates_by_own.data() + k * stride, 2 * stride);
    }
  }

  /// On accelerations and drive forces by the load, and on the rate of friction loss. The other losses do not depend on bristles.
  RPSUP_INLINE void write_effects(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting, StateJacobian& J) const {
    const int friction_row = J.first_work + J.works - 2;
    const double* effects = effects_.data();
    double* column = J.matrices->by_bristle.data();
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const ActingBristles& own = acting[joint];
      for (int i = 0; i < own.count; ++i, column += J.stride) {
        const double* load = contacts[joint]->load_by_bristle(own.own[i]);
        if (!has_few(own)) combine_effects(load, effects, J.stride, column);
        column[friction_row] = load[ContactRows::kFrictionPower];
      }
      effects += count_loads(own) * J.stride;
    }
  }

  /// column <- effects load
  RPSUP_INLINE static void combine_effects(const double* load, const double* effects, int stride, double* column) {
    for (int row = 0; row < stride; row += StateJacobian::kBlock) {
      LaneBlock<StateJacobian::kBlock> effect{};
      for (int i = 0; i < kMostLoads; ++i) effect += load[i] * LaneBlock<StateJacobian::kBlock>::load(effects + i * stride + row);
      effect.store(column + row);
    }
  }

  std::size_t joint_count_, columns_;
  Buffer<LoadDirection> loads_;
  int load_count_ = 0;
  Buffer<double> effects_;   ///< columns of outputs by unit loads
  Buffer<double> journals_;  ///< of each joint the twelve numbers, each a row of columns
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
