// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/model/run_options.h"

namespace bench {

/// An integrator by the word that users know it by.
struct NamedIntegrator {
  std::string name;
  engine::Integrator integrator;

  [[nodiscard]] bool has_fixed_step() const { return integrator == engine::Integrator::kRk4; }
};

/// Every integrator that a job may ask for.
[[nodiscard]] std::vector<NamedIntegrator> all_integrators();

}  // namespace bench
