// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/integrate/observer.h"
#include "validation/engine_names.h"

namespace validation {

/// An observer that asks for nothing: for those who want one of its calls.
class QuietObserver : public Observer {
 public:
  void on_step(const Evaluation& /*start*/, const Evaluation& /*end*/) override {}
  void on_sample(const Evaluation& /*at*/) override {}
  void on_onsets(int /*rings*/, int /*faces*/) override {}
  [[nodiscard]] bool stop_requested(double /*t*/) override { return false; }
};

}  // namespace validation
