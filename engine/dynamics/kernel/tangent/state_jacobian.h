// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

#include "engine/math/buffer.h"
#include "engine/math/number_rows.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The Jacobian J of MotionSystem's state equation, as far as it is not known beforehand: derivatives of the outputs (accelerations of the free
/// coordinates, rates of work and loss) and of the rates of the acting bristles, by the free coordinates, their rates, time and the acting
/// bristles. Coordinates follow their rates, each pair of bristles, which are those of one touch, answers itself and the coordinates alone, and
/// nothing depends on works and losses.
///
/// The outputs' derivatives by one thing are a column: accelerations from row 0 on, works and losses from row first_work on, each in whole blocks of
/// which the rest is zero, the second in no fewer than two: so that most mechanisms have as many.
struct StateJacobian {
  /// Numbers that are taken at once.
  static constexpr int kBlock = kRowBlock;
  static constexpr int kFewestWorks = 2 * kBlock;  ///< that there is room for
  [[nodiscard]] static constexpr int in_blocks(int numbers) { return in_row_blocks(numbers); }

  StateJacobian(int free_coordinates, int bristle_count, int drives)
      : free(free_coordinates),
        bristles(bristle_count),
        works(drives + 3),
        first_work(in_blocks(free)),
        stride(first_work + std::max(kFewestWorks, in_blocks(works))),
        pair_stride(in_blocks(bristles / 2 + 1)),
        acting(static_cast<std::size_t>(bristles)),
        by_t(static_cast<std::size_t>(stride)),
        rates_by_t(static_cast<std::size_t>(2 * pair_stride)) {}

  /// What solving with a matrix needs: of many coordinates it takes much room.
  struct Matrices {
    explicit Matrices(const StateJacobian& J)
        : by_q(area(J.free, J.stride)),
          by_v(area(J.free, J.stride)),
          by_bristle(area(J.bristles, J.stride)),
          rates_by_q(area(2 * J.free, J.pair_stride)),
          rates_by_v(area(2 * J.free, J.pair_stride)),
          rates_by_own(area(4, J.pair_stride)) {}

    [[nodiscard]] static std::size_t area(int rows, int columns) { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }

    Buffer<double> by_q, by_v;    ///< a column for each free coordinate
    Buffer<double> by_bristle;    ///< a column for each acting bristle
    // Of the bristles' rates, pair by pair: first those of the first bristle of each pair, then of the second
    Buffer<double> rates_by_q, rates_by_v;  ///< free coordinates x 2 x pair_stride
    Buffer<double> rates_by_own;            ///< 2 x 2 x pair_stride: of the first by the first, of the first by the second, of the second ...
  };
  void make_matrices() {
    if (!matrices) matrices = std::make_unique<Matrices>(*this);
  }

  /// df/dt of a state as MotionSystem has it.
  void write_time_derivative(double* to) const {
    for (int i = 0; i < free; ++i) {
      to[i] = 0.0;
      to[free + i] = by_t[static_cast<std::size_t>(i)];
    }
    to += 2 * free;
    for (int b = 0; b < bristles; ++b) to[b] = 0.0;
    for (int i = 0; i < 2 * pairs; ++i) to[acting[static_cast<std::size_t>(i)]] = rates_by_t[static_cast<std::size_t>(i % 2 * pair_stride + i / 2)];
    to += bristles;
    for (int k = 0; k < works; ++k) to[k] = by_t[static_cast<std::size_t>(first_work + k)];
  }

  int free, bristles, works;
  int first_work;             ///< row of the first work
  int stride;                 ///< from one column to the next
  int pair_stride;            ///< with room for one pair more than there are
  int pairs = 0;              ///< pairs of bristles that act
  Buffer<int> acting;         ///< which bristles, by their place among all: those of the first pair, then the others
  Buffer<double> by_t;        ///< a column
  Buffer<double> rates_by_t;  ///< 2 x pair_stride
  std::unique_ptr<Matrices> matrices;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
