// SPDX-License-Identifier: Apache-2.0
#include "validation/flexibility/rods.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "validation/support/mass_matrix.h"

namespace validation {

namespace {

constexpr double kDiameter = 0.01;  // [m]
constexpr double kPi = std::numbers::pi;

/// Frames of a mechanism at q = 0, at rest.
std::vector<FrameMotion> frames_at_zero(const Mechanism& mechanism) {
  Evaluation at = MotionSystem(mechanism).make_evaluation();
  calc_frame_motions(mechanism, at.q, at.qd, at.qdd, at.frames);
  return at.frames;
}

/// The coordinates that move in one plane: rotations about its normal, translation across the rod in it.
std::vector<Eigen::Index> coordinates_in(const Mechanism& mechanism, Plane plane) {
  const Axis across = plane == Plane::kXY ? Axis::kY : Axis::kZ;
  const Axis normal = plane == Plane::kXY ? Axis::kZ : Axis::kY;
  std::vector<Eigen::Index> chosen;
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const Coordinate& c = mechanism.coordinates[i];
    if (c.axis == (c.motion == Motion::kRotation ? normal : across))
      chosen.push_back(static_cast<Eigen::Index>(i));
  }
  return chosen;
}

/// First root of f above `from`, found by steps and bisection.
template <typename Function>
double find_root_above(double from, double step, const Function& f) {
  double low = from;
  while (f(low) * f(low + step) > 0.0) low += step;
  double high = low + step;
  while (high - low > 1e-15 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (f(low) * f(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Rotary inertia of the sections over the mass, [m^2].
double radius_squared(const Rod& rod) { return 0.5 * rod.I_x / rod.mass; }

/// Rayleigh's rod: w'''' + b^4 r^2 w'' - b^4 w = 0 with b^4 = m omega^2 / (EI l), its solutions cosh,
/// sinh(alpha x), cos, sin(beta x).
struct WaveNumbers {
  double alpha, beta, k;  ///< k = b^4 r^2
};
WaveNumbers wave_numbers(double b, double r2) {
  const double b4 = std::pow(b, 4);
  const double root = std::sqrt(b4 * b4 * r2 * r2 + 4.0 * b4);
  return {std::sqrt(0.5 * (root - b4 * r2)), std::sqrt(0.5 * (root + b4 * r2)), b4 * r2};
}

/// Zero where the two conditions of a free end, w'' = 0 and w''' + k w' = 0, have a solution besides none.
double clamped_free_determinant(double b, double r2) {
  const auto [alpha, beta, k] = wave_numbers(b, r2);
  const double x = Rod::kLength;
  // w = A (cosh - cos) + B (sinh / alpha - sin / beta)
  const double moment_A = alpha * alpha * std::cosh(alpha * x) + beta * beta * std::cos(beta * x);
  const double moment_B = alpha * std::sinh(alpha * x) + beta * std::sin(beta * x);
  const double shear_A =
      alpha * (alpha * alpha + k) * std::sinh(alpha * x) - beta * (beta * beta - k) * std::sin(beta * x);
  const double shear_B = (alpha * alpha + k) * std::cosh(alpha * x) + (beta * beta - k) * std::cos(beta * x);
  return (moment_A * shear_B - moment_B * shear_A) / (std::cosh(alpha * x) * std::cosh(alpha * x));
}

/// The same for the symmetric modes of a rod free at both ends, w = A cosh + B cos from its middle.
double free_free_determinant(double b, double r2) {
  const auto [alpha, beta, k] = wave_numbers(b, r2);
  const double x = 0.5 * Rod::kLength;
  const double moment_A = alpha * alpha * std::cosh(alpha * x);
  const double moment_B = -beta * beta * std::cos(beta * x);
  const double shear_A = alpha * (alpha * alpha + k) * std::sinh(alpha * x);
  const double shear_B = beta * (beta * beta - k) * std::sin(beta * x);
  return (moment_A * shear_B - moment_B * shear_A) / std::cosh(alpha * x);
}

double frequency_of(double b, const Rod& rod) {
  return b * b * std::sqrt(Rod::EI() * Rod::kLength / rod.mass) / (2.0 * kPi);
}

double calc_rod_frequency(const Rod& rod, double r2, const BendingMode& mode) {
  if (mode.ends == Ends::kPinnedPinned) {
    const double beta = mode.number * kPi / Rod::kLength;
    return frequency_of(beta, rod) / std::sqrt(1.0 + r2 * beta * beta);
  }
  double b = 0.0;
  for (int k = 0; k < mode.number; ++k)
    b = find_root_above(b + 0.1, 0.1, [&](double at) {
      return mode.ends == Ends::kClampedFree ? clamped_free_determinant(at, r2)
                                             : free_free_determinant(at, r2);
    });
  return frequency_of(b, rod);
}

}  // namespace

double Rod::EI() { return 2.1e11 * kPi * std::pow(kDiameter, 4) / 64.0; }
double Rod::GJ() { return 0.8e11 * kPi * std::pow(kDiameter, 4) / 32.0; }

Rod solid_rod(double density) {
  const double mass = density * 0.25 * kPi * kDiameter * kDiameter * Rod::kLength;
  return {mass, 0.125 * mass * kDiameter * kDiameter};
}

Rod slender(Rod rod) {
  rod.I_x *= 1e-8;
  return rod;
}

Mechanism cut_coupler(const Rod& rod, int segments, NearEnd near_end) {
  RpsupParameters parameters;
  parameters.coupler = Coupler::kFlexible;
  parameters.rigid_elements = segments + 1;
  parameters.links[static_cast<std::size_t>(Link::k13)] = beam_inertia(rod.mass, Rod::kLength, rod.I_x);
  const Rpsup rpsup = build_rpsup(parameters);

  Mechanism cut;
  if (near_end == NearEnd::kFree)
    for (const Axis axis : {Axis::kX, Axis::kY, Axis::kZ})
      cut.coordinates.push_back({.name = "translation",
                                 .parent = static_cast<FrameIndex>(cut.coordinates.size()) - 1,
                                 .placement = {},
                                 .motion = Motion::kTranslation,
                                 .axis = axis});
  // The layout names the first element's frame, the last of its joint's three.
  const FrameIndex first = rpsup.layout.coupler - 2 + (near_end == NearEnd::kClamped ? 3 : 0);
  const FrameIndex shift = static_cast<FrameIndex>(cut.coordinates.size()) - first;
  for (FrameIndex i = first; i < rpsup.layout.coupler + 1 + 3 * segments; ++i) {
    Coordinate c = rpsup.mechanism.coordinates[static_cast<std::size_t>(i)];
    c.parent = i == first ? first + shift - 1 : c.parent + shift;
    if (i == first && near_end != NearEnd::kClamped) c.placement = {};
    cut.coordinates.push_back(c);
  }
  return cut;
}

Eigen::MatrixXd calc_mass_matrix(const Mechanism& mechanism) {
  return calc_mass_matrix(mechanism,
                          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mechanism.coordinates.size())));
}

Eigen::MatrixXd stiffness_matrix(const Mechanism& mechanism) {
  const auto n = static_cast<Eigen::Index>(mechanism.coordinates.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) K(i, i) = mechanism.coordinates[static_cast<std::size_t>(i)].stiffness;
  return K;
}

Eigen::MatrixXd calc_tip_jacobian(const Mechanism& mechanism) {
  const std::vector<FrameMotion> frames = frames_at_zero(mechanism);
  Eigen::MatrixXd J(3, static_cast<Eigen::Index>(frames.size()));
  const Eigen::Vector3d tip(Rod::kLength, 0.0, 0.0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool slides = mechanism.coordinates[i].motion == Motion::kTranslation;
    const Eigen::Vector3d& axis = frames[i].axis;
    J.col(static_cast<Eigen::Index>(i)) = slides ? axis : axis.cross(tip - frames[i].p);
  }
  return J;
}

Eigen::VectorXd calc_frequencies(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K,
                                 const Eigen::MatrixXd& constraint) {
  Eigen::MatrixXd allowed = Eigen::MatrixXd::Identity(M.rows(), M.cols());
  if (constraint.rows() > 0) allowed = constraint.fullPivLu().kernel();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(allowed.transpose() * K * allowed,
                                                                         allowed.transpose() * M * allowed);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt() / (2.0 * kPi);
}

double engine_frequency(const Rod& rod, int segments, const BendingMode& mode, Plane plane) {
  const NearEnd near_end = mode.ends == Ends::kClampedFree ? NearEnd::kClamped
                           : mode.ends == Ends::kFreeFree  ? NearEnd::kFree
                                                           : NearEnd::kSpherical;
  const Mechanism mechanism = cut_coupler(rod, segments, near_end);
  const std::vector<Eigen::Index> chosen = coordinates_in(mechanism, plane);
  const Eigen::MatrixXd M = calc_mass_matrix(mechanism)(chosen, chosen);
  const Eigen::MatrixXd K = stiffness_matrix(mechanism)(chosen, chosen);
  const Eigen::Index across = plane == Plane::kXY ? 1 : 2;
  const Eigen::MatrixXd tip = calc_tip_jacobian(mechanism).row(across)(Eigen::all, chosen);
  const Eigen::Index rigid_modes = mode.ends == Ends::kFreeFree ? 2 : 0;
  return calc_frequencies(
      M, K,
      mode.ends == Ends::kPinnedPinned ? tip : Eigen::MatrixXd(0, M.cols()))[rigid_modes + mode.number - 1];
}

double bars_frequency(const Rod& rod, int segments, const BendingMode& mode) {
  const int bars = segments + 1;
  const double spacing = Rod::kLength / segments;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(bars + 1, bars + 1);
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(bars, bars + 1);
  for (int i = 0; i < bars; ++i) {
    const double length = i == 0 || i == bars - 1 ? 0.5 * spacing : spacing;
    const double mass = rod.mass * length / Rod::kLength;
    slope(i, i) = -1.0 / length;
    slope(i, i + 1) = 1.0 / length;
    M(i, i) += mass / 3.0;
    M(i + 1, i + 1) += mass / 3.0;
    M(i, i + 1) += mass / 6.0;
    M(i + 1, i) += mass / 6.0;
    M += mass * radius_squared(rod) * slope.row(i).transpose() * slope.row(i);
  }
  const Eigen::MatrixXd bend = slope.bottomRows(bars - 1) - slope.topRows(bars - 1);
  const Eigen::MatrixXd K = Rod::EI() / spacing * bend.transpose() * bend;
  int first = 0;
  int last = bars;
  if (mode.ends == Ends::kClampedFree) first = 2;
  if (mode.ends == Ends::kPinnedPinned) {
    first = 1;
    last = bars - 1;
  }
  const int n = last - first + 1;
  const int rigid_modes = mode.ends == Ends::kFreeFree ? 2 : 0;
  return calc_frequencies(M.block(first, first, n, n), K.block(first, first, n, n),
                          Eigen::MatrixXd(0, n))[rigid_modes + mode.number - 1];
}

double rayleigh_frequency(const Rod& rod, const BendingMode& mode) {
  return calc_rod_frequency(rod, radius_squared(rod), mode);
}
double euler_bernoulli_frequency(const Rod& rod, const BendingMode& mode) {
  return calc_rod_frequency(rod, 0.0, mode);
}

}  // namespace validation
