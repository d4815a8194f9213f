// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace jobs {

/// Point in parameter space, one value a parameter.
using FitPoint = std::vector<double>;

/// Simulations that have ended, by their exact points.
class Evaluations {
 public:
  /// Records an evaluation. A second one of the same point changes nothing.
  /// @param residuals  as many at every point; an evaluation with a residual that is not finite counts as
  ///   failed
  /// @throws engine::InvalidInput if their number differs from that of an earlier point
  void tell(const FitPoint& point, std::vector<double> residuals);
  void tell_failed(const FitPoint& point);

  /// Null: the point has not been told. Empty: its simulation has failed.
  [[nodiscard]] const std::optional<std::vector<double>>* find(const FitPoint& point) const;
  /// Number of residuals of a point; 0 as long as no simulation has succeeded.
  [[nodiscard]] std::size_t residual_count() const { return residual_count_; }

 private:
  std::map<FitPoint, std::optional<std::vector<double>>> by_point_;
  std::size_t residual_count_ = 0;
};

}  // namespace jobs
