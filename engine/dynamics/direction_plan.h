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
/// mechanism stands still, then the bristles.
class DirectionPlan {
 public:
  DirectionPlan(const TreeModel& model, std::size_t bristles)
      : model_(model),
        n_(static_cast<std::size_t>(model.coordinates)),
        column_of_q_(model.free.size()),
        bristles_(bristles),
        coordinates_((model.free.size() + 2) * n_) {
    int column = 1;
    int free = 0;
    for (const TreeJoint& joint : model.joints) {
      if (joint.driven) continue;
      const int count = joint.count();
      if (column % Lanes::kCount + 2 * count > Lanes::kCount) column = group_of(column + Lanes::kCount - 1) * Lanes::kCount;
      for (int k = 0; k < count; ++k, ++free, column += 2) {
        column_of_q_[static_cast<std::size_t>(free)] = column;
        variation(column, joint.first + k).q = Lanes::unit(column % Lanes::kCount);
        variation(column + 1, joint.first + k).qd = Lanes::unit((column + 1) % Lanes::kCount);
      }
    }
    first_bristle_column_ = column;
    moving_groups_ = group_of(column - 1) + 1;
  }

  /// Sets the drives' variation in time and the bristles that vary.
  void start(const DrivenMotion* drives, const int* bristles, int count) {
    bristle_count_ = count;
    groups_ = group_of(first_bristle_column_ + count - 1) + 1;
    make_room();
    for (int b = 0; b < count; ++b)
      bristles_[static_cast<std::size_t>(b)] = {bristles[b], Lanes::unit((first_bristle_column_ + b) % Lanes::kCount)};
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
  /// Bristles of a group, by their place among those that vary.
  [[nodiscard]] int first_bristle(int group) const { return clamp(group * Lanes::kCount - first_bristle_column_); }
  [[nodiscard]] int end_bristle(int group) const { return clamp((group + 1) * Lanes::kCount - first_bristle_column_); }
  [[nodiscard]] const BristleVariation* bristles() const { return bristles_.data(); }

  /// Where an output of a group goes.
  [[nodiscard]] RPSUP_INLINE Lanes& output(int row, int group) { return (*outputs_)[static_cast<std::size_t>(row * groups_ + group)]; }

  /// Writes the outputs by time.
  void sort_time(Linearisation& result) const {
    for (int row = 0; row < result.outputs; ++row) result.by_t[row] = entry(outputs_->data() + row * groups_, 0);
  }

  /// Writes all outputs by variables.
  void sort(Linearisation& result) const {
    sort_time(result);
    const auto n = static_cast<int>(model_.free.size());
    const int bristle_stride = static_cast<int>(bristles_.size());
    for (int row = 0; row < result.outputs; ++row) {
      const Lanes* from = outputs_->data() + row * groups_;
      double* by_q = result.by_q + row * n;
      double* by_v = result.by_v + row * n;
      for (int a = 0; a < n; ++a) {
        const int column = column_of_q_[static_cast<std::size_t>(a)];
        by_q[a] = entry(from, column);
        by_v[a] = entry(from, column + 1);
      }
      for (int b = 0; b < bristle_count_; ++b) result.by_bristle[row * bristle_stride + b] = entry(from, first_bristle_column_ + b);
    }
  }

 private:
  /// For all that any bristles may ask for, once there are any.
  void make_room() {
    const std::size_t bristles = bristle_count_ > 0 ? bristles_.size() : 0;
    const std::size_t rows = model_.free.size() + bristles_.size() + model_.drives.size() + 3;
    const std::size_t room = (static_cast<std::size_t>(moving_groups_) + 1 + bristles / Lanes::kCount) * rows;
    if (!outputs_ || outputs_->size() < room) outputs_ = std::make_unique<Buffer<Lanes>>(room);
  }
  /// Lanes are numbers side by side.
  [[nodiscard]] RPSUP_INLINE static double entry(const Lanes* row, int column) {
    double value;
    __builtin_memcpy(&value, reinterpret_cast<const char*>(row) + sizeof(double) * static_cast<std::size_t>(column), sizeof value);
    return value;
  }
  [[nodiscard]] static int group_of(int column) { return static_cast<int>(static_cast<unsigned>(column) / Lanes::kCount); }
  [[nodiscard]] int clamp(int bristle) const { return bristle < 0 ? 0 : bristle > bristle_count_ ? bristle_count_ : bristle; }
  CoordinateVariation<Lanes>& variation(int column, int coordinate) {
    CoordinateVariation<Lanes>& entry = coordinates_[static_cast<std::size_t>(group_of(column)) * n_ + static_cast<std::size_t>(coordinate)];
    entry.varies = true;
    return entry;
  }

  const TreeModel& model_;
  std::size_t n_;                            ///< coordinates
  Buffer<int> column_of_q_;                  ///< of each free coordinate; its rate follows
  int first_bristle_column_ = 0, moving_groups_ = 0;
  int bristle_count_ = 0, groups_ = 0;
  Buffer<BristleVariation> bristles_;
  Buffer<CoordinateVariation<Lanes>> coordinates_;  ///< group after group, one a coordinate; those left over stand still
  std::unique_ptr<Buffer<Lanes>> outputs_;   ///< row after row, one a group
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
