// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <benchmark/benchmark.h>

#include "engine/clearance/clearance_joint.h"
#include "tests/bench/parts/register_parts.h"
#include "tests/bench/support/contact_state.h"

namespace bench {

namespace {

using engine::ContactForm;
using engine::Coupler;
using engine::RpsupParameters;

RpsupParameters with_elements(RpsupParameters parameters) {
  parameters.contact = ContactForm::kElements;
  return parameters;
}

std::vector<std::pair<std::string, RpsupParameters>> evaluated_cases() {
  const RpsupParameters rigid = linkage(Coupler::kRigid, 0.25e-3, 10.0);
  const RpsupParameters flexible = linkage(Coupler::kFlexible, 0.25e-3, 10.0);
  return {{"rigid/continuum", rigid},
          {"flexible/continuum", flexible},
          {"rigid/elements", with_elements(rigid)},
          {"flexible/elements", with_elements(flexible)},
          {"rigid/ideal", linkage(Coupler::kRigid, 0.0, 10.0)},
          {"flexible/ideal", linkage(Coupler::kFlexible, 0.0, 10.0)}};
}

void evaluate(benchmark::State& run, const RpsupParameters& parameters, std::string_view instruction_set) {
  ContactState state(parameters, instruction_set);
  if (parameters.c_r > 0.0 && !(state.penetration() > 0.0)) run.SkipWithError("no contact");
  for (auto _ : run) state.evaluate();
}

/// @param push  the journal's offset across the bearing, [m]
void calc_contact(benchmark::State& run, const RpsupParameters& parameters, double push) {
  engine::ClearanceJoint joint(*engine::build_rpsup(parameters).mechanism.cut_joints[0].clearance);
  engine::JournalMotion journal;
  journal.p_bj = {push, 0.0, 0.0};
  journal.v = {1e-3, 5e-3, 0.0};
  journal.w = {0.0, 0.0, 1.0};
  std::vector<double> bristles(static_cast<std::size_t>(joint.bristle_count()), 0.0), rates = bristles;
  joint.follow(journal, 1e-9, bristles.data());
  engine::ContactLoad load;
  for (auto _ : run) {
    if (!joint.calc(journal, bristles.data(), rates.data(), load))
      run.SkipWithError("a bristle has no place");
    benchmark::DoNotOptimize(load);
  }
}

}  // namespace

void register_evaluations() {
  for (const auto& [name, parameters] : evaluated_cases())
    for (const std::string_view set : engine::instruction_sets())
      benchmark::RegisterBenchmark(("right_hand_side/" + name + "/" + std::string(set)).c_str(),
                                   [p = parameters, set](benchmark::State& run) { evaluate(run, p, set); });
  const RpsupParameters continuum = linkage(Coupler::kRigid, 0.25e-3, 10.0);
  for (const auto& [name, parameters] :
       {std::pair{"continuum", continuum}, std::pair{"elements", with_elements(continuum)}})
    for (const auto& [where, push] : {std::pair{"touching", 0.255e-3}, std::pair{"apart", 0.2e-3}})
      benchmark::RegisterBenchmark(
          (std::string("contact_law/") + name + "/" + where).c_str(),
          [p = parameters, x = push](benchmark::State& run) { calc_contact(run, p, x); });
}

}  // namespace bench
