// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/clearance_parameters.h"
#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"
#include "validation/engine_names.h"

namespace validation {

/// The joint of the study at a clearance of 0.25 mm as one frictionless ring of stiffness K, its faces out of
/// reach.
[[nodiscard]] ClearanceParameters one_ring(double c_r = 0.25e-3);

/// A mass on a slide along x, without gravity. It carries the journal; the bearing is on the ground, its axis
/// through the slide's zero.
/// @param mass    [kg]
/// @param turned  angle of the journal's x axis, where the first element of a ring is, from the direction of
/// motion, [rad]
[[nodiscard]] Mechanism make_sliding_mass(const ClearanceParameters& joint, double mass, double turned = 0.0);

/// One contact of a sliding mass with the bore, from the first touch to the parting.
struct Impact {
  double onset_time = 0.0;    ///< [s]
  double contact_time = 0.0;  ///< [s]
  double depth = 0.0;         ///< largest, of the journal's centre beyond the clearance, [m]
  double force = 0.0;         ///< largest at the end of a step, [N]
  double speed = 0.0;         ///< after parting, [m/s]
  double loss = 0.0;          ///< the energy account's impact loss, [J]
};

/// Error-controlled steps whose error is not to be seen.
inline constexpr RunOptions kTightSteps{
    .integrator = Integrator::kDopri5, .relative_tolerance = 1e-13, .absolute_tolerance = 1e-16};

/// Lets the mass run at the bore from a gap and follows it until it has parted.
/// @param gap        at the start, [m]
/// @param v0         [m/s]
/// @param contact    about how long the contact lasts, [s]
/// @param steps      how to integrate; the duration is decided here
/// @throws std::runtime_error if it does not part within three times that
[[nodiscard]] Impact simulate_impact(const Mechanism& sliding_mass, double gap, double v0, double contact,
                                     RunOptions steps = kTightSteps);

/// Time of an elastic contact with f = K delta^1.5: 2.94328 delta_max / v0 with delta_max = (5 m v0^2 / (4
/// K))^(2/5). [s]
[[nodiscard]] double calc_hertz_time(double K, double mass, double v0);

/// The number 2.94328 in it: 2 * integral of dx / sqrt(1 - x^2.5) from 0 to 1 = 0.8 Gamma(2/5) Gamma(1/2) /
/// Gamma(9/10).
[[nodiscard]] double hertz_time_factor();

/// Stiffness of Hertz's contact of two spheres, K = 4/3 E* sqrt(R), 1/E* = 2 (1 - nu^2) / E, 1/R = 1/r_j -
/// 1/r_b. [N/m^1.5]
[[nodiscard]] double hertz_stiffness(double r_b, double c_r, double youngs_modulus, double nu);

/// Restitution of f = f_e (1 + c rate / v0): the root of c (1 + e) = ln((1 + c) / (1 - c e)), whatever f_e
/// and the mass.
[[nodiscard]] double rebound_ratio(double c);

}  // namespace validation
