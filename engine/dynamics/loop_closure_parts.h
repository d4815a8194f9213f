// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/QR>

#include "engine/model/mechanism.h"

// Helpers that the sources of LoopClosure share.
namespace engine::loop_closure {

constexpr double kClosed = 1e-13;  // of Phi, [m] and [1]: rounding of positions up to 10 m
constexpr int kMaxIterations = 100;
constexpr double kMaxStep = 0.5;  // of a Newton step, [rad] or [m]; a full one from afar may leave the branch
constexpr double kDependent = 1e-9;  // of the largest pivot
constexpr double kRounded = 1e-6;  // of the size of the mechanism, and of axes: what starts of 7 digits leave

/// Coordinates of joints that are not driven and for which `holds` is true.
template <typename Holds>
std::vector<FrameIndex> find_coordinates(const Mechanism& mechanism, const Holds& holds) {
  std::vector<FrameIndex> found;
  for (FrameIndex i = 0; i < static_cast<FrameIndex>(mechanism.coordinates.size()); ++i) {
    const bool driven = std::any_of(mechanism.drives.begin(), mechanism.drives.end(),
                                    [i](const Drive& d) { return d.coordinate == i; });
    const Coordinate& coordinate = mechanism.coordinates[static_cast<std::size_t>(i)];
    if (!driven && coordinate.role == CoordinateRole::kJoint && holds(coordinate)) found.push_back(i);
  }
  return found;
}

inline bool is_any(const Coordinate&) { return true; }

/// Complete orthogonal decomposition: J need not have full rank, and in a flat mechanism has not.
/// @param dependent  of the largest pivot: smaller ones count as zero
inline Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decompose(
    const Eigen::MatrixXd& J, double dependent = kDependent) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(dependent);
  decomposition.compute(J);
  return decomposition;
}

/// Numerical rank of J.
inline Eigen::Index rank_of(const Eigen::MatrixXd& J) { return J.size() == 0 ? 0 : decompose(J).rank(); }

}  // namespace engine::loop_closure
