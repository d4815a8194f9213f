#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/clearance/contact_derivative.h"
#include "engine/dynamics/direction_plan.h"
#include "engine/dynamics/equations.h"
#include "engine/dynamics/varied_equations.h"
#include "engine/math/buffer.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The derivatives by the bristles, and those of their rates. However many bristles a joint has, they act on the motion by the six numbers of its
/// load alone, and the motion acts on them by the twelve of its journal: what each of these does is found once.
class BristleDerivatives {
 public:
  static constexpr int kMostLoads = 6;  ///< of a joint

  BristleDerivatives(const std::vector<ClearanceJoint>& joints, int moving_groups)
      : joint_count_(joints.size()),
        columns_(static_cast<std::size_t>(moving_groups) * Lanes::kCount),
        loads_(joint_count_ * kMostLoads),
        journals_(joint_count_ * kJournal * columns_) {}

  /// Of a joint's bristles the loads, or, of more than six, the six of which all loads consist.
  void find_loads(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting) {
    load_count_ = 0;
    for (std::size_t joint = 0; joint < joint_count_; ++joint)
      for (int i = 0; i < count_loads(acting[joint]); ++i)
        loads_[static_cast<std::size_t>(load_count_++)] = {
            joint, has_few(acting[joint]) ? contacts[joint]->load_by_bristle(acting[joint].own[i]) : kUnitLoads[i], {}};
  }
  [[nodiscard]] LoadDirection* loads() { return loads_.data(); }
  [[nodiscard]] int load_count() const { return load_count_; }

  /// Takes note of how the journals vary in a group's directions.
  RPSUP_INLINE void take_journals(int group, const JournalVariation<Lanes>* journals) {
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      std::size_t row = 0;
      const Vec3<Lanes>* vectors[] = {&journals[joint].turn, &journals[joint].p, &journals[joint].v, &journals[joint].w};
      double* to = &journals_[joint * kJournal * columns_ + static_cast<std::size_t>(group) * Lanes::kCount];
      for (const Vec3<Lanes>* vector : vectors)
        for (const Lanes* number : {&vector->x, &vector->y, &vector->z}) number->store(to + columns_ * row++);
    }
  }

  /// Writes the rates' derivatives by time.
  void write_by_time(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting, Linearisation& result) const {
    each_block(contacts, acting, [&](const auto& block) {
      write_column(find_rates(block), block, DirectionPlan::kTime, result.rates_by_t, result.stride);
    });
  }

  /// Writes all. @param plan  with the outputs of every direction
  void write(const DirectionPlan& plan, const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting, int free, int drives,
             Linearisation& result) const {
    each_block(contacts, acting, [&](const auto& block) {
      write_rates(plan, block, free, result);
      write_effects(plan, block, free + drives, result);
    });
    // What stands behind the last pair is read with it if their number is odd, and must do nothing.
    const auto clear = [&](double* rows, int count) {
      for (int row = 0; row < count; ++row) rows[row * result.stride + result.pairs] = 0.0;
    };
    clear(result.by_bristle, 2 * result.outputs);
    clear(result.rates_by_own, 4);
    clear(result.rates_by_q, 2 * free);
    clear(result.rates_by_v, 2 * free);
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
    int first_load;  ///< of the joint's
    int first;       ///< of the block's pairs among those of the joint
    int pair;        ///< the same among all

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
    int first_load = 0;
    int pair = 0;
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const ActingBristles& own = acting[joint];
      const int pairs = own.count / 2;
      int first = 0;
      for (; first + Block<Lanes>::kPairs <= pairs; first += Block<Lanes>::kPairs)
        f(Block<Lanes>{joint, *contacts[joint], own, first_load, first, pair + first});
      for (; first < pairs; first += Block<FourLanes>::kPairs)
        f(Block<FourLanes>{joint, *contacts[joint], own, first_load, first, pair + first});
      first_load += count_loads(own);
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
  RPSUP_INLINE void write_rates(const DirectionPlan& plan, const Block<Wide>& block, int free, Linearisation& result) const {
    const int stride = result.stride;
    const RateRows<Wide> rates = find_rates(block);
    write_column(rates, block, DirectionPlan::kTime, result.rates_by_t, stride);
    for (int a = 0; a < free; ++a) {
      write_column(rates, block, plan.column_of_q(a), result.rates_by_q + 2 * a * stride, stride);
      write_column(rates, block, plan.column_of_v(a), result.rates_by_v + 2 * a * stride, stride);
    }
    for (int k = 0; k < 2; ++k) {
      const auto by_one_of_pair = [&](int b) RPSUP_INLINE_LAMBDA { return block.contact.rate_by_bristle(b, (b & ~1) + k); };
      block.store(block.collect(by_one_of_pair), result.rates_by_own + k * stride, 2 * stride);
    }
  }

  /// On accelerations and drive forces by the load, and on the rate of friction loss. Those of the other losses do not depend on bristles: their
  /// rows stay zero, as their owner gave them.
  template <typename Wide>
  RPSUP_INLINE void write_effects(const DirectionPlan& plan, const Block<Wide>& block, int rows_by_load, Linearisation& result) const {
    const int stride = result.stride;
    const int friction_row = rows_by_load + 1;
    const auto by_bristle = [&](int number) RPSUP_INLINE_LAMBDA {
      return block.collect([&](int b) RPSUP_INLINE_LAMBDA { return block.contact.load_by_bristle(b)[number]; });
    };
    block.store(by_bristle(ContactRows::kFrictionPower), result.by_bristle + 2 * friction_row * stride, stride);
    if (has_few(block.acting)) {
      const int pairs = block.acting.count / 2 - block.first < Block<Wide>::kPairs ? block.acting.count / 2 - block.first : Block<Wide>::kPairs;
      for (int row = 0; row < rows_by_load; ++row)
        for (int i = 0; i < 2 * pairs; ++i)
          result.by_bristle[(2 * row + i % 2) * stride + block.pair + i / 2] =
              plan.output_of_column(row, plan.column_of_load(block.first_load + 2 * block.first + i));
      return;
    }
    Wide load[kMostLoads];
    for (int i = 0; i < kMostLoads; ++i) load[i] = by_bristle(i);
    for (int row = 0; row < rows_by_load; ++row) {
      Wide effect{};
      for (int i = 0; i < kMostLoads; ++i) effect += plan.output_of_column(row, plan.column_of_load(block.first_load + i)) * load[i];
      block.store(effect, result.by_bristle + 2 * row * stride, stride);
    }
  }

  std::size_t joint_count_, columns_;
  Buffer<LoadDirection> loads_;
  int load_count_ = 0;
  Buffer<double> journals_;  ///< of each joint the twelve numbers, each a row of columns
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
