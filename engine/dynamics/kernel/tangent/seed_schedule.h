// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/dynamics/kernel/tangent/contact_tangent.h"
#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/dynamics/kernel/tangent/state_jacobian.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The seeds of forward-mode differentiation, packed into chunks of as many as a TangentPack has lanes (chunk
/// mode, as in ForwardDiff.jl), and the column of the Jacobian that each fills. A seed is time, a free
/// coordinate, its rate, or a load on a journal. The coordinates of a joint share a chunk, and so do their
/// rates: in most chunks most of the mechanism does not move, and is left out.
class SeedSchedule {
 public:
  /// @param max_loads  upper bound of the loads of start()
  /// @param stride     length of a column
  SeedSchedule(const TreeModel& model, std::size_t max_loads, std::size_t stride)
      : model_(model),
        n_(model.coordinates),
        column_of_q_(model.free.size()),
        column_of_v_(model.free.size()),
        first_load_column_(assign_columns(model, column_of_q_, column_of_v_)),
        motion_chunks_(chunk_of(first_load_column_ - 1) + 1),
        coordinate_seeds_((motion_chunks_ + 1) * n_),
        columns_((motion_chunks_ + 1) * TangentPack::kCount + max_loads),
        outputs_(stride),
        discarded_(stride) {
    for (std::size_t free = 0; free < model.free.size(); ++free) {
      const int q = column_of_q_[free], v = column_of_v_[free];
      seed_of(q, model.free[free]).q = TangentPack::unit(q % TangentPack::kCount);
      seed_of(v, model.free[free]).qd = TangentPack::unit(v % TangentPack::kCount);
    }
  }

  /// Sets the seeds of the drives' motion in time and of the loads, and the column of each seed. Without
  /// J.matrices all but by_t is discarded.
  /// @param loads  their seeds are set; they must stay where they are
  void start(const DrivenMotion* drives, ContactLoadSeed* loads, int count, StateJacobian& J) {
    set_destinations(loads, count, J);
    loads_ = loads;
    load_count_ = count;
    chunks_ = chunk_of(first_load_column_ + count - 1) + 1;
    for (int i = 0; i < count; ++i)
      loads[i].seed = TangentPack::unit((first_load_column_ + i) % TangentPack::kCount);
    if (model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      CoordinateTangent<TangentPack>& drive_seed = seed_of(0, model_.drives[k]);
      drive_seed.q = drives[k].qd * TangentPack::unit(0);
      drive_seed.qd = drives[k].qdd * TangentPack::unit(0);
      drive_seed.qdd = drives[k].qddd * TangentPack::unit(0);
    }
  }

  [[nodiscard]] int chunks() const { return chunks_; }
  /// The coordinates' seeds in a chunk. Chunks behind the last motion chunk have loads only.
  [[nodiscard]] const CoordinateTangent<TangentPack>* coordinate_seeds(int chunk) const {
    return coordinate_seeds_.data() +
           static_cast<std::size_t>(chunk < motion_chunks_ ? chunk : motion_chunks_) * n_;
  }
  [[nodiscard]] TangentPack time(int chunk) const {
    return chunk == 0 ? TangentPack::unit(0) : TangentPack{};
  }
  /// Range of the loads of a chunk.
  [[nodiscard]] int first_load(int chunk) const {
    return clamp(chunk * TangentPack::kCount - first_load_column_);
  }
  [[nodiscard]] int end_load(int chunk) const {
    return clamp((chunk + 1) * TangentPack::kCount - first_load_column_);
  }
  [[nodiscard]] const ContactLoadSeed* loads() const { return loads_; }

  // Columns: one a seed
  static constexpr int kTime = 0;
  [[nodiscard]] int column_of_q(int free) const { return column_of_q_[free]; }
  [[nodiscard]] int column_of_v(int free) const { return column_of_v_[free]; }
  [[nodiscard]] int column_of_load(int load) const { return first_load_column_ + load; }
  [[nodiscard]] int motion_chunks() const { return motion_chunks_; }

