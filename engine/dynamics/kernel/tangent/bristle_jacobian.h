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

/// The blocks of StateJacobian by the bristles, and those of the bristles' rates. The bristles of a joint,
/// however many, act on the motion only by the six numbers of the joint's load, and the motion acts on them
/// only by the twelve numbers of the journal's motion: so the blocks are products of the derivatives by these
/// numbers (chain rule).
class BristleJacobian {
 public:
  static constexpr int kMaxLoads = 6;  ///< of a joint

  /// @param stride  of the columns of outputs
  BristleJacobian(const std::vector<ClearanceJoint>& joints, int motion_chunks, std::size_t stride)
      : joint_count_(joints.size()),
        columns_(motion_chunks * TangentPack::kCount),
        loads_(joint_count_ * kMaxLoads),
        load_columns_(joint_count_ * kMaxLoads * stride),
        journals_(joint_count_ * kJournal * columns_) {}

  /// Collects the seeds of each joint's load: the loads of its acting bristles, or six unit loads if the
  /// bristles are more than six.
  /// @param J  with its matrices: the columns of few bristles are those of J
  void collect_load_seeds(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting,
                          StateJacobian& J) {
    load_count_ = 0;
    double* by_bristle = J.matrices->by_bristle.data();
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const ActingBristles& of_joint = acting[joint];
      for (int i = 0; i < count_loads(of_joint); ++i, ++load_count_) {
        ContactLoadSeed& load = loads_[load_count_];
        load.joint = joint;
        load.load =
            has_few_bristles(of_joint) ? contacts[joint]->load_by_bristle(of_joint.index[i]) : kUnitLoads[i];
        load.column = has_few_bristles(of_joint) ? by_bristle + i * J.stride
                                                 : load_columns_.data() + load_count_ * J.stride;
      }
      by_bristle += of_joint.count * J.stride;
    }
  }
  [[nodiscard]] ContactLoadSeed* loads() { return loads_.data(); }
  [[nodiscard]] int load_count() const { return load_count_; }

  /// Stores the journals' tangents by a chunk of seeds.
  RPSUP_INLINE void store_journal_tangents(int chunk, const JournalTangent_b<TangentPack>* journals) {
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      std::size_t row = 0;
      const Vec3<TangentPack>* vectors[] = {&journals[joint].rotation, &journals[joint].offset,
                                            &journals[joint].v, &journals[joint].w};
      double* to =
          &journals_[joint * kJournal * columns_ + chunk * TangentPack::kCount];
      for (const Vec3<TangentPack>* vector : vectors)
        for (const TangentPack* number : {&vector->x, &vector->y, &vector->z})
          number->store(to + columns_ * row++);
    }
  }

  /// Writes the derivatives of the bristles' rates by time.
  void write_by_time(const std::unique_ptr<ContactDerivative>* contacts, const ActingBristles* acting,
                     StateJacobian& J) const {
    for_each_block(contacts, acting, [&](const auto& block) {
      write_column(collect_rate_rows(block), block, SeedSchedule::kTime, J.rates_by_t.data(), J.pair_stride);
    });
  }

  /// Writes all blocks, after the schedule's store() of every chunk.
  void write(const SeedSchedule& schedule, const std::unique_ptr<ContactDerivative>* contacts,
             const ActingBristles* acting, StateJacobian& J) const {
    for_each_block(contacts, acting, [&](const auto& block) { write_rates(schedule, block, J); });
    write_by_bristle(contacts, acting, J);
  }

 private:
  using FourLanes = LaneBlock<4>;
  static constexpr int kJournal = 12;
  static constexpr double kUnitLoads[kMaxLoads][kMaxLoads] = {{1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0},
                                                              {0, 0, 1, 0, 0, 0}, {0, 0, 0, 1, 0, 0},
                                                              {0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1}};

  /// A block of a joint's bristle pairs: their first bristles, one a lane, then their second ones. The last
  /// pair fills up the block.
  template <typename Pack>
  struct Block {
    static constexpr int kPairs = Pack::kCount / 2;

    std::size_t joint;
    const ContactDerivative& contact;
    const ActingBristles& acting;
    int first;  ///< of the block's pairs among those of the joint
    int pair;   ///< the same among all

    [[nodiscard]] RPSUP_INLINE int bristle(int lane) const {
      const int i = 2 * (first + lane % kPairs);
      return acting.index[(i < acting.count ? i : acting.count - 2) + lane / kPairs];
    }
    /// A number of each bristle. @param number  (bristle) -> double
    template <typename Number>
    [[nodiscard]] RPSUP_INLINE Pack collect(const Number& number) const {
      Pack numbers;
      for (int lane = 0; lane < Pack::kCount; ++lane) numbers.set(lane, number(bristle(lane)));
      return numbers;
    }
    /// @param to  row of the first bristles of all pairs; that of the second ones is a stride behind
    RPSUP_INLINE void store(const Pack& numbers, double* to, int stride) const {
      store_halves(numbers, to + pair, to + stride + pair);
    }
  };

  /// ContactRow of a block of bristles.
  template <typename Pack>
  struct RateRows {
    [[nodiscard]] RPSUP_INLINE Pack apply(const JournalTangent_b<double>& journal) const {
      return dot3(0, journal.rotation) + dot3(3, journal.offset) + dot3(6, journal.v) + dot3(9, journal.w);
    }
    [[nodiscard]] RPSUP_INLINE Pack dot3(int first, const Vec3<double>& v) const {
      return by[first] * v.x + by[first + 1] * v.y + by[first + 2] * v.z;
    }
    Pack by[kJournal];
  };

  [[nodiscard]] static bool has_few_bristles(const ActingBristles& acting) {
    return acting.count <= kMaxLoads;
  }
  [[nodiscard]] static int count_loads(const ActingBristles& acting) {
    return has_few_bristles(acting) ? acting.count : kMaxLoads;
  }

  /// Calls f with blocks of all pairs, joint by joint.
  template <typename Function>
  RPSUP_INLINE void for_each_block(const std::unique_ptr<ContactDerivative>* contacts,
                                   const ActingBristles* acting, const Function& f) const {
    int pair = 0;
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const ActingBristles& of_joint = acting[joint];
      const int pairs = of_joint.count / 2;
      int first = 0;
      for (; first + Block<Lanes>::kPairs <= pairs; first += Block<Lanes>::kPairs)
        f(Block<Lanes>{joint, *contacts[joint], of_joint, first, pair + first});
      for (; first < pairs; first += Block<FourLanes>::kPairs)
        f(Block<FourLanes>{joint, *contacts[joint], of_joint, first, pair + first});
      pair += pairs;
    }
  }

  template <typename Pack>
  [[nodiscard]] RPSUP_INLINE RateRows<Pack> collect_rate_rows(const Block<Pack>& block) const {
    RateRows<Pack> rows;
    for (int i = 0; i < 6; ++i) {
      rows.by[i] =
          block.collect([&](int b) RPSUP_INLINE_LAMBDA { return block.contact.rate_row(b).by_position[i]; });
      rows.by[i + 6] =
          block.collect([&](int b) RPSUP_INLINE_LAMBDA { return block.contact.rate_row(b).by_rate[i]; });
    }
    return rows;
  }

  /// Tangent of a journal by one seed.
  [[nodiscard]] RPSUP_INLINE JournalTangent_b<double> journal_tangent(std::size_t joint, int column) const {
    const double* numbers = &journals_[joint * kJournal * columns_ + column];
    const auto vector = [&](std::size_t first) RPSUP_INLINE_LAMBDA {
      return Vec3<double>{numbers[first * columns_], numbers[(first + 1) * columns_],
                          numbers[(first + 2) * columns_]};
    };
    return {vector(0), vector(3), vector(6), vector(9)};
  }

  template <typename Pack>
  RPSUP_INLINE void write_column(const RateRows<Pack>& rows, const Block<Pack>& block, int column, double* to,
                                 int stride) const {
    block.store(rows.apply(journal_tangent(block.joint, column)), to, stride);
  }

  template <typename Pack>
  RPSUP_INLINE void write_rates(const SeedSchedule& schedule, const Block<Pack>& block,
                                StateJacobian& J) const {
    const int stride = J.pair_stride;
    const RateRows<Pack> rows = collect_rate_rows(block);
    write_column(rows, block, SeedSchedule::kTime, J.rates_by_t.data(), stride);
    for (int a = 0; a < J.free; ++a) {
      write_column(rows, block, schedule.column_of_q(a), J.matrices->rates_by_q.data() + 2 * a * stride,
                   stride);
      write_column(rows, block, schedule.column_of_v(a), J.matrices->rates_by_v.data() + 2 * a * stride,
                   stride);
    }
    for (int k = 0; k < 2; ++k) {
      const auto by_one_of_pair = [&](int b) RPSUP_INLINE_LAMBDA {
        return block.contact.rate_by_bristle(b, (b & ~1) + k);
      };
      block.store(block.collect(by_one_of_pair), J.matrices->rates_by_bristle.data() + k * stride,
                  2 * stride);
    }
  }

  /// Writes the columns by bristles: outputs by the load, times the load by the bristle, and the power of
  /// friction. Other losses do not depend on bristles.
  RPSUP_INLINE void write_by_bristle(const std::unique_ptr<ContactDerivative>* contacts,
                                     const ActingBristles* acting, StateJacobian& J) const {
    const int friction_row = J.first_work + J.layout.friction_in_works();
    const double* load_columns = load_columns_.data();
    double* column = J.matrices->by_bristle.data();
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const ActingBristles& of_joint = acting[joint];
      for (int i = 0; i < of_joint.count; ++i, column += J.stride) {
        const double* load = contacts[joint]->load_by_bristle(of_joint.index[i]);
        if (!has_few_bristles(of_joint)) combine_load_columns(load, load_columns, J.stride, column);
        column[friction_row] = load[ContactRows::kFrictionPower];
      }
      load_columns += count_loads(of_joint) * J.stride;
    }
  }

  /// column <- load_columns load
  RPSUP_INLINE static void combine_load_columns(const double* load, const double* load_columns, int stride,
                                                double* column) {
    for (int row = 0; row < stride; row += StateJacobian::kBlock) {
      LaneBlock<StateJacobian::kBlock> sum{};
      for (int i = 0; i < kMaxLoads; ++i)
        sum += load[i] * LaneBlock<StateJacobian::kBlock>::load(load_columns + i * stride + row);
      sum.store(column + row);
    }
  }

  std::size_t joint_count_, columns_;
  Buffer<ContactLoadSeed> loads_;
  int load_count_ = 0;
  Buffer<double> load_columns_;   ///< columns by unit loads
  Buffer<double> journals_;  ///< of each joint twelve rows, one entry a seed
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
