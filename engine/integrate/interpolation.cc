#include "engine/integrate/interpolation.h"

namespace engine {

void interpolate_state(const StepEnd& start, const StepEnd& end, Eigen::Index n, double s, Eigen::VectorXd& y) {
  const double dt = end.t - start.t;
  y.resize(start.y.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    // q(s) = q0 + v0 s + a0 s^2 / 2 + s^3 (c3 + s (c4 + s c5)), in units of the step
    const double v0 = dt * start.y[n + i];
    const double v1 = dt * end.y[n + i];
    const double a0 = dt * dt * start.f[n + i];
    const double a1 = dt * dt * end.f[n + i];
    const double d = end.y[i] - start.y[i] - v0 - 0.5 * a0;
    const double dv = v1 - v0 - a0;
    const double da = a1 - a0;
    const double c3 = 10.0 * d - 4.0 * dv + 0.5 * da;
    const double c4 = -15.0 * d + 7.0 * dv - da;
    const double c5 = 6.0 * d - 3.0 * dv + 0.5 * da;
    y[i] = start.y[i] + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))));
    y[n + i] = (v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / dt;
  }
  const double s2 = s * s;
  const double s3 = s2 * s;
  for (Eigen::Index i = 2 * n; i < y.size(); ++i)
    y[i] = (2.0 * s3 - 3.0 * s2 + 1.0) * start.y[i] + (3.0 * s2 - 2.0 * s3) * end.y[i] + dt * ((s3 - 2.0 * s2 + s) * start.f[i] + (s3 - s2) * end.f[i]);
}

}  // namespace engine
