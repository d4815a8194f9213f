// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/parameter_table.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/parameters/units.h"

namespace jobs {
namespace {

using engine::RpsupParameters;
using engine::RunOptions;

template <typename Spec, typename T>
auto& field(Spec& spec, T RpsupParameters::*member) { return spec.parameters.*member; }
template <typename Spec, typename T>
auto& field(Spec& spec, T RunOptions::*member) { return spec.options.*member; }

/// A member of one of the round links.
template <typename T>
struct OfLink {
  engine::RoundLink RpsupParameters::*link;
  T engine::RoundLink::*member;
};
template <typename Spec, typename T>
auto& field(Spec& spec, OfLink<T> member) { return spec.parameters.*member.link.*member.member; }

/// Columns of the table that do not depend on the type of the engine's member.
struct About {
  std::string_view key;
  std::string_view member;
  std::string_view unit;
  DefaultSource source;
  std::string_view help;
};

ParameterInfo row(const About& about, ParameterKind kind) {
  return {.key = about.key, .member = about.member, .kind = kind, .unit = about.unit, .source = about.source, .scope = ParameterScope::kRpsup,
          .range = {}, .choices = {}, .help = about.help, .read = {}, .write = {}};
}

/// @param per_si  how many of the key's unit make one SI unit. Dividing by it (instead of multiplying by its
///     inverse)
///                turns 0.25 mm into exactly the double nearest to 0.00025.
template <typename Member>
ParameterInfo number(const About& about, Range range, Member member, double per_si = 1.0) {
  ParameterInfo info = row(about, ParameterKind::kNumber);
  info.range = range;
  info.read = [=](const JobSpec& spec) -> nlohmann::json { return field(spec, member) * per_si; };
  info.write = [=](JobSpec& spec, const nlohmann::json& value) { field(spec, member) = value.get<double>() / per_si; };
  return info;
}

template <typename Member>
ParameterInfo integer(const About& about, Range range, Member member) {
  ParameterInfo info = row(about, ParameterKind::kInteger);
  info.range = range;
  info.read = [=](const JobSpec& spec) -> nlohmann::json { return field(spec, member); };
  info.write = [=](JobSpec& spec, const nlohmann::json& value) { field(spec, member) = value.get<int>(); };
  return info;
}

template <typename Member, typename E>
ParameterInfo choice(const About& about, Member member, std::vector<std::pair<std::string_view, E>> words) {
  ParameterInfo info = row(about, ParameterKind::kChoice);
  for (const auto& [word, value] : words) info.choices.push_back(word);
  info.read = [=](const JobSpec& spec) -> nlohmann::json {
    return std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.second == field(spec, member); })->first;
  };
  info.write = [=, key = about.key](JobSpec& spec, const nlohmann::json& value) {
    const auto found = std::find_if(words.begin(), words.end(), [&](const auto& w) { return value == w.first; });
    // A store of an older program may hold a word that is no longer allowed.
    if (found == words.end()) throw InvalidRequest({{"/" + std::string(key), "this version does not know " + value.dump()}});
    field(spec, member) = found->second;
  };
  return info;
}

constexpr auto kPaper = DefaultSource::kPaper;
constexpr auto kDeduced = DefaultSource::kDeduced;
constexpr auto kFitted = DefaultSource::kFitted;
constexpr auto kChosen = DefaultSource::kChosen;

using P = RpsupParameters;
using O = RunOptions;
using Rows = std::vector<ParameterInfo>;

