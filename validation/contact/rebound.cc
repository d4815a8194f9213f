// SPDX-License-Identifier: Apache-2.0
// A free mass meets the bore: restitution, loss, depth, duration, instant of contact.

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "engine/clearance/normal_law.h"
#include "engine/model/rpsup.h"
#include "validation/contact/parts.h"
#include "validation/contact/sliding_mass.h"
#include "validation/support/largest.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/simple_mechanisms.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kReboundMass = 0.8;   // [kg]
constexpr double kReboundSpeed = 0.1;  // [m/s]
constexpr double kReboundGap = 37e-6;  // [m]

/// The normal law with one of its exponents: Hertz's in closed form, or a single element of a coarse ring.
struct Form {
  const char* name;
  ClearanceParameters joint;
  double contact_time;  ///< elastic, [s]
};

/// Eight elements, 45 degrees apart: only the one in the direction of motion touches. f_e = s delta.
constexpr int kFewElements = 8;
double element_stiffness(const ClearanceParameters& joint) {
  return joint.K * 3.0 * std::sqrt(joint.c_r) / (4.0 * std::numbers::sqrt2) * 2.0 * std::numbers::pi /
         kFewElements;
}

std::vector<Form> forms() {
  const ClearanceParameters hertz = one_ring();
  ClearanceParameters linear = hertz;
  linear.form = RadialForm::kElements;
  linear.n_ce = kFewElements;
  return {{"exponent 1.5 (continuum)", hertz, calc_hertz_time(hertz.K, kReboundMass, kReboundSpeed)},
          {"exponent 1 (one element)", linear,
           std::numbers::pi * std::sqrt(kReboundMass / element_stiffness(linear))}};
}

/// Rebound ratios known to four digits, against a slip in the equation that the others are solved from.
struct KnownRebound {
  double k_r, e;
};
constexpr KnownRebound kKnown[] = {{0.9, 0.9132}, {0.5, 0.7252}, {0.3, 0.6842}};

class LastRate : public QuietObserver {
 public:
  void on_step(const Evaluation& /*start*/, const Evaluation& end) override { rate = end.qd[0]; }
  double rate = 0.0;
};

/// A mass slower than the floor of the latched rate: its damping is that of the floor, so the factor c
/// shrinks by v0 / floor.
Check compare_floor() {
  ClearanceParameters joint = one_ring();
  joint.chi = 0.75 * (1.0 - 0.25);
  joint.minimum_onset_rate = 1e-3;
  const double v0 = 0.4e-3;
  const double e = simulate_impact(make_sliding_mass(joint, kReboundMass), 1e-6, v0,
                                   calc_hertz_time(joint.K, kReboundMass, v0))
                       .speed /
                   v0;
  return compare("rebound ratio at 0.4 mm/s, below the floor of 1 mm/s of the latched rate, k_r = 0.5",
                 "c (1 + e) = ln((1 + c) / (1 - c e)) with c = 0.4 * 3/4 (1 - k_r^2)", e,
                 rebound_ratio(0.4 * 0.75 * 0.75), 1e-8, "1",
                 "contact begins up to 1e-10 m late, which is a thousandth of the depth here and a part in "
                 "3e7 of the energy");
}

/// A mass on a slide along z meets a face of the bearing with all eight points at once: linear springs, each
/// with a latch of its own.
/// @returns speed after parting over speed before
double simulate_face_rebound(double k_r, double gap, const RunOptions& steps) {
  constexpr double kReach = 1e-3;  // [m], far beyond the way back
  ClearanceParameters joint = one_ring();
  joint.c_a = kReach;
  joint.K_a = 1e8;
  joint.chi = calc_damping_factor(NormalForceLaw::kLankaraniNikravesh, k_r);
  Mechanism mass = make_sliding_mass(joint, kReboundMass);
  mass.coordinates[0].axis = Axis::kZ;
  RunOptions options = steps;
  options.duration = gap / kReboundSpeed + 3.0 * std::numbers::pi * std::sqrt(kReboundMass / joint.K_a);
  LastRate observer;
  (void)run_from(mass, options, Eigen::VectorXd::Constant(1, kReach - gap),
                 Eigen::VectorXd::Constant(1, kReboundSpeed), observer);
  return -observer.rate / kReboundSpeed;
}

