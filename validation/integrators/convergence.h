// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "validation/engine_names.h"
#include "validation/support/quiet_observer.h"

namespace validation {

/// Errors of a method at steps (or tolerances) that become finer.
struct Ladder {
  std::vector<double> steps, errors;

  void add(double step, double error) {
    steps.push_back(step);
    errors.push_back(error);
  }
  /// By the two finest.
  [[nodiscard]] double observed_order() const {
    const std::size_t n = steps.size();
    return std::log(errors[n - 2] / errors[n - 1]) / std::log(steps[n - 2] / steps[n - 1]);
  }
};

/// The last state of a run.
class LastState : public QuietObserver {
 public:
  void on_step(const Evaluation& /*start*/, const Evaluation& end) override { q = end.q; }
  Eigen::VectorXd q;
};

}  // namespace validation
