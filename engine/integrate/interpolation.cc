// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/interpolation.h"

#include "engine/math/quintic.h"

namespace engine {

void interpolate_state(const StepPoint& start, const StepPoint& end, const StateLayout& layout, double s,
                       Eigen::VectorXd& y) {
  const double dt = end.t - start.t;
  y.resize(start.y.size());
  for (int k = 0; k < layout.free; ++k) {
    const int i = layout.q(k), v = layout.v(k);
    const Quintic q(dt, start.y[i], start.y[v], start.f[v], end.y[i], end.y[v], end.f[v]);
    y[i] = q.value(s);
    y[v] = q.rate(s);
  }
  const double s2 = s * s;
  const double s3 = s2 * s;
  for (Eigen::Index i = layout.bristle(); i < y.size(); ++i)
    y[i] = (2.0 * s3 - 3.0 * s2 + 1.0) * start.y[i] + (3.0 * s2 - 2.0 * s3) * end.y[i] +
           dt * ((s3 - 2.0 * s2 + s) * start.f[i] + (s3 - s2) * end.f[i]);
}

}  // namespace engine