void add_run_rows(Rows& rows) {
  rows.push_back(choice<engine::Coupler P::*, engine::Coupler>(
      {"coupler", "coupler", "", kChosen, "Model of the coupler, link (1,3)"}, &P::coupler,
      {{"rigid", engine::Coupler::kRigid}, {"flexible", engine::Coupler::kFlexible}}));
  rows.push_back(number({"duration_s", "duration", "s", kChosen, "Simulated time"}, above(0, 3600), &O::duration));
  rows.push_back(number({"output_rate_hz", "output_rate", "Hz", kChosen, "Samples of the trajectory per second; at most 2,000,000 in a run"},
                        above(0, 100'000), &O::output_rate));
  rows.push_back(choice<engine::Integrator O::*, engine::Integrator>(
      {"integrator", "integrator", "", kChosen,
       "auto: radau5, or dopri5 between rigid links with friction without bristles, at a tolerance that suits the joint. Error-controlled and L-stable: radau5, Radau IIA of order 5, "
       "and rodas5, Rosenbrock 5(4); error-controlled: dopri5, Dormand-Prince 5(4); with a fixed step: rk4, classical "
       "Runge-Kutta (the paper's)"},
      &O::integrator,
      {{"auto", engine::Integrator::kAuto},
       {"radau5", engine::Integrator::kRadau5},
       {"rodas5", engine::Integrator::kRodas5},
       {"dopri5", engine::Integrator::kDopri5},
       {"rk4", engine::Integrator::kRk4}}));
  rows.push_back(number({"step_s", "step", "s", kChosen, "Step of rk4"}, between(1e-8, 1e-3), &O::step));
  rows.push_back(number({"relative_tolerance", "relative_tolerance", "", kChosen,
                         "Of the error-controlled integrators; auto divides it by up to 30 with clearance, and takes at most 1e-9 there with friction without bristles"},
                        between(1e-13, 1e-2), &O::relative_tolerance));
  rows.push_back(number({"absolute_tolerance", "absolute_tolerance", "", kChosen,
                         "Of the error-controlled integrators, in m, rad and their rates; of the L-stable ones in m and m/s, rotations by the radius of gyration of what they carry"},
                        between(1e-13, 1e-2), &O::absolute_tolerance));
}

void add_drive_rows(Rows& rows) {
  rows.push_back(number({"crank_velocity_rad_s", "crank_velocity", "rad/s", kPaper, "Crank velocity after the run-up"},
                        between(-1000, 1000), &P::crank_velocity));
  rows.push_back(number({"crank_start_rad", "crank_start", "rad", kChosen, "Crank angle at t = 0, from x"}, between(-10, 10), &P::crank_start));
  rows.push_back(number({"run_up_s", "run_up", "s", kPaper, "Time in which the crank reaches its velocity, 0 or at least 1e-6; the steady window starts here"},
                        between(0, 3600), &P::run_up));
  rows.push_back(number({"rod_start_m", "rod_start", "m", kFitted, "Distance of the S joint from the crank's axis while sliding rod (1,2) rests"},
                        between(-100, 100), &P::rod_start));
  rows.push_back(number({"rod_stroke_mm", "rod_stroke", "mm", kFitted, "Stroke of sliding rod (1,2) in the crank, outwards if above 0"},
                        between(-10'000, 10'000), &P::rod_stroke, kMmPerM));
  rows.push_back(number({"rod_stroke_time_s", "rod_stroke_time", "s", kFitted, "Time of the stroke's rise, and of its return"},
                        between(1e-3, 3600), &P::rod_stroke_time));
  rows.push_back(number({"rod_pause_s", "rod_pause", "s", kPaper, "Pause after each stroke"}, between(0, 3600), &P::rod_pause));
  using engine::StrokeLaw;
  rows.push_back(choice<StrokeLaw P::*, StrokeLaw>(
      {"rod_law", "rod_law", "", kFitted,
       "Law of the rise and of the return. cosine: harmonic motion; parabolic: constant acceleration and deceleration; with both the acceleration jumps at a pause"},
      &P::rod_law, {{"cycloidal", StrokeLaw::kCycloidal}, {"cosine", StrokeLaw::kCosine}, {"parabolic", StrokeLaw::kParabolic}}));
  rows.push_back(choice<engine::DriveEnforcement P::*, engine::DriveEnforcement>(
      {"drive", "drive", "", kChosen, "prescribed: driven coordinates follow their law exactly; baumgarte: by stabilised constraint rows (the paper's)"},
      &P::drive, {{"prescribed", engine::DriveEnforcement::kPrescribed}, {"baumgarte", engine::DriveEnforcement::kBaumgarte}}));
  rows.push_back(number({"baumgarte_alpha_1_s", "baumgarte_alpha", "1/s", kChosen, "Stabilisation of velocity errors of constraints"},
                        between(0, 1e6), &P::baumgarte_alpha));
  rows.push_back(number({"baumgarte_beta_1_s", "baumgarte_beta", "1/s", kChosen, "Stabilisation of position errors of constraints"},
                        between(0, 1e6), &P::baumgarte_beta));
}

void add_joint_rows(Rows& rows) {
  rows.push_back(number({"clearance_mm", "c_r", "mm", kPaper, "Radial clearance of the joint, less than bearing_radius_mm; 0: the ideal joint"},
                        below(0, 1000), &P::c_r, kMmPerM));
  rows.push_back(number({"axial_clearance_mm", "c_a", "mm", kPaper, "Clearance at each face of the journal"}, between(0, 1000), &P::c_a, kMmPerM));
  rows.push_back(number({"bearing_radius_mm", "bearing_radius", "mm", kPaper, "Radius of the bearing's bore"}, between(0.01, 1000),
                        &P::bearing_radius, kMmPerM));
  rows.push_back(number({"bearing_length_mm", "bearing_length", "mm", kFitted, "Length of the bearing and of the journal"},
                        between(0.01, 1000), &P::bearing_length, kMmPerM));
  rows.push_back(choice<engine::ContactForm P::*, engine::ContactForm>(
      {"contact", "contact", "", kChosen, "elements: points around each ring (the paper's); continuum: their limit in closed form"}, &P::contact,
      {{"continuum", engine::ContactForm::kContinuum}, {"elements", engine::ContactForm::kElements}}));
  rows.push_back(integer({"radial_levels", "radial_levels", "", kFitted, "Rings of radial contact along the journal"}, between(1, 16), &P::radial_levels));
  rows.push_back(integer({"radial_elements", "radial_elements", "", kChosen, "Contact elements on a ring"}, between(3, 10'000), &P::radial_elements));
  rows.push_back(integer({"axial_levels", "axial_levels", "", kChosen, "Circles of axial contact on a face"}, between(1, 16), &P::axial_levels));
  rows.push_back(integer({"axial_elements", "axial_elements", "", kChosen, "Contact points on a circle"}, between(3, 1000), &P::axial_elements));
  using engine::NormalForceLaw;
  rows.push_back(choice<NormalForceLaw P::*, NormalForceLaw>(
      {"normal_law", "normal_law", "", kPaper, "Damping of the contact. kelvin_voigt: a damper beside the spring"},
      &P::normal_law,
      {{"lankarani_nikravesh", NormalForceLaw::kLankaraniNikravesh},
       {"hunt_crossley", NormalForceLaw::kHuntCrossley},
       {"herbert_mcwhannell", NormalForceLaw::kHerbertMcWhannell},
       {"lee_wang", NormalForceLaw::kLeeWang},
       {"gonthier", NormalForceLaw::kGonthier},
       {"flores", NormalForceLaw::kFlores},
       {"hu_guo", NormalForceLaw::kHuGuo},
       {"carvalho_martins", NormalForceLaw::kCarvalhoMartins},
       {"kelvin_voigt", NormalForceLaw::kKelvinVoigt}}));
  rows.push_back(number({"restitution", "restitution", "", kPaper, "Restitution coefficient of the contact law; kelvin_voigt has none, gonthier, flores and hu_guo need one above 0. What a body keeps of its speed at 0: 0.06 by carvalho_martins, 0.49 by hunt_crossley and herbert_mcwhannell, 0.66 by lankarani_nikravesh and lee_wang"}, between(0, 1),
                        &P::restitution));
  rows.push_back(number({"contact_damping_n_s_m", "contact_damping", "N s/m", kChosen, "kelvin_voigt: the damper of the bore and that of each face, which contact elements and points share"},
                        between(0, 1e9), &P::contact_damping));
  using engine::StiffnessLaw;
  rows.push_back(choice<StiffnessLaw P::*, StiffnessLaw>(
      {"stiffness_law", "stiffness_law", "", kPaper,
       "Elastic force of the bore. johnson, radzimovsky, liu: cylinders, for contact continuum; the first two end where they no longer hold"},
      &P::stiffness_law,
      {{"hertz", StiffnessLaw::kHertz}, {"johnson", StiffnessLaw::kJohnson}, {"radzimovsky", StiffnessLaw::kRadzimovsky}, {"liu", StiffnessLaw::kLiu}}));
  rows.push_back(number({"contact_stiffness_scale", "contact_stiffness_scale", "", kChosen, "Factor on the stiffness of radial contact"},
                        between(1e-6, 1e6), &P::contact_stiffness_scale));
  rows.push_back(number({"axial_stiffness_n_m", "axial_stiffness", "N/m", kFitted, "Stiffness of one face of the journal"}, between(0, 1e13),
                        &P::axial_stiffness));
  rows.push_back(number({"minimum_impact_velocity_m_s", "minimum_impact_velocity", "m/s", kChosen, "Least onset velocity that the contact law divides by"},
                        between(1e-9, 10), &P::minimum_impact_velocity));
}

void add_friction_rows(Rows& rows) {
  using engine::FrictionLaw;
  rows.push_back(choice<FrictionLaw P::*, FrictionLaw>(
      {"friction", "friction", "", kPaper,
       "Friction law of the joint. With bristles: lugre, dahl, elasto_plastic; without: coulomb (smoothed), ambrosio"},
      &P::friction,
      {{"lugre", FrictionLaw::kLuGre},
       {"none", FrictionLaw::kNone},
       {"coulomb", FrictionLaw::kCoulomb},
       {"ambrosio", FrictionLaw::kAmbrosio},
       {"dahl", FrictionLaw::kDahl},
       {"elasto_plastic", FrictionLaw::kElastoPlastic}}));
  rows.push_back(number({"friction_static", "mu_s", "", kPaper, "lugre, elasto_plastic: static coefficient. The paper prints it below the kinetic one"}, above(0, 10), &P::mu_s));
  rows.push_back(number({"friction_kinetic", "mu_k", "", kPaper, "Kinetic coefficient of every friction law"}, above(0, 10), &P::mu_k));
  rows.push_back(number({"bristle_stiffness_1_m", "sigma_0", "1/m", kPaper, "Stiffness of the bristles"}, above(0, 1e9), &P::sigma_0));
  rows.push_back(number({"bristle_damping_s_m", "sigma_1", "s/m", kPaper, "lugre, elasto_plastic: damping of the bristles"}, between(0, 1e6), &P::sigma_1));
  rows.push_back(number({"bristle_viscous_s_m", "sigma_2", "s/m", kPaper, "lugre, elasto_plastic: viscous friction"}, between(0, 1e6), &P::sigma_2));
  rows.push_back(number({"stribeck_velocity_m_s", "v_s", "m/s", kPaper, "lugre, elasto_plastic: Stribeck velocity"}, between(1e-9, 100), &P::v_s));
  rows.push_back(number({"break_away_ratio", "break_away", "", kChosen, "elasto_plastic: part of its steady deflection up to which a bristle does not creep"},
                        below(0, 1), &P::break_away));
  rows.push_back(number({"friction_velocity_0_m_s", "v_0", "m/s", kChosen,
                         "coulomb: velocity of 1/sqrt(2) of full friction; ambrosio: no friction below it"}, between(1e-9, 100), &P::v_0));
  rows.push_back(number({"friction_velocity_1_m_s", "v_1", "m/s", kChosen, "ambrosio: full friction above it; more than friction_velocity_0_m_s"},
                        between(1e-9, 100), &P::v_1));
}

void add_body_rows(Rows& rows) {
  rows.push_back(integer({"rigid_elements", "rigid_elements", "", kPaper, "Rigid elements of a flexible coupler"}, between(2, 64), &P::rigid_elements));
  rows.push_back(number({"youngs_modulus_pa", "youngs_modulus", "Pa", kPaper, "Young's modulus; at most 3 times the shear modulus"}, between(1e6, 1e13),
                        &P::youngs_modulus));
  rows.push_back(number({"shear_modulus_pa", "shear_modulus", "Pa", kPaper, "Shear modulus"}, between(1e5, 1e13), &P::shear_modulus));
  rows.push_back(number({"coupler_diameter_mm", "coupler_diameter", "mm", kDeduced, "Diameter of the coupler"}, between(0.1, 1000),
                        &P::coupler_diameter, kMmPerM));
  rows.push_back(number({"coupler_damping_ratio", "coupler_damping_ratio", "", kFitted, "Damping ratio of the coupler's first bending mode"},
                        between(0, 10), &P::coupler_damping_ratio));
  rows.push_back(number({"crank_length_m", "crank_length", "m", kPaper, "Length of link (1,1)"}, between(1e-3, 100), &P::crank_length));
  rows.push_back(number({"rod_length_m", "rod_length", "m", kPaper, "Length of link (1,2), up to the S joint"}, between(1e-3, 100), &P::rod_length));
  rows.push_back(number({"coupler_length_m", "coupler_length", "m", kPaper, "Length of link (1,3), from the S joint to the bearing"},
                        between(1e-3, 100), &P::coupler_length));
  rows.push_back(number({"guide_offset_y_m", "guide_offset_y", "m", kChosen, "Offset of the slider's guide from the crank's centre along y"},
                        between(-100, 100), &P::guide_offset_y));
  rows.push_back(number({"guide_offset_z_m", "guide_offset_z", "m", kFitted, "Offset of the slider's guide along z, the crank's axis"},
                        between(-100, 100), &P::guide_offset_z));
  rows.push_back(number({"guide_angle_deg", "guide_angle", "deg", kChosen, "Direction of the guide in the plane of x and z, from x towards z"},
                        between(-180, 180), &P::guide_angle, kDegPerRad));
  using engine::YokeAxis;
  rows.push_back(choice<YokeAxis P::*, YokeAxis>(
      {"yoke_axis", "yoke_axis", "", kDeduced, "Axis about which link (2,2) turns in the slider. guide: the guide's; across: y, at right angles to it"},
      &P::yoke_axis, {{"guide", YokeAxis::kGuide}, {"across", YokeAxis::kAcross}}));
  rows.push_back(number({"gravity_m_s2", "gravity", "m/s^2", kChosen, "Acceleration of gravity"}, between(-1000, 1000), &P::gravity));
  using engine::Direction;
  rows.push_back(choice<Direction P::*, Direction>(
      {"gravity_direction", "gravity_direction", "", kFitted, "Direction in which gravity pulls; z is the crank's axis"}, &P::gravity_direction,
      {{"x", Direction::kX}, {"-x", Direction::kMinusX}, {"y", Direction::kY}, {"-y", Direction::kMinusY}, {"z", Direction::kZ}, {"-z", Direction::kMinusZ}}));
}

/// Everything that is said of a round link but its length, in this order: its model, diameters, elements and
/// damping.
void add_link_rows(engine::RoundLink P::*link, const std::array<About, 5>& about, Rows& rows) {
  using engine::LinkModel;
  using engine::RoundLink;
  rows.push_back(choice<OfLink<LinkModel>, LinkModel>(about[0], {link, &RoundLink::model},
                                                      {{"rigid", LinkModel::kRigid}, {"flexible", LinkModel::kFlexible}}));
  rows.push_back(number(about[1], between(0.1, 1000), OfLink<double>{link, &RoundLink::diameter}, kMmPerM));
  rows.push_back(number(about[2], between(0, 1000), OfLink<double>{link, &RoundLink::inner_diameter}, kMmPerM));
  rows.push_back(integer(about[3], between(2, 64), OfLink<int>{link, &RoundLink::elements}));
  rows.push_back(number(about[4], between(0, 10), OfLink<double>{link, &RoundLink::damping_ratio}));
}

void add_round_link_rows(Rows& rows) {
  constexpr std::string_view kOuter = "Outer diameter of the link: its stiffness where it is flexible, and its default mass and inertia";
  constexpr std::string_view kInner = "Inner diameter of it, less than the outer one; 0: a solid rod";
  constexpr std::string_view kDamping = "Damping ratio of its first bending mode, as the coupler's";
  add_link_rows(&P::crank,
                {{{"crank", "crank.model", "", kChosen, "Model of the crank, link (1,1). A flexible one holds the rod at its end"},
                  {"crank_diameter_mm", "crank.diameter", "mm", kDeduced, kOuter},
                  {"crank_inner_diameter_mm", "crank.inner_diameter", "mm", kDeduced, kInner},
                  {"crank_elements", "crank.elements", "", kChosen, "Rigid elements of a flexible crank"},
                  {"crank_damping_ratio", "crank.damping_ratio", "", kChosen, kDamping}}}, rows);
  add_link_rows(&P::rod,
                {{{"rod", "rod.model", "", kChosen, "Model of the sliding rod, link (1,2), held at its origin"},
                  {"rod_diameter_mm", "rod.diameter", "mm", kDeduced, kOuter},
                  {"rod_inner_diameter_mm", "rod.inner_diameter", "mm", kDeduced, kInner},
                  {"rod_elements", "rod.elements", "", kChosen, "Rigid elements of a flexible rod"},
                  {"rod_damping_ratio", "rod.damping_ratio", "", kChosen, kDamping}}}, rows);
  add_link_rows(&P::cross,
                {{{"cross", "cross.model", "", kChosen, "Model of the cross link, link (2,2). A flexible one has a cross_length_mm"},
                  {"cross_diameter_mm", "cross.diameter", "mm", kDeduced, "As of the crank, of a cross link with a cross_length_mm"},
                  {"cross_inner_diameter_mm", "cross.inner_diameter", "mm", kDeduced, kInner},
                  {"cross_elements", "cross.elements", "", kChosen, "Rigid elements of a flexible cross link"},
                  {"cross_damping_ratio", "cross.damping_ratio", "", kChosen, kDamping}}}, rows);
  rows.push_back(number({"cross_length_mm", "cross_length", "mm", kChosen,
                         "Length of link (2,2), along the joint's axis from its guide to the middle of the joint; 0: the joint is at its guide, "
                         "else at least 1 mm"},
                        between(0, 10'000), &P::cross_length, kMmPerM));
}

/// The scope of parameters that are not of joints. Parameters of the RPSUP linkage's own bodies and drives
/// are for it alone.
ParameterScope scope_of(std::string_view key) {
  constexpr std::array<std::string_view, 11> kOfAnyRun{"duration_s", "output_rate_hz", "integrator", "step_s", "relative_tolerance", "absolute_tolerance",
                                                       "run_up_s", "drive", "baumgarte_alpha_1_s", "baumgarte_beta_1_s", "gravity_m_s2"};
  constexpr std::array<std::string_view, 3> kOfMaterial{"rigid_elements", "youngs_modulus_pa", "shear_modulus_pa"};
  if (std::find(kOfAnyRun.begin(), kOfAnyRun.end(), key) != kOfAnyRun.end()) return ParameterScope::kRun;
  return std::find(kOfMaterial.begin(), kOfMaterial.end(), key) != kOfMaterial.end() ? ParameterScope::kMaterial : ParameterScope::kRpsup;
}

Rows make_table() {
  Rows rows;
  add_run_rows(rows);
  add_drive_rows(rows);
  const std::size_t first_joint = rows.size();
  add_joint_rows(rows);
  add_friction_rows(rows);
  const std::size_t end_joint = rows.size();
  add_body_rows(rows);
  add_round_link_rows(rows);
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k].scope = k >= first_joint && k < end_joint ? ParameterScope::kJoint : scope_of(rows[k].key);
  return rows;
}

}  // namespace

std::string_view source_name(DefaultSource source) {
  switch (source) {
    case DefaultSource::kPaper: return "paper";
    case DefaultSource::kDeduced: return "deduced from the paper";
    case DefaultSource::kFitted: return "fitted to the paper's ratios";
    case DefaultSource::kChosen: return "chosen";
  }
  return "";
}

std::span<const ParameterInfo> parameter_table() {
  static const Rows table = make_table();
  return table;
}

const ParameterInfo* find_parameter(std::string_view key) {
  const auto table = parameter_table();
  const auto found = std::find_if(table.begin(), table.end(), [&](const ParameterInfo& info) { return info.key == key; });
  return found == table.end() ? nullptr : &*found;
}

nlohmann::json default_value(const ParameterInfo& info) { return info.read(JobSpec{}); }

}  // namespace jobs
