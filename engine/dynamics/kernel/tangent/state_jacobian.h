// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

#include "engine/dynamics/state_layout.h"
#include "engine/math/buffer.h"
#include "engine/math/number_rows.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The Jacobian J = df/dy of MotionSystem's state equation: its blocks that are not known beforehand, Eq.
/// (K23).
///
/// Outputs (accelerations of the free coordinates, powers of works) and rates of the acting bristles are
/// differentiated by free coordinates, their rates, acting bristles and time. The other blocks are trivial:
/// dq/dt = v, a pair of bristles (one contact point) depends on no other pair, and nothing depends on works.
///
/// A column holds the derivatives of all outputs by one seed: accelerations from row 0 on, powers from row
/// first_work on. Each of the two parts is padded with zeros to whole blocks, the second one to at least two:
/// so that most mechanisms have as many.
struct StateJacobian {
  /// Rows that are computed at once.
  static constexpr int kBlock = kRowBlock;
  static constexpr int kFewestWorks = 2 * kBlock;  ///< rows for powers
  [[nodiscard]] static constexpr int in_blocks(int numbers) { return in_row_blocks(numbers); }

  explicit StateJacobian(const StateLayout& of)
      : layout(of),
        free(of.free),
        bristles(of.bristles),
        works(of.works()),
        first_work(in_blocks(free)),
        stride(first_work + std::max(kFewestWorks, in_blocks(works))),
        pair_stride(in_blocks(bristles / 2 + 1)),
        acting(bristles),
        by_t(stride),
        rates_by_t(2 * pair_stride) {}

  /// The blocks by q, v and bristles: large with many coordinates, and needed by NewtonMatrix only.
  struct Matrices {
    explicit Matrices(const StateJacobian& J)
        : by_q(area(J.free, J.stride)),
          by_v(area(J.free, J.stride)),
          by_bristle(area(J.bristles, J.stride)),
          rates_by_q(area(2 * J.free, J.pair_stride)),
          rates_by_v(area(2 * J.free, J.pair_stride)),
          rates_by_bristle(area(4, J.pair_stride)) {}

    [[nodiscard]] static std::size_t area(int rows, int columns) {
      return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    }

    Buffer<double> by_q, by_v;    ///< a column for each free coordinate
    Buffer<double> by_bristle;    ///< a column for each acting bristle
    // Of the bristles' rates: a row of the first bristles of all pairs, then one of the second
    Buffer<double> rates_by_q, rates_by_v;  ///< free coordinates x 2 x pair_stride
    /// 2 x 2 x pair_stride: of the first by the first, of the first by the second, of the second ...
    Buffer<double> rates_by_bristle;
  };
  void make_matrices() {
    if (!matrices) matrices = std::make_unique<Matrices>(*this);
  }

  /// Writes df/dt, one entry a state.
  void write_time_derivative(double* to) const {
    for (int i = 0; i < free; ++i) {
      to[layout.q(i)] = 0.0;
      to[layout.v(i)] = by_t[i];
    }
    for (int b = 0; b < bristles; ++b) to[layout.bristle(b)] = 0.0;
    for (int i = 0; i < 2 * pairs; ++i)
      to[layout.bristle(acting[i])] =
          rates_by_t[i % 2 * pair_stride + i / 2];
    for (int k = 0; k < works; ++k) to[layout.work(k)] = by_t[first_work + k];
  }

  StateLayout layout;
  int free, bristles, works;  ///< numbers of them
  int first_work;             ///< row of the first work
  int stride;                 ///< from one column to the next
  int pair_stride;            ///< padded, for at least one pair more than there are
  int pairs = 0;              ///< pairs of bristles that act
  Buffer<int> acting;         ///< indices among all bristles, pair by pair
  Buffer<double> by_t;        ///< a column
  Buffer<double> rates_by_t;  ///< 2 x pair_stride
  std::unique_ptr<Matrices> matrices;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
