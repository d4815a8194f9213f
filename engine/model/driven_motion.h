// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// A driven coordinate at one instant.
struct DrivenMotion {
  double q = 0.0;     ///< [rad] or [m]
  double qd = 0.0;    ///< its derivatives by time
  double qdd = 0.0;
  double qddd = 0.0;  ///< for linearising by time
};

}  // namespace engine
