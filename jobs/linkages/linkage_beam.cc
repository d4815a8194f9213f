// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jobs/parameters/range.h"
#include "jobs/parameters/units.h"

namespace jobs {
namespace {

using nlohmann::json;
using std::numbers::pi;

/// Area, second moments about y and z, and torsion constant of a section, in m.
struct Section {
  double A, I_y, I_z, J;
};

Section tube(double outer, double inner) {
  const double d4 = std::pow(outer, 4) - std::pow(inner, 4);
  return {pi / 4.0 * (outer * outer - inner * inner), pi / 64.0 * d4, pi / 64.0 * d4, pi / 32.0 * d4};
}

/// Torsion of a rectangle: source W. C. Young, R. G. Budynas, Roark's Formulas for Stress and Strain, table
/// of torsional stiffness.
Section rectangle(double height, double width) {
  const double a = std::max(height, width), b = std::min(height, width);
  const double slender = b / a;
  const double J = a * std::pow(b, 3) * (1.0 / 3.0 - 0.21 * slender * (1.0 - std::pow(slender, 4) / 12.0));
  return {height * width, height * std::pow(width, 3) / 12.0, width * std::pow(height, 3) / 12.0, J};
}

Section section_of(const json& beam) {
  if (beam.contains("diameter_mm"))
    return tube(beam.at("diameter_mm").get<double>() / kMmPerM,
                beam.value("inner_diameter_mm", 0.0) / kMmPerM);
  return rectangle(beam.at("height_mm").get<double>() / kMmPerM, beam.at("width_mm").get<double>() / kMmPerM);
}

double youngs_modulus(const json& beam, const engine::RpsupParameters& defaults) {
  return beam.value("youngs_modulus_pa", defaults.youngs_modulus);
}
double shear_modulus(const json& beam, const engine::RpsupParameters& defaults) {
  return beam.value("shear_modulus_pa", defaults.shear_modulus);
}

}  // namespace

void check_beam(const json& beam, const engine::RpsupParameters& defaults, const std::string& pointer,
                std::vector<Fault>& faults) {
  const bool round = beam.contains("diameter_mm");
  const bool rectangular = beam.contains("height_mm") && beam.contains("width_mm");
  if (round == rectangular || (round && (beam.contains("height_mm") || beam.contains("width_mm"))))
    faults.push_back({pointer, "must have a section: either diameter_mm, or height_mm and width_mm"});
  if (beam.contains("inner_diameter_mm") && !round)
    faults.push_back({pointer + "/inner_diameter_mm", "goes with diameter_mm"});
  if (round && beam.value("inner_diameter_mm", 0.0) >= beam.at("diameter_mm").get<double>())
    faults.push_back({pointer + "/inner_diameter_mm", "must be less than diameter_mm"});
  const double most = 3.0 * shear_modulus(beam, defaults);
  if (youngs_modulus(beam, defaults) > most)
    faults.push_back({pointer + "/youngs_modulus_pa", "must be at most 3 times shear_modulus_pa, " +
                                                          readable_number(most) +
                                                          " Pa: Poisson's ratio is at most 0.5"});
}

engine::UniformBeam read_beam(const json& beam, double mass, const engine::RpsupParameters& defaults) {
  const double length = beam.at("length_m").get<double>();
  const double E = youngs_modulus(beam, defaults), G = shear_modulus(beam, defaults);
  const double damping_ratio = beam.value("damping_ratio", engine::RpsupParameters{}.coupler_damping_ratio);
  const Section section = section_of(beam);
  const double polar = section.I_y + section.I_z;
  const double I_x = beam.value("axial_inertia_kg_m2", mass * polar / section.A);
  if (beam.contains("diameter_mm") && beam.value("inner_diameter_mm", 0.0) == 0.0)
    return engine::make_beam({.length = length, .mass = mass, .I_x = I_x,
                              .diameter = beam.at("diameter_mm").get<double>() / kMmPerM,
                              .youngs_modulus = E, .shear_modulus = G, .damping_ratio = damping_ratio});
  return {.length = length, .mass = mass, .I_x = I_x, .share_y = section.I_y / polar, .EI_y = E * section.I_y,
          .EI_z = E * section.I_z,
          .GJ = G * section.J, .damping_ratio = damping_ratio};
}

}  // namespace jobs
