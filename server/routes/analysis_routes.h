// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/context/request_context.h"

namespace server {

// Analyses of the results of sweeps and of the trajectories of jobs, run for each request.

[[nodiscard]] Response get_sensitivity(const RequestContext& context);
[[nodiscard]] Response get_surrogate(const RequestContext& context);
[[nodiscard]] Response get_flexibility(const RequestContext& context);
[[nodiscard]] Response get_paper(const RequestContext& context);
[[nodiscard]] Response get_bifurcation(const RequestContext& context);
[[nodiscard]] Response get_lyapunov(const RequestContext& context);
[[nodiscard]] Response get_report(const RequestContext& context);
[[nodiscard]] Response get_spectrum(const RequestContext& context);
[[nodiscard]] Response get_poincare(const RequestContext& context);
[[nodiscard]] Response get_wear(const RequestContext& context);

}  // namespace server
