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

/// First point of a table after `at`; infinite if none follows. Steps end there: a longer one could pass by
/// what is between.
[[nodiscard]] double find_next_point(const Signal& signal, double at);

}  // namespace engine