/// Rebound ratio of a law with a restitution coefficient of 0, as the help of that parameter says.
struct Returned {
  const char* name;
  NormalForceLaw law;
  double e;
};
constexpr Returned kReturned[] = {{"Lankarani-Nikravesh", NormalForceLaw::kLankaraniNikravesh, 0.66},
                                  {"Hunt-Crossley", NormalForceLaw::kHuntCrossley, 0.49},
                                  {"Herbert-McWhannell", NormalForceLaw::kHerbertMcWhannell, 0.49},
                                  {"Lee-Wang", NormalForceLaw::kLeeWang, 0.66},
                                  {"Carvalho-Martins", NormalForceLaw::kCarvalhoMartins, 0.06}};

void add_rebounds_of_no_restitution(Findings& findings) {
  for (const Returned& returned : kReturned) {
    ClearanceParameters joint = one_ring();
    joint.chi = calc_damping_factor(returned.law, 0.0);
    const Impact impact =
        simulate_impact(make_sliding_mass(joint, kReboundMass), kReboundGap, kReboundSpeed,
                        4.0 * calc_hertz_time(joint.K, kReboundMass, kReboundSpeed));
    findings.checks.push_back(compare(std::string("rebound ratio with k_r = 0, ") + returned.name,
                                      "c (1 + e) = ln((1 + c) / (1 - c e)), to two digits",
                                      impact.speed / kReboundSpeed, returned.e, 5e-3, "1", "two digits"));
  }
}

void add_face_rebound(Findings& findings, Table& table, double k_r) {
  const double e = rebound_ratio(0.75 * (1.0 - k_r * k_r));
  const std::string at = " at a face of the bearing, K_a = 1e8 N/m, k_r = " + number(k_r);
  const double found = simulate_face_rebound(k_r, kReboundGap, kTightSteps);
  findings.checks.push_back(compare(
      "rebound ratio" + at, "c (1 + e) = ln((1 + c) / (1 - c e)), c = 3/4 (1 - k_r^2)", found, e, 1e-8, "1",
      "a tolerance of 1e-13 makes the step of the onset so short that its error is no larger"));
  Largest error;
  for (int k = 0; k < 20; ++k) error.take(simulate_face_rebound(k_r, 30e-6 + 1.37e-6 * k, {}) - e);
  table.rows.push_back({number(k_r), number(found, 8), number(e, 8), number(error.value(), 2)});
}

void add_face_rebounds(Findings& findings) {
  Table table{.caption =
                  "Rebound of a mass of 0.8 kg that meets a face of the bearing at 0.1 m/s, K_a = 1e8 N/m. "
                  "Steps do not end at the onset "
                  "there, error control alone makes them short: with the default tolerances the rebound is "
                  "less exact than at the bore.",
              .head = {"k_r", "face: tolerance 1e-13", "face: closed form",
                       "face: default tolerances, largest error for 20 gaps"},
              .rows = {},
              .reproducible_to = 0.1};
  for (const double k_r : {0.9, 0.5, 0.3}) add_face_rebound(findings, table, k_r);
  findings.tables.push_back(std::move(table));
}

/// Largest error of the rebound ratio with the steps of a study, for gaps that put the contact anywhere in a
/// step.
double largest_error(double k_r, const RunOptions& steps) {
  ClearanceParameters joint = one_ring();
  joint.chi = 0.75 * (1.0 - k_r * k_r);
  const Mechanism mass = make_sliding_mass(joint, kReboundMass);
  const double time = calc_hertz_time(joint.K, kReboundMass, kReboundSpeed);
  Largest largest;
  for (int k = 0; k < 20; ++k) {
    const double e =
        simulate_impact(mass, 30e-6 + 1.37e-6 * k, kReboundSpeed, time, steps).speed / kReboundSpeed;
    largest.take(e - rebound_ratio(joint.chi));
  }
  return largest.value();
}

