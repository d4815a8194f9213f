// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>

namespace engine {

/// The Radau IIA method of order 5: collocation at three points, the last of them the step's end. With A its
/// matrix and T as here, T^-1 A^-1 T = diag(shift; the block of re -im, im re of complex_shift): what couples
/// the three stages becomes one real and one complex system of the state's size. Source: E. Hairer, G.
/// Wanner, Solving Ordinary Differential Equations II, sections IV.5 and IV.8.
struct RadauCoefficients {
  static constexpr std::size_t kStages = 3;
  using Row = std::array<double, kStages>;

  static constexpr Row c{0.15505102572168219018, 0.64494897427831780982, 1.0};
  static constexpr double shift = 3.6378342527444957322;
  static constexpr std::complex<double> complex_shift{2.6810828736277521339, 3.0504301992474105694};
  static constexpr std::array<Row, kStages> T{{
      {0.091232394870892942792, -0.14125529502095420843, -0.030029194105147424492},
      {0.24171793270710701896, 0.20412935229379993199, 0.38294211275726193779},
      {0.96604818261509293619, 1.0, 0.0},
  }};
  static constexpr std::array<Row, kStages> T_inverse{{
      {4.3255798900631553510, 0.33919925181580986954, 0.54177053993587487119},
      {-4.1787185915519047273, -0.32768282076106238708, 0.47662355450055045196},
      {-0.50287263494578687595, 2.5719269498556054292, -0.59603920482822492497},
  }};
  /// The difference from an embedded method of order 3 is (shift / dt - J)^-1 (f at the start + (error .
  /// Z) / dt).
  static constexpr Row error{-10.048809399827415562, 1.3821427331607488958, -0.33333333333333333333};
};

}  // namespace engine
