// SPDX-License-Identifier: Apache-2.0
#include "engine/model/rpsup.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/flexible/rfem.h"
#include "engine/model/rpsup_geometry.h"

namespace engine {

namespace {

const LinkInertia& inertia_of(const RpsupParameters& parameters, Link link) {
  return parameters.links[static_cast<std::size_t>(link)];
}

/// Links of chain 1 have their centre of mass in the middle, those of chain 2 in the origin of their frame.
LinkageBody make_body(const RpsupParameters& parameters, Link link, const std::string& name, double length) {
  const LinkInertia& given = inertia_of(parameters, link);
  return {.name = name,
          .mass = given.mass,
          .com = {0.5 * length, 0.0, 0.0},
          .inertia = given.inertia.asDiagonal()};
}

/// Makes a body a beam with its mass. @param I_x  about the link's axis
void divide(const RpsupParameters& p, const RoundLink& form, double length, double I_x, LinkageBody& body) {
  if (form.model == LinkModel::kRigid) return;
  body.elements = form.elements;
  body.beam = make_beam({.length = length,
                         .mass = body.mass,
                         .I_x = I_x,
                         .diameter = form.diameter,
                         .youngs_modulus = p.youngs_modulus,
                         .shear_modulus = p.shear_modulus,
                         .damping_ratio = form.damping_ratio,
                         .inner_diameter = form.inner_diameter});
}

LinkageBody make_round_link(const RpsupParameters& p, Link link, const std::string& name, double length,
                            const RoundLink& form) {
  LinkageBody body = make_body(p, link, name, length);
  divide(p, form, length, body.inertia(0, 0), body);
  return body;
}

RoundLink form_of_coupler(const RpsupParameters& p) {
  return {.model = p.coupler,
          .diameter = p.coupler_diameter,
          .elements = p.rigid_elements,
          .damping_ratio = p.coupler_damping_ratio};
}

/// A tube along its z, the axis of the joint with the coupler: without a length about its middle, else from
/// its origin on.
LinkageBody make_cross(const RpsupParameters& p) {
  LinkageBody cross = make_body(p, Link::k22, "2,2", 0.0);
  cross.com = {0.0, 0.0, 0.5 * p.cross_length};
  divide(p, p.cross, p.cross_length, cross.inertia(2, 2), cross);
  return cross;
}

bool is_flexible(const RoundLink& link) { return link.model == LinkModel::kFlexible; }

/// A beam lies along x: the frame of a flexible cross link is rotated so that its x is the tube's axis, and
/// its y or z the yoke's.
Placement cross_rotation(const RpsupParameters& p) {
  Placement rotation;
  if (!is_flexible(p.cross)) return rotation;
  if (p.yoke_axis == YokeAxis::kGuide)
    rotation.R << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  else
    rotation.R << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  return rotation;
}

/// The yoke's axis in the cross link's frame.
Axis yoke_axis(const RpsupParameters& p) {
  if (p.yoke_axis == YokeAxis::kAcross) return Axis::kY;
  return is_flexible(p.cross) ? Axis::kZ : Axis::kX;
}

/// The journal in the cross link's frame, its axes those of the rigid link.
Placement journal_placement(const RpsupParameters& p) {
  const Eigen::Matrix3d back = cross_rotation(p).R.transpose();
  return {back, p.cross_length * back.col(2)};
}

/// The rod's joint in the rod's frame and in the crank's, along both.
double guide_position(const RpsupParameters& p) { return is_flexible(p.crank) ? p.crank_length : 0.0; }

/// @param start  of a freedom that the actuator, if there is one, moves from rest
LinkageFreedom driven(std::string name, const std::optional<Actuator>& actuator, double start,
                      const DriveLaw& law) {
  LinkageFreedom freedom{.name = std::move(name)};
  freedom.actuator = actuator;
  if (!actuator) {
    freedom.drive = law;
    return freedom;
  }
  freedom.start = start;
  freedom.start_rate = 0.0;
  return freedom;
}

std::vector<LinkageJoint> describe_joints(const RpsupParameters& p) {
  const double guide = guide_position(p);
  const AssemblyGuess guess = calc_assembly_guess(p);
  return {
      {.name = "crank",
       .from = kGroundName,
       .to = "1,1",
       .placement = {},
       .freedoms = {driven("psi_1_1", p.crank_actuator, p.crank_start,
                           p.crank_drive ? *p.crank_drive : crank_law(p))}},
      {.name = "rod",
       .kind = JointKind::kPrismatic,
       .from = "1,1",
       .to = "1,2",
       .placement = {.p = {guide, 0.0, 0.0}},
       .axes = {Axis::kX},
       .freedoms = {driven("z_1_2", p.rod_actuator, p.rod_start - p.rod_length,
                           p.rod_drive ? *p.rod_drive : rod_law(p))},
       .to_placement = {.p = {guide, 0.0, 0.0}}},
      {.name = "ball",
       .kind = JointKind::kSpherical,
       .from = "1,2",
       .to = "1,3",
       .placement = {.p = {p.rod_length, 0.0, 0.0}},
       .freedoms = {{.name = "psi_1_3_0", .guess = guess.psi_13},
                    {.name = "theta_1_3_0", .guess = guess.theta_13},
                    {.name = "phi_1_3_0", .guess = guess.phi_13}}},
      {.name = "guide",
       .kind = JointKind::kPrismatic,
       .from = kGroundName,
       .to = "2,1",
       .placement = guide_frame(p),
       .axes = {Axis::kX},
       .freedoms = {{.name = "z_2_1", .guess = guess.z_21}}},
      {.name = "cross",
       .from = "2,1",
       .to = "2,2",
       .placement = cross_rotation(p),
       .axes = {yoke_axis(p)},
       .freedoms = {{.name = "psi_2_2", .guess = guess.psi_22}}},
      {.name = "bearing",
       .from = "1,3",
       .to = "2,2",
       .placement = {.p = {p.coupler_length, 0.0, 0.0}},
       .cut = true,
       .to_placement = journal_placement(p)},
  };
}

Linkage describe_rpsup(const RpsupParameters& p) {
  Linkage linkage;
  linkage.bodies = {make_round_link(p, Link::k11, "1,1", p.crank_length, p.crank),
                    make_round_link(p, Link::k12, "1,2", p.rod_length, p.rod),
                    make_round_link(p, Link::k13, "1,3", p.coupler_length, form_of_coupler(p)),
                    make_body(p, Link::k21, "2,1", 0.0), make_cross(p)};
  linkage.joints = describe_joints(p);
  if (p.c_r > 0.0) linkage.joints.back().clearance = make_clearance(p);
  linkage.drive_rows =
      p.drive == DriveEnforcement::kBaumgarte ? DriveRows::kMultipliers : DriveRows::kEliminated;
  linkage.baumgarte_alpha = p.baumgarte_alpha;
  linkage.baumgarte_beta = p.baumgarte_beta;
  linkage.gravity_W = p.gravity * gravity_direction_W(p.gravity_direction);
  return linkage;
}

FrictionParameters friction_of(const RpsupParameters& p) {
  FrictionParameters friction{p.mu_s, p.mu_k,     p.sigma_0,    p.sigma_1, p.sigma_2,
                              p.v_s,  p.friction, p.break_away, p.v_0,     p.v_1};
  if (p.friction != FrictionLaw::kDahl) return friction;
  friction.mu_s = friction.mu_k;
  friction.sigma_1 = friction.sigma_2 = 0.0;
  return friction;
}

void set_normal_force(const RpsupParameters& p, ClearanceParameters& joint) {
  const double nu = p.youngs_modulus / (2.0 * p.shear_modulus) - 1.0;
  joint.K = p.contact_stiffness_scale * calc_hertz_stiffness(p.bearing_radius, p.c_r, p.youngs_modulus, nu);
  joint.K_a = p.axial_stiffness;
  joint.cylinders = {
      p.stiffness_law,
      p.contact_stiffness_scale * p.youngs_modulus / (2.0 * (1.0 - nu * nu)) * p.bearing_length, p.c_r};
  joint.chi = calc_damping_factor(p.normal_law, p.restitution);
  if (p.normal_law == NormalForceLaw::kKelvinVoigt) joint.damping = p.contact_damping;
  joint.minimum_onset_rate = p.minimum_impact_velocity;
}

/// The flexible links but for the coupler. @param bodies  as built, in the order of
/// describe_rpsup()
std::vector<BentLink> list_bent_links(const RpsupParameters& p, const std::vector<BodyFrames>& bodies) {
  std::vector<BentLink> bent;
  const auto add = [&](const char* name, const RoundLink& link, std::size_t body, double length) {
    const std::vector<BodyFrames::Part>& parts = bodies[body].parts;
    if (is_flexible(link)) bent.push_back({name, parts.front(), parts.back(), length});
  };
  add("crank", p.crank, 0, p.crank_length);
  add("rod", p.rod, 1, p.rod_length);
  add("cross", p.cross, 4, p.cross_length);
  return bent;
}

}  // namespace

ClearanceParameters make_clearance(const RpsupParameters& p) {
  ClearanceParameters joint;
  joint.r_b = p.bearing_radius;
  joint.c_r = p.c_r;
  joint.c_a = p.c_a;
  joint.L_b = p.bearing_length;
  joint.form = p.contact == ContactForm::kElements ? RadialForm::kElements : RadialForm::kContinuum;
  joint.n_r = p.radial_levels;
  joint.n_ce = p.radial_elements;
  joint.n_a = p.axial_levels;
  joint.n_ce_axial = p.axial_elements;
  set_normal_force(p, joint);
  if (p.friction != FrictionLaw::kNone) joint.friction = friction_of(p);
  if (!p.wear_depth.empty()) joint.worn = std::make_shared<const WornBore>(p.c_r, p.wear_depth);
  return joint;
}

Rpsup build_rpsup(const RpsupParameters& p) {
  BuiltLinkage built = build_linkage(describe_rpsup(p));
  const auto first = [&](std::size_t joint) { return built.joints[joint].first; };
  RpsupLayout layout{.crank = first(0),
                     .rod = first(1),
                     .coupler = built.bodies[2].parts[0].frame,
                     .slider = first(3),
                     .bent = list_bent_links(p, built.bodies)};
  return {std::move(built.mechanism), std::move(layout)};
}

Rpsup build_ideal_rpsup(RpsupParameters p) {
  for (LinkModel* link : {&p.coupler, &p.crank.model, &p.rod.model, &p.cross.model})
    *link = LinkModel::kRigid;
  p.c_r = 0.0;
  p.drive = DriveEnforcement::kPrescribed;
  return build_rpsup(p);
}

}  // namespace engine
