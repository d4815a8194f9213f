// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/math/periodic_spline.h"

namespace engine {

/// The depth worn off a bearing's bore: for each ring of the journal, in sectors of equal width around it,
/// the first from the bearing's x on, [m].
using WearDepth = std::vector<std::vector<double>>;

/// A bore that is worn, as the rings of a journal of its own roundness find it.
///
/// Wear is shallow: the depth g(phi) is small against the bearing's radius, so that it is only a gap which
/// the journal has more at phi. A ring whose centre lies at e in the direction theta then penetrates there by
/// |e| cos(phi - theta) - c_r - g(phi), and first touches, anywhere, at
///
///     |e| = R(theta) = min over phi of (c_r + g(phi)) / cos(phi - theta)
///
/// R is the journal's free radius: it does not enter a groove that is narrower than itself. The contact law
/// is a function of R (continuum_law.h). Both g and R are periodic cubic splines, of the sectors' depths and
/// of R at 720 angles.
class WornBore {
 public:
  /// @param c_r  of the bore as it was new, [m], > 0  @param depth  one list a ring, of three sectors or more
  WornBore(double c_r, const WearDepth& depth);

  /// g(phi), [m].
  [[nodiscard]] double calc_depth(int ring, double phi) const {
    return depths_[static_cast<std::size_t>(ring)].at(phi).value;
  }
  /// R(theta) - c_r, the clearance that wear has added in that direction, with its derivatives by theta, [m].
  [[nodiscard]] PeriodicSpline::Point calc_added_clearance(int ring, double theta) const {
    return added_clearances_[static_cast<std::size_t>(ring)].at(theta);
  }

 private:
  std::vector<PeriodicSpline> depths_;
  std::vector<PeriodicSpline> added_clearances_;
};

}  // namespace engine
