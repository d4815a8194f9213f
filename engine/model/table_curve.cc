// SPDX-License-Identifier: Apache-2.0
#include "engine/model/table_curve.h"

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
std::vector<double> calc_monotone_slopes(const std::vector<double>& x, const std::vector<double>& v) {
  const std::size_t intervals = x.size() - 1;
  const auto h = [&](std::size_t k) { return x[k + 1] - x[k]; };
  const auto d = [&](std::size_t k) { return (v[k + 1] - v[k]) / h(k); };
  if (intervals == 1) return {d(0), d(0)};
  std::vector<double> slopes(x.size());
  for (std::size_t k = 1; k < intervals; ++k)
    slopes[k] = calc_inner_slope(h(k - 1), d(k - 1), h(k), d(k));
  slopes.front() = calc_end_slope(h(0), d(0), h(1), d(1));
  slopes.back() = calc_end_slope(h(intervals - 1), d(intervals - 1), h(intervals - 2), d(intervals - 2));
  return slopes;
}

}  // namespace

TableCurve::TableCurve(const std::vector<double>& x, const std::vector<double>& values,
                       TableInterpolation interpolation) {
  assert(!x.empty() && x.size() == values.size());
  const bool cubic = interpolation == TableInterpolation::kMonotoneCubic && x.size() > 1;
  const std::vector<double> slopes = cubic ? calc_monotone_slopes(x, values) : std::vector<double>();
  pieces_.push_back({.x = x.front(), .v = values.front()});
  for (std::size_t k = 0; k < x.size(); ++k) {
    const bool inside = k > 0 && k + 1 < x.size();
    append(make_piece(x, values, slopes, k), cubic && inside);
  }
  const auto [least, largest] = std::ranges::minmax(values);
  range_ = largest - least;
  const double shift = -calc(0.0).integral;
  for (Piece& piece : pieces_) piece.integral += shift;
}

/// The piece that begins at the k-th point, but for its integral. @param slopes  at the points; empty: it is
/// straight
TableCurve::Piece TableCurve::make_piece(const std::vector<double>& x, const std::vector<double>& values,
                                         const std::vector<double>& slopes, std::size_t k) {
  Piece piece{.x = x[k], .v = values[k]};
  if (k + 1 == x.size()) return piece;
  const double h = x[k + 1] - x[k], d = (values[k + 1] - values[k]) / h;
  piece.a = d;
  if (slopes.empty()) return piece;
  piece.a = slopes[k];
  piece.b = (3.0 * d - 2.0 * slopes[k] - slopes[k + 1]) / h;
  piece.c = (slopes[k] + slopes[k + 1] - 2.0 * d) / (h * h);
  return piece;
}

/// Appends a piece behind those before. @param is_smooth  whether the slope is continuous there but for
/// rounding
void TableCurve::append(Piece piece, bool is_smooth) {
  const Point before = calc(piece.x);
  piece.integral = before.integral;
  const double size = std::abs(piece.a) + std::abs(before.slope);
  piece.has_kink = !is_smooth && std::abs(piece.a - before.slope) > 1e-12 * size;
  pieces_.push_back(piece);
}

const TableCurve::Piece& TableCurve::piece_of(double x) const {
  const auto next = std::upper_bound(pieces_.begin() + 1, pieces_.end(), x,
                                     [](double at, const Piece& piece) { return at < piece.x; });
  return *(next - 1);
}

TableCurve::Point TableCurve::calc(double x) const {
  const Piece& p = piece_of(x);
  const double s = x - p.x;
  return {p.integral + s * (p.v + s * (p.a / 2.0 + s * (p.b / 3.0 + s * p.c / 4.0))),
          p.v + s * (p.a + s * (p.b + s * p.c)), p.a + s * (2.0 * p.b + s * 3.0 * p.c),
          2.0 * p.b + 6.0 * s * p.c, 6.0 * p.c};
}

double TableCurve::next_point(double x) const {
  const Piece& next = *std::find_if(pieces_.begin() + 1, pieces_.end() - 1, [&](const Piece& piece) {
    return piece.x > x + 1e-12 * std::abs(x);
  });
  return next.x > x + 1e-12 * std::abs(x) ? next.x : std::numeric_limits<double>::infinity();
}

double TableCurve::next_kink(double x) const {
  double next = next_point(x);
  while (std::isfinite(next) && !piece_of(next).has_kink) next = next_point(next);
  return next;
}

double TableCurve::calc_bulge(double from, double to) const {
  const auto [low, high] = std::minmax(from, to);
  const double v_low = calc(low).value, slope = (calc(high).value - v_low) / (high - low);
  double most = 0.0;
  for (auto point = &piece_of(low) + 1; point < pieces_.data() + pieces_.size() && point->x < high; ++point)
    most = std::max(most, std::abs(point->v - v_low - slope * (point->x - low)));
  return range_ > 0.0 ? most / range_ : 0.0;
}

}  // namespace engine
