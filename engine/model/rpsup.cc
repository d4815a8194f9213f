#include "engine/model/rpsup.h"

#include <cmath>
#include <string>
#include <utility>

#include "engine/flexible/rfem.h"

namespace engine {

namespace {

struct MassProperties {
  double mass;
  Eigen::Vector3d com;
  Eigen::Vector3d inertia;
};

/// Links of chain 1 have their centre of mass in the middle, those of chain 2 in the origin of their frame.
MassProperties mass_of(const RpsupParameters& parameters, Link link, double length) {
  const LinkInertia& given = parameters.links[static_cast<std::size_t>(link)];
  return {given.mass, {0.5 * length, 0.0, 0.0}, given.inertia};
}

/// Appends chains of joints to a mechanism.
class ChainBuilder {
 public:
  explicit ChainBuilder(Mechanism& mechanism) : mechanism_(mechanism) {}

  FrameIndex add(Coordinate coordinate) {
    mechanism_.coordinates.push_back(std::move(coordinate));
    return static_cast<FrameIndex>(mechanism_.coordinates.size()) - 1;
  }

  /// R_z(psi) R_y(theta) R_x(phi) at the point p_PJ of the parent's frame.
  FrameIndex add_spherical(const std::string& suffix, FrameIndex parent, const Eigen::Vector3d& p_PJ, const SpringDamperElement& sde) {
    const FrameIndex psi = add({.name = "psi" + suffix, .parent = parent, .placement = {.p = p_PJ}, .axis = Axis::kZ,
                                .stiffness = sde.stiffness[0], .damping = sde.damping[0]});
    const FrameIndex theta = add({.name = "theta" + suffix, .parent = psi, .placement = {}, .axis = Axis::kY,
                                  .stiffness = sde.stiffness[1], .damping = sde.damping[1]});
    return add({.name = "phi" + suffix, .parent = theta, .placement = {}, .axis = Axis::kX,
                .stiffness = sde.stiffness[2], .damping = sde.damping[2]});
  }

  void set_body(FrameIndex frame, const MassProperties& body) {
    Coordinate& c = mechanism_.coordinates[static_cast<std::size_t>(frame)];
    c.mass = body.mass;
    c.com = body.com;
    c.inertia = body.inertia.asDiagonal();
  }

  void name_link(std::string name, FrameIndex frame) { mechanism_.links.push_back({std::move(name), frame}); }