/// @param e  rebound ratio of the closed form  @returns that of the engine
double add_rebound(Findings& findings, Form form, double k_r, double e) {
  form.joint.chi = calc_damping_factor(NormalForceLaw::kLankaraniNikravesh, k_r);
  const Impact impact = simulate_impact(make_sliding_mass(form.joint, kReboundMass), kReboundGap,
                                        kReboundSpeed, form.contact_time);
  const double found = impact.speed / kReboundSpeed;
  const std::string at = ", k_r = " + number(k_r) + ", " + form.name;
  findings.checks.push_back(compare(
      "rebound ratio" + at, "c (1 + e) = ln((1 + c) / (1 - c e)), c = 3/4 (1 - k_r^2)", found, e, 1e-8, "1",
      "some hundred steps with a tolerance of 1e-13; contact begins up to 1e-10 m late"));
  const double loss = 0.5 * kReboundMass * kReboundSpeed * kReboundSpeed * (1.0 - e * e);
  findings.checks.push_back(compare(
      "impact loss in the energy account" + at, "m v0^2 (1 - e^2) / 2 with the e of the closed form",
      1e3 * impact.loss, 1e3 * loss, 3e-8 * 1e3 * loss, "mJ",
      "3e-8 of it: 2 e de / (1 - e^2) for the rebound's de"));
  return found;
}

constexpr RunOptions kDopri5Steps{
    .integrator = Integrator::kDopri5, .relative_tolerance = 1e-6, .absolute_tolerance = 1e-7};

/// Rebounds with the steps of a study.
void add_coarse_rebounds(Findings& findings, double k_r) {
  const std::string at = "k_r = " + number(k_r) + ", 20 gaps";
  const std::string reference = "closed form; contacts that begin anywhere in a step";
  findings.checks.push_back(limit("rebound ratio with the default steps, " + at, reference,
                                  largest_error(k_r, {}), 2e-4, "1", "some ten times the tolerance, 1.5e-5"));
  findings.checks.push_back(limit("rebound ratio with dopri5, tolerances 1e-6 and 1e-7, " + at, reference,
                                  largest_error(k_r, kDopri5Steps), 2e-5, "1",
                                  "steps that end at the contact's ends; ten times that if they do not"));
  findings.checks.push_back(
      limit("rebound ratio with rk4 in steps of 1e-5 s, " + at, reference,
            largest_error(k_r, {.integrator = Integrator::kRk4, .step = 1e-5}), 1.5e-4, "1",
            "the contact begins inside a step: its onset rate is read there, by the cubic"));
}

void add_known_rebound(Findings& findings, Table& table, const KnownRebound& known) {
  const double e = rebound_ratio(0.75 * (1.0 - known.k_r * known.k_r));
  std::vector<std::string> row{number(known.k_r)};
  Largest from_known;
  for (const Form& form : forms()) {
    const double found = add_rebound(findings, form, known.k_r, e);
    from_known.take(found - known.e);
    row.push_back(number(found, 8));
  }
  findings.checks.push_back(limit("rebound ratio, k_r = " + number(known.k_r) + ", both exponents",
                                  "root of the same equation, known to four digits: " + number(known.e, 4),
                                  from_known.value(), 5.1e-5, "1", "half of the last digit, and rounding"));
  add_coarse_rebounds(findings, known.k_r);
  row.insert(row.end(), {number(e, 8), number(known.e, 4)});
  table.rows.push_back(row);
}

}  // namespace

Findings compute_hertz_stiffness() {
  Findings findings;
  for (const double c_r : {0.25e-3, 0.5e-3}) {
    RpsupParameters parameters;
    parameters.c_r = c_r;
    const double expected = hertz_stiffness(5e-3, c_r, 2.1e11, 2.1e11 / 1.6e11 - 1.0);
    findings.checks.push_back(compare(
        "stiffness of the bore in the linkage, c_r = " + number(1e3 * c_r) + " mm",
        "Hertz, spheres: 4/3 E* sqrt(R), E* = E / (2 (1 - nu^2)), R = r_b r_j / c_r, nu = E / (2 G) - 1",
        build_rpsup(parameters).mechanism.cut_joints[0].clearance->K, expected, 1e-12 * expected, "N/m^1.5",
        "rounding"));
  }
  return findings;
}

