// SPDX-License-Identifier: Apache-2.0
#include "validation/reference/paper_linkage.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace validation {

namespace {

using std::numbers::pi;

constexpr Eigen::Index kFirstElastic = 5;  // after psi^(1,1), z^(1,2) and the S joint's three angles

/// A frame that turns about (z, y, x) one after the other: an S joint, or an sde.
FrameIndex add_three_angles(Mechanism& chains, FrameIndex parent, double x) {
  for (const Axis axis : {Axis::kZ, Axis::kY, Axis::kX}) {
    chains.coordinates.push_back({.name = "",
                                  .parent = parent,
                                  .placement = {.p = {x, 0.0, 0.0}},
                                  .motion = Motion::kRotation,
                                  .axis = axis});
    parent = static_cast<FrameIndex>(chains.coordinates.size()) - 1;
    x = 0.0;
  }
  return parent;
}

void set_body(Coordinate& c, double mass, double com_x, const Eigen::Vector3d& inertia) {
  c.mass = mass;
  c.com = {com_x, 0.0, 0.0};
  c.inertia = inertia.asDiagonal();
}

/// A uniform rod's piece of length l_r, with its share of mass and of the moment about the axis.
void set_element(Coordinate& c, const LinkInertia& link, double length, double l_r) {
  const double mass = link.mass * l_r / length;
  const double I_x = link.inertia.x() * l_r / length;
  const double I_y = mass * l_r * l_r / 3.0 + 0.5 * I_x;
  set_body(c, mass, 0.5 * l_r, {I_x, I_y, I_y});
}

void add_coupler(Mechanism& chains, const RpsupParameters& p) {
  const LinkInertia& link = p.links[2];
  if (p.coupler == Coupler::kRigid) {
    add_three_angles(chains, 1, p.rod_length);
    set_body(chains.coordinates.back(), link.mass, 0.5 * p.coupler_length, link.inertia);
    return;
  }
  const double dl = p.coupler_length / (p.rigid_elements - 1);
  FrameIndex frame = 1;
  double x = p.rod_length;
  for (int r = 0; r < p.rigid_elements; ++r) {
    const bool at_end = r == 0 || r == p.rigid_elements - 1;
    frame = add_three_angles(chains, frame, x);
    x = at_end ? 0.5 * dl : dl;
    set_element(chains.coordinates.back(), link, p.coupler_length, x);
  }
}

}  // namespace

Eigen::Vector3d calc_gravity(const RpsupParameters& p) {
  const int direction = static_cast<int>(p.gravity_direction);  // x, -x, y, -y, z, -z
  return (direction % 2 == 0 ? p.gravity : -p.gravity) * Eigen::Vector3d::Unit(direction / 2);
}

Mechanism make_paper_chains(const RpsupParameters& p) {
  Mechanism chains;
  chains.gravity_W = calc_gravity(p);
  chains.coordinates.push_back({.name = "", .placement = {}, .motion = Motion::kRotation, .axis = Axis::kZ});
  set_body(chains.coordinates.back(), p.links[0].mass, 0.5 * p.crank_length, p.links[0].inertia);
  chains.coordinates.push_back(
      {.name = "", .parent = 0, .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kX});
  set_body(chains.coordinates.back(), p.links[1].mass, 0.5 * p.rod_length, p.links[1].inertia);
  add_coupler(chains, p);

  const auto slider = static_cast<FrameIndex>(chains.coordinates.size());
  Placement guide{.p = {0.0, p.guide_offset_y, p.guide_offset_z}};
  if (p.guide_angle != 0.0)
    guide.R = Eigen::AngleAxisd(-p.guide_angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  chains.coordinates.push_back(
      {.name = "", .placement = guide, .motion = Motion::kTranslation, .axis = Axis::kX});
  set_body(chains.coordinates.back(), p.links[3].mass, 0.0, p.links[3].inertia);
  chains.coordinates.push_back({.name = "", .parent = slider, .placement = {}, .motion = Motion::kRotation,
                                .axis = p.yoke_axis == YokeAxis::kGuide ? Axis::kX : Axis::kY});
  set_body(chains.coordinates.back(), p.links[4].mass, 0.0, p.links[4].inertia);
  return chains;
}

double calc_bearing_x(const RpsupParameters& p) {
  return p.coupler == Coupler::kRigid ? p.coupler_length : 0.5 * p.coupler_length / (p.rigid_elements - 1);
}

ElasticTerms calc_elastic_terms(const RpsupParameters& p, const Eigen::VectorXd& q,
                                const Eigen::VectorXd& qd) {
  ElasticTerms terms{Eigen::VectorXd::Zero(q.size())};
  if (p.coupler == Coupler::kRigid) return terms;
  const double d4 = std::pow(p.coupler_diameter, 4);
  const double EI = p.youngs_modulus * pi * d4 / 64.0;
  const double GJ = p.shear_modulus * pi * d4 / 32.0;
  const double l = p.coupler_length;
  const double omega_1 = pi * pi / (l * l) * std::sqrt(EI * l / p.links[2].mass);
  const Eigen::Vector3d S = Eigen::Vector3d(EI, EI, GJ) * ((p.rigid_elements - 1) / l);
  const Eigen::Vector3d D = 2.0 * p.coupler_damping_ratio / omega_1 * S;
  for (int s = 0; s + 1 < p.rigid_elements; ++s) {
    const Eigen::Index at = kFirstElastic + 3 * s;
    const Eigen::Vector3d d = q.segment<3>(at);
    const Eigen::Vector3d d_d = qd.segment<3>(at);
    terms.s_f.segment<3>(at) = S.cwiseProduct(d) + D.cwiseProduct(d_d);
    terms.energy += 0.5 * d.dot(S.cwiseProduct(d));
    terms.rayleigh += 0.5 * d_d.dot(D.cwiseProduct(d_d));
  }
  return terms;
}

}  // namespace validation
