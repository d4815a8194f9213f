// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace engine {

/// Coefficients of RODAS5(4) in the form of a Rosenbrock method that needs no product with the Jacobian,
/// stage i = 1 ... s, J and f_t at (t, y):
///
///     (1 / (gamma dt) - J) U_i = f(t + c_i dt, y + sum_j<i a_ij U_j) + sum_j<i (C_ij / dt) U_j + d_i dt f_t
///
/// The last stages and the result end at t + dt, each the stage before plus its own U: row i + 1 of a is (row
/// i, 1), and m is (the last row, 1). So the embedded result, of an order less, is the last stage's argument,
/// and the last U is the estimate of the error.
///
/// Source: G. A. Di Marzo, RODAS5(4): Methodes de Rosenbrock d'ordre 5(4) adaptees aux problemes
/// differentiels-algebriques (Geneva, 1993).
struct Rodas5Coefficients {
  static constexpr unsigned short kOrder = 5;
  static constexpr std::size_t kStages = 8;
  /// The first stage, from 0, that is the one before plus its U.
  static constexpr std::size_t kFirstExtended = 6;
  using Row = std::array<double, kStages - 1>;

  static constexpr double gamma = 0.19;
  static constexpr std::array<double, kStages> c{
      0.0, 0.38, 0.3878509998321533, 0.4839718937873840, 0.4570477008819580, 1.0, 1.0, 1.0};
  static constexpr std::array<double, kStages> d{
      0.19, -0.1823079225333714636, -0.319231832186874912, 0.3449828624725343, -0.377417564392089818,
      0.0, 0.0, 0.0};
  static constexpr std::array<Row, kStages> a{{
      {},
      {2.0},
      {3.040894194418781, 1.041747909077569},
      {2.576417536461461, 1.622083060776640, -0.9089668560264532},
      {2.760842080225597, 1.446624659844071, -0.3036980084553738, 0.2877498600325443},
      {-14.09640773051259, 6.925207756232704, -41.47510893210728, 2.343771018586405, 24.13215229196062},
      {-14.09640773051259, 6.925207756232704, -41.47510893210728, 2.343771018586405, 24.13215229196062, 1.0},
      {-14.09640773051259, 6.925207756232704, -41.47510893210728, 2.343771018586405, 24.13215229196062, 1.0,
       1.0},
  }};
  static constexpr std::array<Row, kStages> C{{
      {},
      {-10.31323885133993},
      {-21.04823117650003, -7.234992135176716},
      {32.22751541853323, -4.943732386540191, 19.44922031041879},
      {-20.69865579590063, -8.816374604402768, 1.260436877740897, -0.7495647613787146},
      {-46.22004352711257, -17.49534862857472, -289.6389582892057, 93.60855400400906, 318.3822534212147},
      {34.20013733472935, -14.15535402717690, 57.82335640988400, 25.83362985412365, 1.408950972071624,
       -6.551835421242162},
      {42.57076742291101, -13.80770672017997, 93.98938432427124, 18.77919633714503, -31.58359187223370,
       -6.685968952921985, -5.810979938412932},
  }};
};

}  // namespace engine
