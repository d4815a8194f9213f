// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "engine/model/driven_motion.h"
#include "engine/model/velocity_table.h"

namespace engine {

/// From rest to the velocity `omega` by the cycloidal law in `run_up` seconds, then on with it.
///
///     qd = omega C(t / run_up),  C(u) = u - sin(2 pi u) / (2 pi),  q(0) = start
struct RunUp {
  double omega = 0.0;   ///< [rad/s]
  double run_up = 0.0;  ///< [s], >= 0; 0: at full speed from the start
  double start = 0.0;   ///< [rad] or [m]
};

/// Part of a stroke that is done at the part u of its time, both from 0 to 1: the laws of cams.
enum class StrokeLaw {
  kCycloidal,  ///< u - sin(2 pi u) / (2 pi); the acceleration is continuous
  kCosine,  ///< (1 - cos(pi u)) / 2, simple harmonic motion; the acceleration jumps where a pause begins or
            ///< ends
  kParabolic,  ///< 2 u^2 up to the middle, then 1 - 2 (1 - u)^2; the acceleration is constant; it jumps there
               ///< and where a pause begins or ends
};

/// Again and again: rise by `stroke` and return, each by the law in `stroke_time` seconds, then a pause.
struct RiseReturnPause {
  double stroke = 0.0;       ///< [rad] or [m]
  double stroke_time = 1.0;  ///< [s], > 0
  double pause = 0.0;        ///< [s], >= 0
  StrokeLaw law = StrokeLaw::kCycloidal;
  double start = 0.0;        ///< position in the pause, [rad] or [m]
};

/// Rest, one rise by the cycloidal law, rest.
struct CycloidalRise {
  double from = 0.0;    ///< [rad] or [m]
  double rise = 0.0;    ///< [rad] or [m]
  double begin = 0.0;   ///< [s]
  double time = 1.0;    ///< [s], > 0
};

/// mean + amplitude sin(omega t + phase)
struct Harmonic {
  double mean = 0.0;       ///< [rad] or [m]
  double amplitude = 0.0;  ///< [rad] or [m]
  double omega = 1.0;      ///< [rad/s], not 0
  double phase = 0.0;      ///< [rad]
};

/// c_0 + c_1 t + c_2 t^2 + ...
struct Polynomial {
  std::vector<double> coefficients;  ///< [rad/s^k] or [m/s^k]
};

/// Points joined by the natural cubic spline, whose second derivative is continuous; before the first and
/// after the last of them it goes on straight.
class Spline {
 public:
  /// @param t, q  two points or more, t rising
  Spline(std::vector<double> t, std::vector<double> q);

  [[nodiscard]] DrivenMotion calc(double t) const;
  [[nodiscard]] double next_knot(double t) const;  ///< infinite behind the last
  [[nodiscard]] double time_scale(double t) const;

 private:
  [[nodiscard]] std::size_t piece_of(double t) const;

  std::vector<double> t_, q_;
  std::vector<double> bend_;  ///< second derivative at each point
};

using DriveLaw =
    std::variant<RunUp, RiseReturnPause, CycloidalRise, Harmonic, Polynomial, Spline, VelocityTable>;

[[nodiscard]] DrivenMotion calc_driven_motion(const RunUp& law, double t);
[[nodiscard]] DrivenMotion calc_driven_motion(const RiseReturnPause& law, double t);
[[nodiscard]] DrivenMotion calc_driven_motion(const CycloidalRise& law, double t);
[[nodiscard]] DrivenMotion calc_driven_motion(const Harmonic& law, double t);
[[nodiscard]] DrivenMotion calc_driven_motion(const Polynomial& law, double t);
[[nodiscard]] inline DrivenMotion calc_driven_motion(const Spline& law, double t) { return law.calc(t); }
[[nodiscard]] inline DrivenMotion calc_driven_motion(const VelocityTable& law, double t) {
  return law.calc(t);
}
[[nodiscard]] DrivenMotion calc_driven_motion(const DriveLaw& law, double t);

/// First instant after t at which one piece of the law meets the next: the acceleration has a kink there, and
/// derivatives of any order only in between. Infinite if none follows, [s]
[[nodiscard]] double find_next_corner(const RunUp& law, double t);
[[nodiscard]] double find_next_corner(const RiseReturnPause& law, double t);
[[nodiscard]] double find_next_corner(const CycloidalRise& law, double t);
[[nodiscard]] double find_next_corner(const Harmonic& law, double t);
[[nodiscard]] double find_next_corner(const Polynomial& law, double t);
[[nodiscard]] inline double find_next_corner(const Spline& law, double t) { return law.next_knot(t); }
[[nodiscard]] inline double find_next_corner(const VelocityTable& law, double t) { return law.next_point(t); }
[[nodiscard]] double find_next_corner(const DriveLaw& law, double t);

/// First instant after t at which the law's acceleration jumps, or, of a spline, has a kink: an extremum that
/// no step may cross. Infinite if none follows, [s]
[[nodiscard]] double find_next_jump(const RiseReturnPause& law, double t);
[[nodiscard]] inline double find_next_jump(const VelocityTable& law, double t) { return law.next_jump(t); }
[[nodiscard]] double find_next_jump(const DriveLaw& law, double t);

/// First instant after t at which a step has to end: a jump, a point of a table, or the begin or end of a
/// motion so short that a step could go past it between two of its evaluations. Infinite if none follows, [s]
[[nodiscard]] double find_next_step_end(const DriveLaw& law, double t);

/// Time in which the drive moves on by about one radian, of its own angle or of its law's sine, from t on;
/// infinite at rest, [s]. It holds for a tenth of itself.
[[nodiscard]] double calc_time_scale(const RunUp& law, double t);
[[nodiscard]] double calc_time_scale(const RiseReturnPause& law, double t);
[[nodiscard]] double calc_time_scale(const CycloidalRise& law, double t);
[[nodiscard]] double calc_time_scale(const Harmonic& law, double t);
[[nodiscard]] double calc_time_scale(const Polynomial& law, double t);
[[nodiscard]] inline double calc_time_scale(const Spline& law, double t) { return law.time_scale(t); }
[[nodiscard]] inline double calc_time_scale(const VelocityTable& law, double t) { return law.time_scale(t); }
[[nodiscard]] double calc_time_scale(const DriveLaw& law, double t);

}  // namespace engine
