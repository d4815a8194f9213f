// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/dynamics/kernel/tangent/linearised_dynamics.h"
#include "engine/dynamics/kernel/tangent/state_jacobian.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Which directions are taken together, as a group: time and the coordinates and rates of one or a few joints, so that in most groups most of the
/// mechanism stands still; in the last ones loads on journals. And where what comes of each of them goes.
class DirectionPlan {
 public:
  /// @param most_loads  of any start()
  /// @param stride      of the columns that outputs go to
  DirectionPlan(const TreeModel& model, std::size_t most_loads, std::size_t stride)
      : model_(model),
        n_(static_cast<std::size_t>(model.coordinates)),
        column_of_q_(model.free.size()),
        column_of_v_(model.free.size()),
        first_load_column_(place_columns(model, column_of_q_, column_of_v_)),
        moving_groups_(group_of(first_load_column_ - 1) + 1),
        coordinates_((static_cast<std::size_t>(moving_groups_) + 1) * n_),
        columns_((static_cast<std::size_t>(moving_groups_) + 1) * Directions::kCount + most_loads),
        outputs_(stride),
        nowhere_(stride) {
    for (std::size_t free = 0; free < model.free.size(); ++free) {
      const int q = column_of_q_[free], v = column_of_v_[free];
      variation(q, model.free[free]).q = Directions::unit(q % Directions::kCount);
      variation(v, model.free[free]).qd = Directions::unit(v % Directions::kCount);
    }
  }

  /// Sets the drives' variation in time and the loads, and where all goes: without matrices nowhere but by_t.
  /// @param loads  each of its own direction: their lanes are set here, where they stay
  void start(const DrivenMotion* drives, LoadDirection* loads, int count, StateJacobian& J) {
    direct(loads, count, J);
    loads_ = loads;
    load_count_ = count;
    groups_ = group_of(first_load_column_ + count - 1) + 1;
    for (int i = 0; i < count; ++i) loads[i].lanes = Directions::unit((first_load_column_ + i) % Directions::kCount);
    if (model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      CoordinateVariation<Directions>& driven = variation(0, model_.drives[k]);
      driven.q = drives[k].qd * Directions::unit(0);
      driven.qd = drives[k].qdd * Directions::unit(0);
      driven.qdd = drives[k].qddd * Directions::unit(0);
    }
  }

  [[nodiscard]] int groups() const { return groups_; }
  /// Those of the groups behind the last moving one stand still.
  [[nodiscard]] const CoordinateVariation<Directions>* coordinates(int group) const {
    return coordinates_.data() + static_cast<std::size_t>(group < moving_groups_ ? group : moving_groups_) * n_;
  }
  [[nodiscard]] Directions time(int group) const { return group == 0 ? Directions::unit(0) : Directions{}; }
  /// Loads of a group.
  [[nodiscard]] int first_load(int group) const { return clamp(group * Directions::kCount - first_load_column_); }
  [[nodiscard]] int end_load(int group) const { return clamp((group + 1) * Directions::kCount - first_load_column_); }
  [[nodiscard]] const LoadDirection* loads() const { return loads_; }

  // Columns: one a direction
  static constexpr int kTime = 0;
  [[nodiscard]] int column_of_q(int free) const { return column_of_q_[static_cast<std::size_t>(free)]; }
  [[nodiscard]] int column_of_v(int free) const { return column_of_v_[static_cast<std::size_t>(free)]; }
  [[nodiscard]] int column_of_load(int load) const { return first_load_column_ + load; }
  [[nodiscard]] int moving_groups() const { return moving_groups_; }

  /// An output in a group's directions, for store().
  [[nodiscard]] RPSUP_INLINE Directions& output(int row) { return outputs_[static_cast<std::size_t>(row)]; }
  /// Puts the outputs of a group's directions into their columns.
  RPSUP_INLINE void store(int group) {
    double* const* columns = columns_.data() + group * Directions::kCount;
    for (std::size_t row = 0; row < outputs_.size(); row += 2) {
      const Directions even = outputs_[row], odd = outputs_[row + 1];
      store_columns(even, odd, columns, row, std::make_integer_sequence<int, Directions::kCount>());
    }
  }

