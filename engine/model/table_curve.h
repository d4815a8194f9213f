// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace engine {

/// Interpolation between the points of a table.
enum class TableInterpolation {
  kLinear,         ///< straight: the slope jumps at the points
  kMonotoneCubic,  ///< piecewise cubic with a continuous slope and no extremes between the points: F. N.
                   ///< Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984), with one-sided slopes of
                   ///< second order at both ends
};

/// Values of a function at points; between them interpolated, and constant before the first and after the
/// last of them.
class TableCurve {
 public:
  /// The function at one argument.
  struct Point {
    double integral = 0.0;  ///< from 0 on, exact
    double value = 0.0;
    double slope = 0.0;
    double second = 0.0, third = 0.0;  ///< derivatives
  };

  /// @param x, values  one point or more, x rising
  TableCurve(const std::vector<double>& x, const std::vector<double>& values,
             TableInterpolation interpolation);

  [[nodiscard]] Point calc(double x) const;
  [[nodiscard]] double next_point(double x) const;  ///< infinite behind the last
  [[nodiscard]] double next_kink(double x) const;   ///< next jump of the slope; infinite behind the last
  /// Largest distance of the points between two arguments from the straight line between the values there, by
  /// the difference of the table's largest and least value; 0 without points between them. [1]
  [[nodiscard]] double calc_bulge(double from, double to) const;

 private:
  /// From its argument to that of the next piece: v + s (a + s (b + s c)) with s the distance from x.
  struct Piece {
    double x = 0.0;
    double integral = 0.0, v = 0.0, a = 0.0, b = 0.0, c = 0.0;
    bool has_kink = false;  ///< whether the slope jumps where it begins
  };
  [[nodiscard]] static Piece make_piece(const std::vector<double>& x, const std::vector<double>& values,
                                        const std::vector<double>& slopes, std::size_t k);
  void append(Piece piece, bool is_smooth);
  [[nodiscard]] const Piece& piece_of(double x) const;

  std::vector<Piece> pieces_;  ///< the first from ever on, the others from a point each
  double range_ = 0.0;         ///< largest less least value
};

}  // namespace engine
