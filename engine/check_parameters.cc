// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>

#include "engine/errors.h"
#include "engine/model/rpsup_geometry.h"
#include "engine/simulate_rpsup.h"

namespace engine {

namespace {

constexpr double kStart = 1e-9;  // the part of a run that tells its start, [s]

constexpr double kMostWear = 0.1;  ///< over the bearing's radius: what a shallow depth is

std::string to_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Written so that not-a-number fails as well.
void require_positive(double value, const std::string& field) {
  require(value > 0.0 && std::isfinite(value), field, "a finite number above 0");
}
void require_not_negative(double value, const std::string& field) {
  require(value >= 0.0 && std::isfinite(value), field, "a finite number of at least 0");
}
void require_finite(double value, const std::string& field) {
  require(std::isfinite(value), field, "a finite number");
}

/// Moments of a body obey I_x <= I_y + I_z and its turns, about any point.
bool is_inertia_of_a_body(const Eigen::Vector3d& I) {
  const double rounding = 1e-12 * I.sum();
  return (I.array() > 0.0).all() && (I.sum() - 2.0 * I.maxCoeff() >= -rounding);
}

/// Along which of its axes a link lies: x, but for the cross link.
bool is_along_z(std::size_t link) { return link == static_cast<std::size_t>(Link::k22); }

/// @param length  of the link: its centre of mass is in the middle
void check_inertia(const LinkInertia& link, double length, bool lies_along_z, const std::string& field) {
  require(link.inertia.allFinite() && is_inertia_of_a_body(link.inertia), field,
          "three moments above 0, none of them larger than the sum of the other two");
  const double steiner = link.mass * 0.25 * length * length;
  const Eigen::Vector3d along = lies_along_z ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  require(is_inertia_of_a_body(link.inertia - steiner * (Eigen::Vector3d::Ones() - along)), field,
          "those of a body about its frame's origin: about the centre of mass, at " +
              std::string(lies_along_z ? "z" : "x") + " = " + to_text(0.5 * length) +
              " m, they break I_x <= I_y + I_z or are not above 0");
}

void check_links(const RpsupParameters& p) {
  static constexpr std::array<const char*, kLinkCount> names{"1,1", "1,2", "1,3", "2,1", "2,2"};
  const std::array<double, kLinkCount> lengths{p.crank_length, p.rod_length, p.coupler_length, 0.0,
                                               p.cross_length};
  for (std::size_t k = 0; k < kLinkCount; ++k) {
    const std::string name = std::string("links.") + names[k];
    require_positive(p.links[k].mass, name + ".mass");
    check_inertia(p.links[k], lengths[k], is_along_z(k), name + ".inertia");
  }
}

void check_geometry(const RpsupParameters& p) {
  require_positive(p.crank_length, "crank_length");
  require_positive(p.rod_length, "rod_length");
  require_positive(p.coupler_length, "coupler_length");
  require_not_negative(p.cross_length, "cross_length");
  require_finite(p.guide_offset_y, "guide_offset_y");
  require_finite(p.guide_offset_z, "guide_offset_z");
  require_finite(p.guide_angle, "guide_angle");
  require_finite(p.rod_start, "rod_start");
  require_finite(p.gravity, "gravity");
}

void check_coupler(const RpsupParameters& p) {
  require(p.rigid_elements >= 2, "rigid_elements", "at least 2");
  require_positive(p.youngs_modulus, "youngs_modulus");
  require_positive(p.shear_modulus, "shear_modulus");
  const double nu = p.youngs_modulus / (2.0 * p.shear_modulus) - 1.0;
  require(nu > -1.0 && nu <= 0.5, "shear_modulus",
          "such that Poisson's ratio E / (2 G) - 1 lies in (-1, 0.5]; it is " + to_text(nu));
  require_positive(p.coupler_diameter, "coupler_diameter");
  require_not_negative(p.coupler_damping_ratio, "coupler_damping_ratio");
}

void check_round_link(const RoundLink& link, const std::string& name) {
  require_positive(link.diameter, name + ".diameter");
  require_not_negative(link.inner_diameter, name + ".inner_diameter");
  require(link.inner_diameter < link.diameter, name + ".inner_diameter",
          "below the outer diameter of " + to_text(1e3 * link.diameter) + " mm");
  require(link.elements >= 2, name + ".elements", "at least 2");
  require_not_negative(link.damping_ratio, name + ".damping_ratio");
}

void check_other_links(const RpsupParameters& p) {
  check_round_link(p.crank, "crank");
  check_round_link(p.rod, "rod");
  check_round_link(p.cross, "cross");
  require(p.cross.model == LinkModel::kRigid || p.cross_length > 0.0, "cross_length",
          "above 0, as the cross link is flexible");
}

void check_drives(const RpsupParameters& p) {
  require_finite(p.crank_velocity, "crank_velocity");
  require_finite(p.crank_start, "crank_start");
  require_not_negative(p.run_up, "run_up");
  require_finite(p.rod_stroke, "rod_stroke");
  require_positive(p.rod_stroke_time, "rod_stroke_time");
  require_not_negative(p.rod_pause, "rod_pause");
  require_not_negative(p.baumgarte_alpha, "baumgarte_alpha");
  require_not_negative(p.baumgarte_beta, "baumgarte_beta");
}

void check_friction(const RpsupParameters& p) {
  require_positive(p.mu_s, "mu_s");
  require_positive(p.mu_k, "mu_k");
  require_not_negative(p.sigma_0, "sigma_0");
  require_not_negative(p.sigma_1, "sigma_1");
  require_not_negative(p.sigma_2, "sigma_2");
  require_positive(p.v_s, "v_s");
  require(p.break_away >= 0.0 && p.break_away < 1.0, "break_away", "at least 0 and below 1");
  require_positive(p.v_0, "v_0");
  require_positive(p.v_1, "v_1");
  require(p.friction != FrictionLaw::kAmbrosio || p.v_1 > p.v_0, "v_1",
          "above friction_velocity_0_m_s, " + to_text(p.v_0) + " m/s");
}

/// @param sectors  of each ring  @param most  the deepest wear, [m]
void check_ring_wear(const std::vector<double>& ring, std::size_t sectors, double most) {
  require(ring.size() >= 3 && ring.size() == sectors, "wear_depth",
          "one list a ring, all of the same number of sectors, at least three");
  for (const double depth : ring)
    require(
        depth >= 0.0 && depth <= most, "wear_depth",
        "shallow: at least 0 and at most a tenth of the bearing radius, " + to_text(1e6 * most) + " um");
}

void check_wear(const RpsupParameters& p) {
  if (p.wear_depth.empty()) return;
  require(p.c_r > 0.0, "wear_depth", "left out for the ideal joint, which has no bore to wear");
  require(p.contact == ContactForm::kContinuum, "wear_depth",
          "left out for contact elements: a worn bore is for contact continuum");
  require(p.wear_depth.size() == static_cast<std::size_t>(p.radial_levels), "wear_depth",
          "one list for each of the rings, " + std::to_string(p.radial_levels));
  const double most = kMostWear * p.bearing_radius;
  for (const std::vector<double>& ring : p.wear_depth)
    check_ring_wear(ring, p.wear_depth.front().size(), most);
}

void check_contact_force(const RpsupParameters& p) {
  require(p.restitution >= 0.0 && p.restitution <= 1.0, "restitution", "at least 0 and at most 1");
  require(p.restitution > 0.0 || has_zero_restitution(p.normal_law), "restitution",
          "above 0 with gonthier, flores or hu_guo, whose damping grows without bound there");
  require_positive(p.contact_stiffness_scale, "contact_stiffness_scale");
  require_not_negative(p.axial_stiffness, "axial_stiffness");
  require_positive(p.minimum_impact_velocity, "minimum_impact_velocity");
  require_not_negative(p.contact_damping, "contact_damping");
  require(p.stiffness_law == StiffnessLaw::kHertz || p.contact == ContactForm::kContinuum, "stiffness_law",
          "hertz for contact elements: the others are laws of a whole ring");
}

void check_joint(const RpsupParameters& p) {
  require_positive(p.bearing_radius, "bearing_radius");
  require_positive(p.bearing_length, "bearing_length");
  require(p.c_r >= 0.0 && p.c_r < p.bearing_radius, "c_r",
          "at least 0 and below the bearing radius of " + to_text(1e3 * p.bearing_radius) + " mm");
  require_not_negative(p.c_a, "c_a");
  require(p.radial_levels >= 1, "radial_levels", "at least 1");
  require(p.radial_elements >= 3, "radial_elements", "at least 3");
  require(p.axial_levels >= 1, "axial_levels", "at least 1");
  require(p.axial_elements >= 3, "axial_elements", "at least 3");
  check_contact_force(p);
  check_friction(p);
  check_wear(p);
}

void check_options(const RunOptions& options) {
  require_positive(options.duration, "duration");
  require_positive(options.output_rate, "output_rate");
  require_positive(options.step, "step");
  require_positive(options.relative_tolerance, "relative_tolerance");
  require_positive(options.absolute_tolerance, "absolute_tolerance");
}

/// Bounds of a drive's motion: of its position, but for what it does between 2001 instants of the run at more
/// than its largest rate there.
struct MotionBounds {
  double low, high, rate;
};
MotionBounds calc_bounds(const DriveLaw& law, double duration) {
  constexpr int kInstants = 2000;
  const DrivenMotion first = calc_driven_motion(law, 0.0);
  MotionBounds bounds{first.q, first.q, std::max(std::abs(first.qd), 1e-9)};
  for (int k = 1; k <= kInstants; ++k) {
    const DrivenMotion at = calc_driven_motion(law, duration * k / kInstants);
    bounds.low = std::min(bounds.low, at.q);
    bounds.high = std::max(bounds.high, at.q);
    bounds.rate = std::max(bounds.rate, std::abs(at.qd));
  }
  const double between = 0.5 * bounds.rate * duration / kInstants;
  return {bounds.low - between, bounds.high + between, bounds.rate};
}

/// Largest distance of the S joint from the crank's axis.
double calc_farthest_rod(const RpsupParameters& p, double duration) {
  if (p.rod_actuator) return std::abs(p.rod_start);
  if (p.rod_drive) {
    const MotionBounds bounds = calc_bounds(*p.rod_drive, duration);
    return std::max(std::abs(p.rod_length + bounds.low), std::abs(p.rod_length + bounds.high));
  }
  return std::max(std::abs(p.rod_start), std::abs(p.rod_start + p.rod_stroke));
}

/// True if the coupler reaches the guide for whatever crank angle and rod position: no need to look at
/// instants then.
bool reaches_always(const RpsupParameters& p, double duration) {
  const double most = calc_farthest_rod(p, duration);
  const double y = most + std::abs(p.guide_offset_y);
  const double z =
      most * std::abs(std::sin(p.guide_angle)) + std::abs(p.guide_offset_z * std::cos(p.guide_angle));
  return calc_coupler_projection_squared(p, Eigen::Vector3d(0.0, y, z)) > 0.0;
}

/// Time between two looks at the motion, so that neither drive moves far between them; a linkage that would
/// need more than kMostLooks is looked at more seldom, and if it locks between them, the run says so.
double calc_time_between_looks(const RpsupParameters& p, double duration) {
  constexpr double kMostLooks = 1e5;
  constexpr double kAngle = 0.02;     // [rad] of the crank between two looks
  constexpr double kOfStroke = 0.02;  // of the rise time
  constexpr double kTravel = 1e-3;    // [m] of a rod by another law
  const double speed = p.crank_drive ? calc_bounds(*p.crank_drive, duration).rate
                                     : std::max(std::abs(p.crank_velocity), 1e-9);
  const double of_rod =
      p.rod_drive ? kTravel / calc_bounds(*p.rod_drive, duration).rate : kOfStroke * p.rod_stroke_time;
  return std::max(std::min({kAngle / speed, of_rod, 0.1 * duration}), duration / kMostLooks);
}

std::string describe_instant(const std::string& at_start, const std::string& later, double t) {
  return t == 0.0 ? at_start : later + to_text(t) + " s";
}

/// The guide must be within the coupler's reach at every instant.
void check_reach(const RpsupParameters& p, double duration) {
  if (reaches_always(p, duration)) return;
  const auto looks = static_cast<long>(std::ceil(duration / calc_time_between_looks(p, duration)));
  for (long k = 0; k <= looks; ++k) {
    const double t = duration * static_cast<double>(k) / static_cast<double>(looks);
    const double squared = calc_coupler_projection_squared(p, t);
    if (squared > 0.0) continue;
    throw InvalidInput("reach",
                       describe_instant("the linkage cannot be assembled", "the linkage locks at t = ", t) +
                           ": the coupler of " + to_text(p.coupler_length) + " m must be longer than " +
                           to_text(std::sqrt(p.coupler_length * p.coupler_length - squared)) +
                           " m to reach from the end of the rod to the slider's guide there "
                           "(guide_offset_y_m, guide_offset_z_m)");
  }
}

/// The least value of a function near the middle one of three instants, by golden section.
template <typename Function>
double find_least(const Function& function, double from, double to) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kDivisions = 60;
  for (int k = 0; k < kDivisions; ++k) {
    const double a = to - kGolden * (to - from), b = from + kGolden * (to - from);
    (function(a) < function(b) ? to : from) = function(a) < function(b) ? b : a;
  }
  return 0.5 * (from + to);
}

constexpr double kYokeMeets = 1e-9;  // arm at which the ways to assemble the linkage meet, [m]

/// True if the S joint is further from the guide than the cross link is long for whatever crank angle and
/// rod position: no need to look at instants then.
bool is_always_apart(const RpsupParameters& p, double duration) {
  const double apart = std::abs(p.guide_offset_z * std::cos(p.guide_angle)) -
                       calc_farthest_rod(p, duration) * std::abs(std::sin(p.guide_angle));
  return apart > p.cross_length + kYokeMeets;
}

/// Instant of the yoke's shortest arm beside t, if it is shorter at t than an interval before and after;
/// else t.
double find_shortest_arm(const RpsupParameters& p, double t, double interval, double duration) {
  const auto arm = [&p](double at) { return calc_yoke_arm(p, at); };
  const double before = std::max(0.0, t - interval), after = std::min(duration, t + interval);
  return arm(t) <= std::min(arm(before), arm(after)) ? find_least(arm, before, after) : t;
}

/// With the yoke about the guide the S joint must be further from the guide than the cross link is long: at
/// that distance both ways to assemble the linkage meet, and a cross link without length could turn freely.
void check_yoke(const RpsupParameters& p, double duration) {
  if (p.yoke_axis != YokeAxis::kGuide || is_always_apart(p, duration)) return;
  const double interval = calc_time_between_looks(p, duration);
  const auto looks = static_cast<long>(std::ceil(duration / interval));
  for (long k = 0; k <= looks; ++k) {
    const double look = std::min(static_cast<double>(k) * interval, duration);
    const double t = find_shortest_arm(p, look, interval, duration);
    if (calc_yoke_arm(p, t) > kYokeMeets) continue;
    throw InvalidInput(
        "yoke",
        describe_instant("the linkage cannot be assembled", "the linkage locks at t = ", k == 0 ? 0.0 : t) +
            ": the end of the rod is not further than the cross link's " + to_text(1e3 * p.cross_length) +
            " mm from the slider's guide, about which the cross link turns (guide_offset_y_m, "
            "guide_offset_z_m, yoke_axis)");
  }
}

}  // namespace

void check_parameters(const RpsupParameters& parameters, const RunOptions& options) {
  check_geometry(parameters);
  check_links(parameters);
  check_coupler(parameters);
  check_other_links(parameters);
  check_drives(parameters);
  check_joint(parameters);
  check_options(options);
  // Only the run shows the motion that actuators cause.
  const bool is_given = !parameters.crank_actuator && !parameters.rod_actuator;
  const double known = is_given ? options.duration : kStart;
  check_reach(parameters, known);
  check_yoke(parameters, known);
}

}  // namespace engine