  /// A row of outputs of a chunk, for store().
  [[nodiscard]] RPSUP_INLINE TangentPack& output(int row) { return outputs_[row]; }
  /// Writes the outputs of a chunk into the columns of its seeds.
  RPSUP_INLINE void store(int chunk) {
    double* const* columns = columns_.data() + chunk * TangentPack::kCount;
    for (std::size_t row = 0; row < outputs_.size(); row += 2) {
      const TangentPack even = outputs_[row], odd = outputs_[row + 1];
      store_columns(even, odd, columns, row, std::make_integer_sequence<int, TangentPack::kCount>());
    }
  }

 private:
  /// Sets where the column of each seed is.
  void set_destinations(const ContactLoadSeed* loads, int count, StateJacobian& J) {
    columns_.fill(discarded_.data());
    const auto set = [&](int column, double* to) { columns_[column] = to; };
    set(kTime, J.by_t.data());
    if (!J.matrices) return;
    for (int a = 0; a < J.free; ++a) {
      set(column_of_q(a), J.matrices->by_q.data() + a * J.stride);
      set(column_of_v(a), J.matrices->by_v.data() + a * J.stride);
    }
    for (int i = 0; i < count; ++i) set(column_of_load(i), loads[i].column);
  }

  template <int... lane>
  RPSUP_INLINE static void store_columns(const TangentPack& even, const TangentPack& odd,
                                         double* const* columns, std::size_t row,
                                         std::integer_sequence<int, lane...>) {
    constexpr int kWidth = TangentPack::kWidth;
    const auto put = [&]<int l>(std::integral_constant<int, l>) RPSUP_INLINE_LAMBDA {
      LanePair pair;
      pair.part[0] = __builtin_shufflevector(even.part[l / kWidth], odd.part[l / kWidth], l % kWidth,
                                             kWidth + l % kWidth);
      pair.store(columns[l] + row);
    };
    (put(std::integral_constant<int, lane>()), ...);
  }

  /// Assigns the coordinates of a joint, then its rates, to the first chunk with as many lanes left; to
  /// several if they are more than a chunk has.
  /// @returns the number of columns
  [[nodiscard]] static int assign_columns(const TreeModel& model, Buffer<int>& column_of_q,
                                          Buffer<int>& column_of_v) {
    constexpr int kCount = TangentPack::kCount;
    Buffer<int> taken(2 * model.free.size() + 1);  // columns of each chunk
    taken[0] = 1;
    std::size_t last = 0, free = 0;
    const auto add_joint = [&](int count, Buffer<int>& columns, std::size_t first) {
      for (int placed = 0; placed < count; placed += kCount) {
        const int part = std::min(count - placed, kCount);
        std::size_t chunk = 0;
        while (taken[chunk] + part > kCount) ++chunk;
        last = std::max(chunk, last);
        for (int k = 0; k < part; ++k) columns[first++] = static_cast<int>(chunk) * kCount + taken[chunk]++;
      }
    };
    for (const TreeJoint& joint : model.joints) {
      if (joint.driven) continue;
      add_joint(joint.count(), column_of_q, free);
      add_joint(joint.count(), column_of_v, free);
      free += joint.count();
    }
    return static_cast<int>(last) * kCount + taken[last];
  }
  [[nodiscard]] static int chunk_of(int column) {
    return static_cast<int>(static_cast<unsigned>(column) / TangentPack::kCount);
  }
  [[nodiscard]] int clamp(int load) const { return load < 0 ? 0 : load > load_count_ ? load_count_ : load; }
  CoordinateTangent<TangentPack>& seed_of(int column, int coordinate) {
    CoordinateTangent<TangentPack>& entry =
        coordinate_seeds_[chunk_of(column) * n_ +
                          static_cast<std::size_t>(coordinate)];
    entry.active = true;
    return entry;
  }

  const TreeModel& model_;
  std::size_t n_;                          ///< coordinates
  Buffer<int> column_of_q_, column_of_v_;  ///< of each free coordinate, and of its rate
  int first_load_column_, motion_chunks_;
  int load_count_ = 0, chunks_ = 0;
  const ContactLoadSeed* loads_ = nullptr;
  /// chunk by chunk, one a coordinate; the last chunk: none active
  Buffer<CoordinateTangent<TangentPack>> coordinate_seeds_;
  Buffer<double*> columns_;                ///< of each seed
  Buffer<TangentPack> outputs_;             ///< of one chunk, row by row
  Buffer<double> discarded_;                 ///< a column for seeds whose outputs are not wanted
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