 private:
  /// Sets where each column goes.
  void direct(const LoadDirection* loads, int count, StateJacobian& J) {
    columns_.fill(nowhere_.data());
    const auto set = [&](int column, double* to) { columns_[static_cast<std::size_t>(column)] = to; };
    set(kTime, J.by_t.data());
    if (!J.matrices) return;
    for (int a = 0; a < J.free; ++a) {
      set(column_of_q(a), J.matrices->by_q.data() + a * J.stride);
      set(column_of_v(a), J.matrices->by_v.data() + a * J.stride);
    }
    for (int i = 0; i < count; ++i) set(column_of_load(i), loads[i].effect);
  }

  template <int... lane>
  RPSUP_INLINE static void store_columns(const Directions& even, const Directions& odd, double* const* columns, std::size_t row,
                                         std::integer_sequence<int, lane...>) {
    constexpr int kWidth = Directions::kWidth;
    const auto put = [&]<int l>(std::integral_constant<int, l>) RPSUP_INLINE_LAMBDA {
      LanePair pair;
      pair.part[0] = __builtin_shufflevector(even.part[l / kWidth], odd.part[l / kWidth], l % kWidth, kWidth + l % kWidth);
      pair.store(columns[l] + row);
    };
    (put(std::integral_constant<int, lane>()), ...);
  }

  /// A joint's coordinates share a group, and so do its rates: the first one with room for them. Those that no group holds take several.
  /// @returns the column behind the last
  [[nodiscard]] static int place_columns(const TreeModel& model, Buffer<int>& column_of_q, Buffer<int>& column_of_v) {
    constexpr int kCount = Directions::kCount;
    Buffer<int> taken(2 * model.free.size() + 1);  // columns of each group
    taken[0] = 1;
    std::size_t last = 0, free = 0;
    const auto place = [&](int count, Buffer<int>& columns, std::size_t first) {
      for (int placed = 0; placed < count; placed += kCount) {
        const int part = std::min(count - placed, kCount);
        std::size_t group = 0;
        while (taken[group] + part > kCount) ++group;
        last = std::max(group, last);
        for (int k = 0; k < part; ++k) columns[first++] = static_cast<int>(group) * kCount + taken[group]++;
      }
    };
    for (const TreeJoint& joint : model.joints) {
      if (joint.driven) continue;
      place(joint.count(), column_of_q, free);
      place(joint.count(), column_of_v, free);
      free += static_cast<std::size_t>(joint.count());
    }
    return static_cast<int>(last) * kCount + taken[last];
  }
  [[nodiscard]] static int group_of(int column) { return static_cast<int>(static_cast<unsigned>(column) / Directions::kCount); }
  [[nodiscard]] int clamp(int load) const { return load < 0 ? 0 : load > load_count_ ? load_count_ : load; }
  CoordinateVariation<Directions>& variation(int column, int coordinate) {
    CoordinateVariation<Directions>& entry = coordinates_[static_cast<std::size_t>(group_of(column)) * n_ + static_cast<std::size_t>(coordinate)];
    entry.varies = true;
    return entry;
  }

  const TreeModel& model_;
  std::size_t n_;                          ///< coordinates
  Buffer<int> column_of_q_, column_of_v_;  ///< of each free coordinate, and of its rate
  int first_load_column_, moving_groups_;
  int load_count_ = 0, groups_ = 0;
  const LoadDirection* loads_ = nullptr;
  Buffer<CoordinateVariation<Directions>> coordinates_;  ///< group after group, one a coordinate; those left over stand still
  Buffer<double*> columns_;                ///< where the outputs of each direction go
  Buffer<Directions> outputs_;             ///< of one group, as StateJacobian has a column
  Buffer<double> nowhere_;                 ///< a column that is not wanted
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
