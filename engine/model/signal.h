// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "engine/model/drive_law.h"
#include "engine/model/table_curve.h"

namespace engine {

/// The same at all times.
struct Constant {
  double value = 0.0;
};

/// A force, torque or voltage as a function of one variable. Of a Harmonic the variable is time.
using Signal = std::variant<Constant, Harmonic, TableCurve>;

/// A signal at one value of its variable.
struct SignalPoint {
  double value = 0.0;
  double slope = 0.0;
};

[[nodiscard]] SignalPoint calc_signal(const Signal& signal, double at);

/// First value of the variable after `at` where the slope jumps; infinite if none follows.
[[nodiscard]] double find_next_kink(const Signal& signal, double at);

}  // namespace engine
