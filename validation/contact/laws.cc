// SPDX-License-Identifier: Apache-2.0
// Effect of the choice of the joint's laws on the study: one law changes at a time.

#include <string>
#include <utility>
#include <vector>

#include "validation/contact/parts.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

struct Choice {
  const char* name;
  void (*choose)(RpsupParameters&);
};

constexpr Choice kChoices[] = {
    {"the study's: Lankarani-Nikravesh, Hertz, LuGre", [](RpsupParameters&) {}},
    {"Hunt-Crossley", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kHuntCrossley; }},
    {"Herbert-McWhannell", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kHerbertMcWhannell; }},
    {"Lee-Wang", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kLeeWang; }},
    {"Gonthier", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kGonthier; }},
    {"Flores", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kFlores; }},
    {"Hu-Guo", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kHuGuo; }},
    {"Carvalho-Martins", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kCarvalhoMartins; }},
    {"Kelvin-Voigt, 1000 N s/m", [](RpsupParameters& p) { p.normal_law = NormalForceLaw::kKelvinVoigt; }},
    {"Johnson", [](RpsupParameters& p) { p.stiffness_law = StiffnessLaw::kJohnson; }},
    {"Radzimovsky", [](RpsupParameters& p) { p.stiffness_law = StiffnessLaw::kRadzimovsky; }},
    {"Liu", [](RpsupParameters& p) { p.stiffness_law = StiffnessLaw::kLiu; }},
    {"no friction", [](RpsupParameters& p) { p.friction = FrictionLaw::kNone; }},
    {"Coulomb, smoothed", [](RpsupParameters& p) { p.friction = FrictionLaw::kCoulomb; }},
    {"Ambrosio", [](RpsupParameters& p) { p.friction = FrictionLaw::kAmbrosio; }},
    {"Dahl", [](RpsupParameters& p) { p.friction = FrictionLaw::kDahl; }},
    {"elasto-plastic", [](RpsupParameters& p) { p.friction = FrictionLaw::kElastoPlastic; }},
};

double peak_of(const RunResult& run) { return metric(run, "peak_slider_acceleration_m_s2"); }

/// All laws in one case of the study.
void add_case(const std::string& name, const RpsupParameters& parameters, Table& table, Largest& residual) {
  for (const Choice& choice : kChoices) {
    RpsupParameters chosen = parameters;
    choice.choose(chosen);
    const RunOptions options{.duration = 4.0, .output_rate = 10.0};
    const RunResult run = run_rpsup(chosen, options);
    residual.take(metric(run, "energy_residual"));
    chosen.contact_stiffness_scale = 1.0 + 1e-6;
    table.rows.push_back(
        {name, choice.name, number(peak_of(run), 4), number(peak_of(run_rpsup(chosen, options)), 4),
         number(metric(run, "rms_slider_acceleration_m_s2"), 4),
         number(metric(run, "peak_contact_force_n"), 4), number(metric(run, "max_penetration_um"), 3),
         number(1e3 * metric(run, "friction_work_j"), 3), number(1e3 * metric(run, "impact_loss_j"), 3)});
  }
}

Table make_laws_table() {
  return {.caption =
              "The joint's laws one at a time, 4 s; peak and root mean square of the slider's "
              "acceleration for t > 2 s. Laws of the normal "
              "force with k_r = 0.9, other parameters at their defaults. A peak that a stiffness larger by a "
              "millionth changes is a sample: the case does not converge.",
          .head = {"case", "law", "peak [m/s^2]", "peak, stiffer [m/s^2]", "RMS [m/s^2]",
                   "largest contact force [N]", "deepest [um]", "friction work [mJ]", "impact loss [mJ]"},
          .rows = {},
          .reproducible_to = 0.2,
          .keys = 2};
}

}  // namespace

Findings compare_laws() {
  Findings findings;
  Table table = make_laws_table();
  Largest residual;
  add_case("rigid, 0.25 mm, 10 rad/s", {}, table, residual);
  RpsupParameters flexible;
  flexible.coupler = Coupler::kFlexible;
  flexible.crank_velocity = 5.0;
  add_case("flexible, 0.25 mm, 5 rad/s", flexible, table, residual);
  findings.checks.push_back(limit("energy account of the study with every law",
                                  "E - work + losses is constant", residual.value(), 1e-5, "1",
                                  "what a job's account may be out by at default settings"));
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace validation
