#pragma once

#include <variant>

namespace engine {

/// A driven coordinate at one instant.
struct DrivenMotion {
  double q = 0.0;
  double qd = 0.0;
  double qdd = 0.0;
  double qddd = 0.0;  ///< what linearising by time needs
};

/// From rest to the velocity `omega` by the cycloidal law in `run_up` seconds, then on with it.
///
///     qd = omega C(t / run_up),  C(u) = u - sin(2 pi u) / (2 pi),  q(0) = 0
struct RunUp {
  double omega = 0.0;   ///< [rad/s]
  double run_up = 0.0;  ///< [s], >= 0; 0: at full speed from the start
};

/// Again and again: rise by `stroke` and return, each by the cycloidal law in `stroke_time` seconds, then a pause.
struct RiseReturnPause {
  double stroke = 0.0;       ///< [m]
  double stroke_time = 1.0;  ///< [s], > 0
  double pause = 0.0;        ///< [s], >= 0
};

using DriveLaw = std::variant<RunUp, RiseReturnPause>;

[[nodiscard]] DrivenMotion calc_driven_motion(const RunUp& law, double t);
[[nodiscard]] DrivenMotion calc_driven_motion(const RiseReturnPause& law, double t);
[[nodiscard]] DrivenMotion calc_driven_motion(const DriveLaw& law, double t);

}  // namespace engine
