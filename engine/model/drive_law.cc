// SPDX-License-Identifier: Apache-2.0
#include "engine/model/drive_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace engine {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Part of a stroke that is done and its derivatives by u.
struct Rise {
  double c, dc, ddc, dddc;
};

/// C(u) = u - sin(2 pi u) / (2 pi)
Rise calc_cycloid(double u) {
  const double s = std::sin(kTwoPi * u);
  const double c = std::cos(kTwoPi * u);
  return {u - s / kTwoPi, 1.0 - c, kTwoPi * s, kTwoPi * kTwoPi * c};
}

Rise calc_cosine(double u) {
  constexpr double kPi = std::numbers::pi;
  const double s = std::sin(kPi * u);
  const double c = std::cos(kPi * u);
  return {0.5 - 0.5 * c, 0.5 * kPi * s, 0.5 * kPi * kPi * c, -0.5 * kPi * kPi * kPi * s};
}

Rise calc_parabola(double u) {
  if (u < 0.5) return {2.0 * u * u, 4.0 * u, 4.0, 0.0};
  return {1.0 - 2.0 * (1.0 - u) * (1.0 - u), 4.0 * (1.0 - u), -4.0, 0.0};
}

Rise calc_rise(StrokeLaw law, double u) {
  switch (law) {
    case StrokeLaw::kCycloidal: return calc_cycloid(u);
    case StrokeLaw::kCosine: return calc_cosine(u);
    case StrokeLaw::kParabolic: return calc_parabola(u);
  }
  return {};
}

/// A corner found before, but for rounding, is not the next one.
double beyond(double t) { return t + 1e-12 * std::abs(t); }

/// By Horner's scheme, [rad/s^order] or [m/s^order].
double calc_derivative(const Polynomial& law, std::size_t order, double t) {
  const std::size_t count = law.coefficients.size();
  if (count <= order) return 0.0;
  double factor = 1.0;  // k! / (k - order)!
  for (std::size_t i = 0; i < order; ++i) factor *= static_cast<double>(count - 1 - i);
  double derivative = 0.0;
  for (std::size_t k = count; k-- > order;) {
    derivative = derivative * t + factor * law.coefficients[k];
    if (k > order) factor *= static_cast<double>(k - order) / static_cast<double>(k);
  }
  return derivative;
}

}  // namespace

DrivenMotion calc_driven_motion(const RunUp& law, double t) {
  if (t >= law.run_up) return {law.start + law.omega * (t - 0.5 * law.run_up), law.omega, 0.0, 0.0};
  const double u = t / law.run_up;
  const Rise cycloid = calc_cycloid(u);
  const double integral = 0.5 * u * u + (std::cos(kTwoPi * u) - 1.0) / (kTwoPi * kTwoPi);
  const double rate = law.omega / law.run_up;
  return {law.start + law.omega * law.run_up * integral, law.omega * cycloid.c, rate * cycloid.dc,
          rate / law.run_up * cycloid.ddc};
}

DrivenMotion calc_driven_motion(const RiseReturnPause& law, double t) {
  const double in_cycle = std::fmod(t, 2.0 * law.stroke_time + law.pause);
  if (in_cycle >= 2.0 * law.stroke_time) return {.q = law.start};
  const bool rises = in_cycle < law.stroke_time;
  const Rise rise = calc_rise(law.law, (rises ? in_cycle : in_cycle - law.stroke_time) / law.stroke_time);
  const double direction = rises ? 1.0 : -1.0;
  const double T = law.stroke_time;
  return {law.start + law.stroke * (rises ? rise.c : 1.0 - rise.c), direction * law.stroke * rise.dc / T,
          direction * law.stroke * rise.ddc / (T * T), direction * law.stroke * rise.dddc / (T * T * T)};
}

DrivenMotion calc_driven_motion(const CycloidalRise& law, double t) {
  if (t <= law.begin) return {law.from, 0.0, 0.0, 0.0};
  const double u = (t - law.begin) / law.time;
  if (u >= 1.0) return {law.from + law.rise, 0.0, 0.0, 0.0};
  const Rise cycloid = calc_cycloid(u);
  const double rate = law.rise / law.time;
  return {law.from + law.rise * cycloid.c, rate * cycloid.dc, rate / law.time * cycloid.ddc,
          rate / (law.time * law.time) * cycloid.dddc};
}

DrivenMotion calc_driven_motion(const Harmonic& law, double t) {
  const double s = law.amplitude * std::sin(law.omega * t + law.phase);
  const double c = law.amplitude * law.omega * std::cos(law.omega * t + law.phase);
  const double omega2 = law.omega * law.omega;
  return {law.mean + s, c, -omega2 * s, -omega2 * c};
}

