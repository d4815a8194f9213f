// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "validation/engine_names.h"

namespace validation {

/// A function of time near one instant, as its Taylor polynomial of degree 6: sums, products and functions of
/// such polynomials carry all derivatives along, exact but for rounding.
class Taylor {
 public:
  static constexpr std::size_t kTerms = 7;

  Taylor() = default;
  Taylor(double constant) { c_[0] = constant; }  // NOLINT: numbers are constant functions

  /// The function f(t) = t at an instant.
  [[nodiscard]] static Taylor time(double t) {
    Taylor x(t);
    x.c_[1] = 1.0;
    return x;
  }

  /// Its derivative of some order, 0 to 6, at the instant.
  [[nodiscard]] double derivative(std::size_t order) const {
    double factorial = 1.0;
    for (std::size_t k = 2; k <= order; ++k) factorial *= static_cast<double>(k);
    return factorial * c_[order];
  }
  [[nodiscard]] double value() const { return c_[0]; }

  friend Taylor operator+(const Taylor& a, const Taylor& b) {
    Taylor sum;
    for (std::size_t k = 0; k < kTerms; ++k) sum.c_[k] = a.c_[k] + b.c_[k];
    return sum;
  }
  friend Taylor operator-(const Taylor& a, const Taylor& b) { return a + (-1.0) * b; }
  friend Taylor operator*(double s, const Taylor& a) {
    Taylor scaled;
    for (std::size_t k = 0; k < kTerms; ++k) scaled.c_[k] = s * a.c_[k];
    return scaled;
  }
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    Taylor product;
    for (std::size_t k = 0; k < kTerms; ++k)
      for (std::size_t i = 0; i <= k; ++i) product.c_[k] += a.c_[i] * b.c_[k - i];
    return product;
  }
  friend Taylor operator/(const Taylor& a, const Taylor& b) {
    Taylor quotient;
    for (std::size_t k = 0; k < kTerms; ++k) {
      double rest = a.c_[k];
      for (std::size_t i = 0; i < k; ++i) rest -= quotient.c_[i] * b.c_[k - i];
      quotient.c_[k] = rest / b.c_[0];
    }
    return quotient;
  }
  friend Taylor sqrt(const Taylor& a) {
    Taylor root(std::sqrt(a.c_[0]));
    for (std::size_t k = 1; k < kTerms; ++k) {
      double rest = a.c_[k];
      for (std::size_t i = 1; i < k; ++i) rest -= root.c_[i] * root.c_[k - i];
      root.c_[k] = 0.5 * rest / root.c_[0];
    }
    return root;
  }
  friend Taylor sin(const Taylor& a) { return sine_and_cosine(a)[0]; }
  friend Taylor cos(const Taylor& a) { return sine_and_cosine(a)[1]; }

 private:
  /// From s' = a' c and c' = -a' s, term by term.
  static std::array<Taylor, 2> sine_and_cosine(const Taylor& a) {
    Taylor s(std::sin(a.c_[0]));
    Taylor c(std::cos(a.c_[0]));
    for (std::size_t k = 1; k < kTerms; ++k) {
      for (std::size_t i = 1; i <= k; ++i) {
        const double weight = static_cast<double>(i) / static_cast<double>(k) * a.c_[i];
        s.c_[k] += weight * c.c_[k - i];
        c.c_[k] -= weight * s.c_[k - i];
      }
    }
    return {s, c};
  }

  std::array<double, kTerms> c_{};  ///< c_[k] = k-th derivative / k!
};

}  // namespace validation