Findings compute_rebounds() {
  Findings findings;
  Table table{.caption =
                  "Rebound of a mass of 0.8 kg that meets the bore at 0.1 m/s: speed after parting over "
                  "speed before.",
              .head = {"k_r", "exponent 1.5", "exponent 1", "closed form", "known to four digits"},
              .rows = {}};
  for (const KnownRebound& known : kKnown) add_known_rebound(findings, table, known);
  add_rebounds_of_no_restitution(findings);
  findings.checks.push_back(compare_floor());
  findings.tables.push_back(std::move(table));
  add_face_rebounds(findings);
  return findings;
}

Findings compute_elastic_impacts() {
  Findings findings;
  const auto add = [&findings](std::string what, std::string reference, double found, double expected,
                               double relative, std::string unit, std::string why) {
    findings.checks.push_back(compare(std::move(what), std::move(reference), found, expected,
                                      relative * expected, std::move(unit), std::move(why)));
  };
  const std::string at_onset =
      "contact begins up to 1e-10 m late, a part in 1e5 of the depth, without force worth mentioning";
  const std::string of_dopri = "integration with a tolerance of 1e-13";
  for (const double c_r : {0.25e-3, 0.5e-3}) {
    ClearanceParameters joint = one_ring(c_r);
    joint.chi = 0.0;
    const std::string at = ", elastic, Hertz, c_r = " + number(1e3 * c_r) + " mm";
    const double time = calc_hertz_time(joint.K, kReboundMass, kReboundSpeed);
    const Impact impact =
        simulate_impact(make_sliding_mass(joint, kReboundMass), kReboundGap, kReboundSpeed, time);
    add("largest penetration" + at, "(5 m v0^2 / (4 K))^(2/5)", 1e6 * impact.depth,
        1e6 * std::pow(1.25 * kReboundMass * kReboundSpeed * kReboundSpeed / joint.K, 0.4), 1e-6, "um",
        "the turn lies between two steps, where the velocity is read as linear");
    add("contact time" + at, "2.94328 delta_max / v0, 2.94328 = 0.8 Gamma(2/5) Gamma(1/2) / Gamma(9/10)",
        1e6 * impact.contact_time, 1e6 * time, 1e-6, "us", at_onset);
    add("speed after parting" + at, "v0", impact.speed, kReboundSpeed, 1e-8, "m/s", of_dopri);
    add("onset of contact" + at, "gap / v0", 1e6 * impact.onset_time, 1e6 * kReboundGap / kReboundSpeed, 1e-9,
        "us", of_dopri);
  }
  Form form = forms().back();
  form.joint.chi = 0.0;
  const double s = element_stiffness(form.joint);
  const Impact impact = simulate_impact(make_sliding_mass(form.joint, kReboundMass), kReboundGap,
                                        kReboundSpeed, form.contact_time);
  add("largest penetration, elastic, one element", "v0 sqrt(m / s)", 1e6 * impact.depth,
      1e6 * kReboundSpeed * std::sqrt(kReboundMass / s), 1e-6, "um",
      "the turn lies between two steps, where the velocity is read as linear");
  add("contact time, elastic, one element", "half a period, pi sqrt(m / s)", 1e6 * impact.contact_time,
      1e6 * form.contact_time, 1e-6, "us", at_onset);
  add("speed after parting, elastic, one element", "v0", impact.speed, kReboundSpeed, 1e-8, "m/s", of_dopri);
  add("onset of contact, one element", "gap / v0", 1e6 * impact.onset_time, 1e6 * kReboundGap / kReboundSpeed,
      1e-9, "us", of_dopri);
  return findings;
}

}  // namespace validation
