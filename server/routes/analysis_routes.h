// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/routing/call.h"

namespace server {

// What is worked out of the results of sweeps and the trajectories of jobs when it is asked for.

[[nodiscard]] Response get_sensitivity(const Call& call);
[[nodiscard]] Response get_surrogate(const Call& call);
[[nodiscard]] Response get_flexibility(const Call& call);
[[nodiscard]] Response get_paper(const Call& call);
[[nodiscard]] Response get_bifurcation(const Call& call);
[[nodiscard]] Response get_lyapunov(const Call& call);
[[nodiscard]] Response get_report(const Call& call);
[[nodiscard]] Response get_spectrum(const Call& call);
[[nodiscard]] Response get_poincare(const Call& call);
[[nodiscard]] Response get_wear(const Call& call);

}  // namespace server
