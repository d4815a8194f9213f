#pragma once

#include <Eigen/Core>

#include "engine/model/mechanism.h"

namespace support {

/// The equations of motion as the paper writes them, Eqs. (2)-(9): 4x4 transforms, their first and second derivatives by each
/// coordinate, pseudo-inertia matrices, traces. Slow, and written without a look at the engine's recursions.
struct TraceForm {
  Eigen::MatrixXd M;         ///< Eq. (5)
  Eigen::VectorXd h;         ///< Eq. (5)
  Eigen::VectorXd g;         ///< Eq. (7)
  double kinetic_energy;     ///< Eq. (4)
  double potential_energy;   ///< Eq. (6), gravity alone
};

[[nodiscard]] TraceForm calc_trace_form(const engine::Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd);

}  // namespace support
