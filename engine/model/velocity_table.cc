// SPDX-License-Identifier: Apache-2.0
#include "engine/model/velocity_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace engine {

namespace {

/// Slope at the end of a table, beside an interval h of slope d and one further away: of the parabola through
/// the three points, unless it would make an extreme.
double calc_end_slope(double h, double d, double h_next, double d_next) {
  const double slope = ((2.0 * h + h_next) * d - h * d_next) / (h + h_next);
  if (slope * d <= 0.0) return 0.0;
  return d * d_next <= 0.0 && std::abs(slope) > 3.0 * std::abs(d) ? 3.0 * d : slope;
}

/// Slope at a point between two intervals: the harmonic mean of theirs, weighted; 0 at an extreme.
double calc_inner_slope(double h_before, double d_before, double h, double d) {
  if (d_before * d <= 0.0) return 0.0;
  const double w_before = 2.0 * h + h_before, w = h + 2.0 * h_before;
  return (w_before + w) / (w_before / d_before + w / d);
}

/// Slopes at the points of a table of two points or more.
std::vector<double> calc_monotone_slopes(const std::vector<double>& t, const std::vector<double>& v) {
  const std::size_t intervals = t.size() - 1;
  const auto h = [&](std::size_t k) { return t[k + 1] - t[k]; };
  const auto d = [&](std::size_t k) { return (v[k + 1] - v[k]) / h(k); };
  if (intervals == 1) return {d(0), d(0)};
  std::vector<double> slopes(t.size());
  for (std::size_t k = 1; k < intervals; ++k)
    slopes[k] = calc_inner_slope(h(k - 1), d(k - 1), h(k), d(k));
  slopes.front() = calc_end_slope(h(0), d(0), h(1), d(1));
  slopes.back() = calc_end_slope(h(intervals - 1), d(intervals - 1), h(intervals - 2), d(intervals - 2));
  return slopes;
}

}  // namespace

VelocityTable::VelocityTable(const std::vector<double>& t, const std::vector<double>& v,
                             TableInterpolation interpolation, double start) {
  assert(!t.empty() && t.size() == v.size());
  const bool cubic = interpolation == TableInterpolation::kMonotoneCubic && t.size() > 1;
  const std::vector<double> slopes = cubic ? calc_monotone_slopes(t, v) : std::vector<double>();
  pieces_.push_back({.t = t.front(), .v = v.front()});
  for (std::size_t k = 0; k < t.size(); ++k) {
    Piece piece{.t = t[k], .v = v[k]};
    if (k + 1 < t.size()) {
      const double h = t[k + 1] - t[k], d = (v[k + 1] - v[k]) / h;
      piece.a = cubic ? slopes[k] : d;
      if (cubic) {
        piece.b = (3.0 * d - 2.0 * slopes[k] - slopes[k + 1]) / h;
        piece.c = (slopes[k] + slopes[k + 1] - 2.0 * d) / (h * h);
      }
    }
    const DrivenMotion before = calc(t[k]);
    piece.q = before.q;
    const bool inside = k > 0 && k + 1 < t.size();
    const double size = std::abs(piece.a) + std::abs(before.qdd);
    piece.jumps = !(cubic && inside) && std::abs(piece.a - before.qdd) > 1e-12 * size;
    pieces_.push_back(piece);
  }
  const double shift = start - calc(0.0).q;
  for (Piece& piece : pieces_) piece.q += shift;
}

const VelocityTable::Piece& VelocityTable::piece_of(double t) const {
  const auto next = std::upper_bound(pieces_.begin() + 1, pieces_.end(), t,
                                     [](double instant, const Piece& piece) { return instant < piece.t; });
  return *(next - 1);
}

DrivenMotion VelocityTable::calc(double t) const {
  const Piece& p = piece_of(t);
  const double s = t - p.t;
  return {p.q + s * (p.v + s * (p.a / 2.0 + s * (p.b / 3.0 + s * p.c / 4.0))),
          p.v + s * (p.a + s * (p.b + s * p.c)), p.a + s * (2.0 * p.b + s * 3.0 * p.c),
          2.0 * p.b + 6.0 * s * p.c};
}

double VelocityTable::next_point(double t) const {
  const Piece& next = *std::find_if(pieces_.begin() + 1, pieces_.end() - 1, [&](const Piece& piece) {
    return piece.t > t + 1e-12 * std::abs(t);
  });
  return next.t > t + 1e-12 * std::abs(t) ? next.t : std::numeric_limits<double>::infinity();
}

double VelocityTable::next_jump(double t) const {
  double next = next_point(t);
  while (std::isfinite(next) && !piece_of(next).jumps) next = next_point(next);
  return next;
}

double VelocityTable::time_scale(double t) const {
  const DrivenMotion motion = calc(t);
  const double qdddd = 6.0 * piece_of(t).c;
  return 1.0 / std::max({std::abs(motion.qd), std::sqrt(std::abs(motion.qdd)),
                         std::cbrt(std::abs(motion.qddd)), std::sqrt(std::sqrt(std::abs(qdddd)))});
}

}  // namespace engine