DrivenMotion calc_driven_motion(const Polynomial& law, double t) {
  double p = 0.0, first = 0.0, second = 0.0, third = 0.0;  // Taylor's coefficients at t, by Horner's scheme
  for (std::size_t k = law.coefficients.size(); k-- > 0;) {
    third = third * t + second;
    second = second * t + first;
    first = first * t + p;
    p = p * t + law.coefficients[k];
  }
  return {p, first, 2.0 * second, 6.0 * third};
}

DrivenMotion calc_driven_motion(const DriveLaw& law, double t) {
  return std::visit([t](const auto& l) { return calc_driven_motion(l, t); }, law);
}

double find_next_corner(const RunUp& law, double t) { return beyond(t) < law.run_up ? law.run_up : kNever; }

double find_next_corner(const RiseReturnPause& law, double t) {
  if (law.stroke == 0.0) return kNever;
  const double cycle = 2.0 * law.stroke_time + law.pause;
  const double middle = law.law == StrokeLaw::kParabolic ? 0.5 * law.stroke_time : 0.0;
  for (double start = std::floor(t / cycle) * cycle;; start += cycle)
    for (const double corner : {start, start + middle, start + law.stroke_time,
                                start + law.stroke_time + middle, start + 2.0 * law.stroke_time})
      if (corner > beyond(t)) return corner;
}

double find_next_corner(const CycloidalRise& law, double t) {
  for (const double corner : {law.begin, law.begin + law.time})
    if (corner > beyond(t)) return corner;
  return kNever;
}

double find_next_corner(const Harmonic&, double) { return kNever; }
double find_next_corner(const Polynomial&, double) { return kNever; }

double find_next_corner(const DriveLaw& law, double t) {
  return std::visit([t](const auto& l) { return find_next_corner(l, t); }, law);
}

double find_next_jump(const RiseReturnPause& law, double t) {
  return law.law == StrokeLaw::kCycloidal ? kNever : find_next_corner(law, t);
}

double find_next_jump(const DriveLaw& law, double t) {
  if (const auto* const strokes = std::get_if<RiseReturnPause>(&law)) return find_next_jump(*strokes, t);
  if (const auto* const spline = std::get_if<Spline>(&law)) return spline->next_knot(t);
  const auto* const table = std::get_if<VelocityTable>(&law);
  return table ? find_next_jump(*table, t) : kNever;
}

double find_next_step_end(const DriveLaw& law, double t) {
  constexpr double kShort = 0.02;  // [s], some of the longest steps
  if (const auto* const table = std::get_if<VelocityTable>(&law)) return find_next_corner(*table, t);
  if (const auto* const rise = std::get_if<CycloidalRise>(&law))
    return rise->time < kShort ? find_next_corner(*rise, t) : kNever;
  const auto* const strokes = std::get_if<RiseReturnPause>(&law);
  return strokes && strokes->stroke_time < kShort ? find_next_corner(*strokes, t) : find_next_jump(law, t);
}

double calc_time_scale(const RunUp& law, double t) {
  if (law.omega == 0.0) return kNever;
  if (t >= law.run_up) return 1.0 / std::abs(law.omega);
  const double of_law = law.run_up / kTwoPi;
  return std::min(of_law,
                  1.0 / std::abs(calc_driven_motion(law, t + 0.1 * of_law).qd));  // the speed only grows
}

double calc_time_scale(const RiseReturnPause& law, double t) {
  const double in_cycle = std::fmod(t, 2.0 * law.stroke_time + law.pause);
  return law.stroke == 0.0 || in_cycle >= 2.0 * law.stroke_time ? kNever : law.stroke_time / kTwoPi;
}

double calc_time_scale(const CycloidalRise& law, double t) {
  return law.rise == 0.0 || t < law.begin || t >= law.begin + law.time ? kNever : law.time / kTwoPi;
}

double calc_time_scale(const Harmonic& law, double) {
  return law.amplitude == 0.0 ? kNever : 1.0 / std::abs(law.omega);
}

/// By derivatives beyond those of the motion, too: where it starts without a jolt, the first three vanish.
double calc_time_scale(const Polynomial& law, double t) {
  constexpr std::size_t kOrders = 32;
  double fastest = 0.0;  // [1/s]
  for (std::size_t order = 1; order <= std::min(kOrders, law.coefficients.size()); ++order)
    fastest = std::max(fastest,
                       std::pow(std::abs(calc_derivative(law, order, t)), 1.0 / static_cast<double>(order)));
  return 1.0 / fastest;
}

double calc_time_scale(const DriveLaw& law, double t) {
  return std::visit([t](const auto& l) { return calc_time_scale(l, t); }, law);
}

}  // namespace engine
