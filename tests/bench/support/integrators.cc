// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/support/integrators.h"

#include "jobs/parameters/parameter_table.h"

namespace bench {

std::vector<NamedIntegrator> all_integrators() {
  const jobs::ParameterInfo& parameter = *jobs::find_parameter("integrator");
  std::vector<NamedIntegrator> all;
  for (const std::string_view word : parameter.choices) {
    jobs::JobSpec spec;
    parameter.write(spec, std::string(word));
    if (spec.options.integrator != engine::Integrator::kAuto)
      all.push_back({std::string(word), spec.options.integrator});
  }
  return all;
}

}  // namespace bench
