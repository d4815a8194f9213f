#include "engine/model/drive_law.h"

#include <cmath>
#include <numbers>

namespace engine {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// C(u) = u - sin(2 pi u) / (2 pi) and its derivatives by u.
struct Cycloid {
  double c, dc, ddc, dddc;
};

Cycloid calc_cycloid(double u) {
  const double s = std::sin(kTwoPi * u);
  const double c = std::cos(kTwoPi * u);
  return {u - s / kTwoPi, 1.0 - c, kTwoPi * s, kTwoPi * kTwoPi * c};
}

}  // namespace

DrivenMotion calc_driven_motion(const RunUp& law, double t) {
  if (t >= law.run_up) return {law.omega * (t - 0.5 * law.run_up), law.omega, 0.0, 0.0};
  const double u = t / law.run_up;
  const Cycloid cycloid = calc_cycloid(u);
  const double integral = 0.5 * u * u + (std::cos(kTwoPi * u) - 1.0) / (kTwoPi * kTwoPi);
  const double rate = law.omega / law.run_up;
  return {law.omega * law.run_up * integral, law.omega * cycloid.c, rate * cycloid.dc, rate / law.run_up * cycloid.ddc};
}

DrivenMotion calc_driven_motion(const RiseReturnPause& law, double t) {
  const double in_cycle = std::fmod(t, 2.0 * law.stroke_time + law.pause);
  if (in_cycle >= 2.0 * law.stroke_time) return {};
  const bool rises = in_cycle < law.stroke_time;
  const Cycloid cycloid = calc_cycloid((rises ? in_cycle : in_cycle - law.stroke_time) / law.stroke_time);
  const double direction = rises ? 1.0 : -1.0;
  const double T = law.stroke_time;
  return {law.stroke * (rises ? cycloid.c : 1.0 - cycloid.c), direction * law.stroke * cycloid.dc / T,
          direction * law.stroke * cycloid.ddc / (T * T), direction * law.stroke * cycloid.dddc / (T * T * T)};
}

DrivenMotion calc_driven_motion(const DriveLaw& law, double t) {
  return std::visit([t](const auto& l) { return calc_driven_motion(l, t); }, law);
}

}  // namespace engine
