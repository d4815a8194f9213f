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

/// First instant after t at which one piece of the law meets the next: the acceleration has a kink there, and derivatives of any order
/// only in between. Infinite if none follows, [s]
[[nodiscard]] double find_next_corner(const RunUp& law, double t);
[[nodiscard]] double find_next_corner(const RiseReturnPause& law, double t);
[[nodiscard]] double find_next_corner(const DriveLaw& law, double t);

/// Time in which the drive moves on by about one radian, of its own angle or of its law's sine, from t on; infinite at rest, [s].
/// It holds for a tenth of itself.
[[nodiscard]] double calc_time_scale(const RunUp& law, double t);
[[nodiscard]] double calc_time_scale(const RiseReturnPause& law, double t);
[[nodiscard]] double calc_time_scale(const DriveLaw& law, double t);

}  // namespace engine