 private:
  Mechanism& mechanism_;
};

/// Frame that carries the bearing, and how far along its x axis.
struct CouplerEnd {
  FrameIndex frame;
  double x;
};

CouplerEnd add_rigid_coupler(ChainBuilder& chain, const RpsupParameters& p, FrameIndex rod, FrameIndex& first) {
  first = chain.add_spherical("_1_3_0", rod, {p.rod_length, 0.0, 0.0}, {});
  chain.set_body(first, mass_of(p, Link::k13, p.coupler_length));
  chain.name_link("1,3", first);
  return {first, p.coupler_length};
}

CouplerEnd add_flexible_coupler(ChainBuilder& chain, const RpsupParameters& p, FrameIndex rod, FrameIndex& first) {
  const LinkInertia& link = p.links[static_cast<std::size_t>(Link::k13)];
  const DividedRod divided = divide_rod({.length = p.coupler_length, .mass = link.mass, .I_x = link.inertia[0],
                                         .diameter = p.coupler_diameter, .youngs_modulus = p.youngs_modulus,
                                         .shear_modulus = p.shear_modulus, .damping_ratio = p.coupler_damping_ratio},
                                        p.rigid_elements);
  CouplerEnd end{rod, p.rod_length};
  for (std::size_t r = 0; r < divided.elements.size(); ++r) {
    const RigidElement& rfe = divided.elements[r];
    const std::string suffix = "_1_3_" + std::to_string(r);
    end.frame = chain.add_spherical(suffix, end.frame, {end.x, 0.0, 0.0}, r == 0 ? SpringDamperElement{} : divided.sde);
    end.x = rfe.length;
    if (r == 0) first = end.frame;
    chain.set_body(end.frame, {rfe.mass, {0.5 * rfe.length, 0.0, 0.0}, rfe.inertia});
    chain.name_link("1,3," + std::to_string(r), end.frame);
  }
  return end;
}

FrictionParameters friction_of(const RpsupParameters& p) {
  FrictionParameters friction{p.mu_s, p.mu_k, p.sigma_0, p.sigma_1, p.sigma_2, p.v_s, p.friction, p.break_away, p.v_0, p.v_1};
  if (p.friction != FrictionLaw::kDahl) return friction;
  friction.mu_s = friction.mu_k;
  friction.sigma_1 = friction.sigma_2 = 0.0;
  return friction;
}

ClearanceParameters clearance_of(const RpsupParameters& p) {
  const double nu = p.youngs_modulus / (2.0 * p.shear_modulus) - 1.0;
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
  joint.K = p.contact_stiffness_scale * calc_hertz_stiffness(p.bearing_radius, p.c_r, p.youngs_modulus, nu);
  joint.K_a = p.axial_stiffness;
  joint.cylinders = {p.stiffness_law, p.contact_stiffness_scale * p.youngs_modulus / (2.0 * (1.0 - nu * nu)) * p.bearing_length, p.c_r};
  joint.chi = calc_damping_factor(p.normal_law, p.restitution);
  if (p.normal_law == NormalForceLaw::kKelvinVoigt) joint.damping = p.contact_damping;
  joint.minimum_onset_rate = p.minimum_impact_velocity;
  if (p.friction != FrictionLaw::kNone) joint.friction = friction_of(p);
  return joint;
}

}  // namespace

Rpsup build_rpsup(const RpsupParameters& p) {
  Rpsup rpsup;
  Mechanism& m = rpsup.mechanism;
  RpsupLayout& layout = rpsup.layout;
  ChainBuilder chain(m);

  layout.crank = chain.add({.name = "psi_1_1", .placement = {}, .axis = Axis::kZ});
  chain.set_body(layout.crank, mass_of(p, Link::k11, p.crank_length));
  chain.name_link("1,1", layout.crank);
  layout.rod = chain.add({.name = "z_1_2", .parent = layout.crank, .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kX});
  chain.set_body(layout.rod, mass_of(p, Link::k12, p.rod_length));
  chain.name_link("1,2", layout.rod);
  const CouplerEnd end = p.coupler == Coupler::kFlexible ? add_flexible_coupler(chain, p, layout.rod, layout.coupler)
                                                         : add_rigid_coupler(chain, p, layout.rod, layout.coupler);

  layout.slider = chain.add({.name = "z_2_1", .placement = {.p = {0.0, p.guide_offset_y, p.guide_offset_z}},
                             .motion = Motion::kTranslation, .axis = Axis::kX, .assembly_guess = p.rod_length + p.coupler_length});
  chain.set_body(layout.slider, mass_of(p, Link::k21, 0.0));
  chain.name_link("2,1", layout.slider);
  const FrameIndex cross = chain.add({.name = "psi_2_2", .parent = layout.slider, .placement = {}, .axis = Axis::kY});
  chain.set_body(cross, mass_of(p, Link::k22, 0.0));
  chain.name_link("2,2", cross);

  CutJoint joint{.bearing_frame = end.frame, .journal_frame = cross, .bearing = {.p = {end.x, 0.0, 0.0}}, .journal = {}, .clearance = {}};
  if (p.c_r > 0.0) joint.clearance = clearance_of(p);
  m.cut_joints.push_back(joint);

  m.drives = {{layout.crank, RunUp{p.crank_velocity, p.run_up}},
              {layout.rod, RiseReturnPause{p.rod_stroke, p.rod_stroke_time, p.rod_pause}}};
  m.drive_rows = p.drive == DriveEnforcement::kBaumgarte ? DriveRows::kMultipliers : DriveRows::kEliminated;
  m.baumgarte_alpha = p.baumgarte_alpha;
  m.baumgarte_beta = p.baumgarte_beta;
  m.gravity_W = {0.0, -p.gravity, 0.0};
  return rpsup;
}

Rpsup build_ideal_rpsup(RpsupParameters p) {
  p.coupler = Coupler::kRigid;
  p.c_r = 0.0;
  p.drive = DriveEnforcement::kPrescribed;
  return build_rpsup(p);
}

double calc_reach_squared(const RpsupParameters& p, double t) {
  const double psi = calc_driven_motion(RunUp{p.crank_velocity, p.run_up}, t).q;
  const double r = p.rod_length + calc_driven_motion(RiseReturnPause{p.rod_stroke, p.rod_stroke_time, p.rod_pause}, t).q;
  const double dy = r * std::sin(psi) - p.guide_offset_y;
  return p.coupler_length * p.coupler_length - dy * dy - p.guide_offset_z * p.guide_offset_z;
}

}  // namespace engine
