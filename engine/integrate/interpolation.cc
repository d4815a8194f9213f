// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/interpolation.h"

#include "engine/math/quintic.h"

namespace engine {

void interpolate_state(const StepEnd& start, const StepEnd& end, Eigen::Index n, double s, Eigen::VectorXd& y) {
  const double dt = end.t - start.t;
  y.resize(start.y.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const Quintic q(dt, start.y[i], start.y[n + i], start.f[n + i], end.y[i], end.y[n + i], end.f[n + i]);
    y[i] = q.value(s);
    y[n + i] = q.rate(s);
  }
  const double s2 = s * s;
  const double s3 = s2 * s;
  for (Eigen::Index i = 2 * n; i < y.size(); ++i)
    y[i] = (2.0 * s3 - 3.0 * s2 + 1.0) * start.y[i] + (3.0 * s2 - 2.0 * s3) * end.y[i] + dt * ((s3 - 2.0 * s2 + s) * start.f[i] + (s3 - s2) * end.f[i]);
}

}  // namespace engine
