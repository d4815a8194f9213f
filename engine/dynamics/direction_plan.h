#pragma once

#include <memory>

#include "engine/dynamics/equations.h"
#include "engine/dynamics/varied_equations.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/dual.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Which directions are taken together: time, then joint by joint its coordinates and their rates, so that in most groups most of the
/// mechanism stands still, then loads on journals.
class DirectionPlan {
 public:
  /// @param most_loads  of any start()
  DirectionPlan(const TreeModel& model, std::size_t most_loads)
      : model_(model),
        n_(static_cast<std::size_t>(model.coordinates)),
        column_of_q_(model.free.size()),
        first_load_column_(place_columns(model, column_of_q_)),
        moving_groups_(group_of(first_load_column_ - 1) + 1),
        coordinates_((static_cast<std::size_t>(moving_groups_) + 1) * n_) {
    for (std::size_t free = 0; free < model.free.size(); ++free) {
      const int column = column_of_q_[free];
      variation(column, model.free[free]).q = Lanes::unit(column % Lanes::kCount);
      variation(column + 1, model.free[free]).qd = Lanes::unit((column + 1) % Lanes::kCount);
    }
    const auto most_groups = static_cast<std::size_t>(moving_groups_) + (most_loads + Lanes::kCount - 1) / Lanes::kCount;
    outputs_ = std::make_unique<Buffer<Lanes>>(most_groups * (model.free.size() + model.drives.size() + 3));
  }

  /// Sets the drives' variation in time and the loads.
  /// @param loads  each of its own direction: their lanes are set here, where they stay
  void start(const DrivenMotion* drives, LoadDirection* loads, int count) {
    loads_ = loads;
    load_count_ = count;
    groups_ = group_of(first_load_column_ + count - 1) + 1;
    for (int i = 0; i < count; ++i) loads[i].lanes = Lanes::unit((first_load_column_ + i) % Lanes::kCount);
    if (model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      CoordinateVariation<Lanes>& driven = variation(0, model_.drives[k]);
      driven.q = drives[k].qd * Lanes::unit(0);
      driven.qd = drives[k].qdd * Lanes::unit(0);
      driven.qdd = drives[k].qddd * Lanes::unit(0);
    }
  }

  [[nodiscard]] int groups() const { return groups_; }
  /// Those of the groups behind the last moving one stand still.
  [[nodiscard]] const CoordinateVariation<Lanes>* coordinates(int group) const {
    return coordinates_.data() + static_cast<std::size_t>(group < moving_groups_ ? group : moving_groups_) * n_;
  }
  [[nodiscard]] Lanes time(int group) const { return group == 0 ? Lanes::unit(0) : Lanes{}; }
  /// Loads of a group.
  [[nodiscard]] int first_load(int group) const { return clamp(group * Lanes::kCount - first_load_column_); }
  [[nodiscard]] int end_load(int group) const { return clamp((group + 1) * Lanes::kCount - first_load_column_); }
  [[nodiscard]] const LoadDirection* loads() const { return loads_; }

  // Columns: one a direction, eight a group
  static constexpr int kTime = 0;
  [[nodiscard]] int column_of_q(int free) const { return column_of_q_[static_cast<std::size_t>(free)]; }
  [[nodiscard]] int column_of_v(int free) const { return column_of_q(free) + 1; }
  [[nodiscard]] int column_of_load(int load) const { return first_load_column_ + load; }
  [[nodiscard]] int moving_groups() const { return moving_groups_; }

  /// Where an output of a group goes.
  [[nodiscard]] RPSUP_INLINE Lanes& output(int row, int group) { return (*outputs_)[static_cast<std::size_t>(row * groups_ + group)]; }
  [[nodiscard]] RPSUP_INLINE double output_of_column(int row, int column) const {
    return read_number(outputs_->data() + row * groups_, column);
  }

  /// Writes the outputs by time.
  void sort_time(Linearisation& result) const {
    for (int row = 0; row < result.outputs; ++row) result.by_t[row] = output_of_column(row, kTime);
  }

  /// Writes the outputs by coordinates, their rates and time.
  void sort(Linearisation& result) const {
    sort_time(result);
    const auto n = static_cast<int>(model_.free.size());
    for (int row = 0; row < result.outputs; ++row)
      for (int a = 0; a < n; ++a) {
        result.by_q[row * n + a] = output_of_column(row, column_of_q(a));
        result.by_v[row * n + a] = output_of_column(row, column_of_v(a));
      }
  }

 private:
  /// Coordinates and rates of a joint share a group. @returns the column behind the last
  [[nodiscard]] static int place_columns(const TreeModel& model, Buffer<int>& column_of_q) {
    int column = 1;
    std::size_t free = 0;
    for (const TreeJoint& joint : model.joints) {
      if (joint.driven) continue;
      const int count = joint.count();
      if (column % Lanes::kCount + 2 * count > Lanes::kCount) column = group_of(column + Lanes::kCount - 1) * Lanes::kCount;
      for (int k = 0; k < count; ++k, column += 2) column_of_q[free++] = column;
    }
    return column;
  }
  [[nodiscard]] static int group_of(int column) { return static_cast<int>(static_cast<unsigned>(column) / Lanes::kCount); }
  [[nodiscard]] int clamp(int load) const { return load < 0 ? 0 : load > load_count_ ? load_count_ : load; }
  CoordinateVariation<Lanes>& variation(int column, int coordinate) {
    CoordinateVariation<Lanes>& entry = coordinates_[static_cast<std::size_t>(group_of(column)) * n_ + static_cast<std::size_t>(coordinate)];
    entry.varies = true;
    return entry;
  }

  const TreeModel& model_;
  std::size_t n_;                            ///< coordinates
  Buffer<int> column_of_q_;                  ///< of each free coordinate; its rate follows
  int first_load_column_, moving_groups_;
  int load_count_ = 0, groups_ = 0;
  const LoadDirection* loads_ = nullptr;
  Buffer<CoordinateVariation<Lanes>> coordinates_;  ///< group after group, one a coordinate; those left over stand still
  std::unique_ptr<Buffer<Lanes>> outputs_;   ///< row after row, one a group
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
