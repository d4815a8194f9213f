// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "engine/model/applied_force.h"
#include "engine/model/mechanism.h"

namespace engine {

/// The least of calc_time_scale() of the drives' laws.
[[nodiscard]] inline double calc_time_scale(const std::vector<Drive>& drives, double t) {
  double scale = std::numeric_limits<double>::infinity();
  for (const Drive& drive : drives) scale = std::min(scale, calc_time_scale(drive.law, t));
  return scale;
}

/// The first of find_next_corner() of the drives' laws.
[[nodiscard]] inline double find_next_corner(const std::vector<Drive>& drives, double t) {
  double corner = std::numeric_limits<double>::infinity();
  for (const Drive& drive : drives) corner = std::min(corner, find_next_corner(drive.law, t));
  return corner;
}

/// Stretch of time whose end no step crosses: find_next_step_end() of the motion that a drive or a controller
/// gives, or a point of a table over time of a force, a voltage or a load. A step that ends there has the
/// accelerations before a jump, and the next one begins with those behind it. Steps may end a rounding beside
/// that instant; is_over() decides, not a comparison of instants.
class DrivePiece {
 public:
  /// All of time.
  DrivePiece() = default;
  /// The first piece, from t = 0 on. All arguments outlive this
  explicit DrivePiece(std::span<const Drive> drives, std::span<const Actuation> actuations = {},
                      std::span<const BodyLoad> body_loads = {})
      : drives_(drives), actuations_(actuations), body_loads_(body_loads) {
    calc_end(0.0);
  }

  /// [s], infinite if steps may end anywhere
  [[nodiscard]] double end() const { return end_; }

  /// @returns whether a step that ends at t has come to the end, but for rounding
  [[nodiscard]] bool is_over(double t) const { return t >= end_ * (1.0 - kRounding); }

  /// Goes on to the piece behind this one's end.
  void advance() {
    earliest_ = end_ * (1.0 + kBeside);
    calc_end(end_);
  }

  /// The instant at which the laws are to be evaluated for t: t itself; at and beyond an end of the piece the
  /// nearest instant surely inside.
  [[nodiscard]] double clamp(double t) const { return std::clamp(t, earliest_, latest_); }

 private:
  static constexpr double kBeside = 1e-14;  ///< of the time: more than the rounding of a jump's instant
  /// Of the time: grids and corners count such instants as one.
  static constexpr double kRounding = 2e-12;

  void calc_end(double t) {
    end_ = std::numeric_limits<double>::infinity();
    for (const Drive& drive : drives_) end_ = std::min(end_, find_next_step_end(drive.law, t));
    for (const Actuation& actuation : actuations_) end_ = std::min(end_, find_next_step_end(actuation, t));
    for (const BodyLoad& load : body_loads_) end_ = std::min(end_, find_next_point(load.law, t));
    latest_ = end_ < std::numeric_limits<double>::infinity() ? end_ * (1.0 - kBeside) : end_;
  }

  std::span<const Drive> drives_;
  std::span<const Actuation> actuations_;
  std::span<const BodyLoad> body_loads_;
  double end_ = std::numeric_limits<double>::infinity();
  double earliest_ = -std::numeric_limits<double>::infinity();
  double latest_ = std::numeric_limits<double>::infinity();
};

}  // namespace engine
