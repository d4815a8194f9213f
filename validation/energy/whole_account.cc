// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "engine/model/rpsup.h"
#include "engine/simulate.h"
#include "charts/chart.h"
#include "validation/energy/parts.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/text.h"

namespace validation {

namespace {

/// The account over the run.
class AccountRecord : public QuietObserver {
 public:
  void on_sample(const Evaluation& at) override {
    const EnergyAccount& e = at.energy;
    if (t.empty()) start_ = e.kinetic + e.potential;
    t.push_back(at.t);
    work.push_back(e.drive_work.sum());
    change.push_back(e.kinetic + e.potential - start_);
    impact.push_back(e.impact_loss);
    friction.push_back(e.friction_loss);
    structural.push_back(e.structural_loss);
  }
  std::vector<double> t, work, change, impact, friction, structural;

 private:
  double start_ = 0.0;
};

std::vector<double> in_millijoule(std::vector<double> values) {
  for (double& value : values) value *= 1e3;
  return values;
}

AccountRecord record_account() {
  RpsupParameters parameters;
  parameters.coupler = Coupler::kFlexible;
  AccountRecord record;
  (void)simulate(build_rpsup(parameters).mechanism,
                 {.duration = 0.5,
                  .output_rate = 1000.0,
                  .integrator = Integrator::kDopri5,
                  .relative_tolerance = 1e-8,
                  .absolute_tolerance = 1e-9},
                 record);
  return record;
}

Check compare_account(const AccountRecord& record) {
  const double sum = record.impact.back() + record.friction.back() + record.structural.back();
  const double scale = *std::max_element(record.work.begin(), record.work.end());
  return compare(
      "flexible, 0.25 mm, 10 rad/s, 0.5 s, tolerance 1e-8: impact, friction and structural loss together",
      "work of the drives less the change of energy", sum, record.work.back() - record.change.back(),
      1e-7 * scale, "J", "ten times the tolerance, of the work done");
}

Table make_account_table(const AccountRecord& record) {
  return {.caption = "Where the work goes: flexible, 0.25 mm, 10 rad/s, after 0.5 s.",
          .head = {"work of the drives [mJ]", "change of energy [mJ]", "impact loss [mJ]",
                   "friction loss [mJ]", "structural loss [mJ]"},
          .rows = {{number(1e3 * record.work.back(), 6), number(1e3 * record.change.back(), 6),
                    number(1e3 * record.impact.back(), 3), number(1e3 * record.friction.back(), 3),
                    number(1e3 * record.structural.back(), 3)}},
          .reproducible_to = 0.05,
          .keys = 0};
}

charts::Chart make_energy_chart(const AccountRecord& record) {
  charts::Chart energies{
      .title = "work and energy", .x_label = "t [s]", .y_label = "[mJ]", .y_min = -0.5, .y_max = 8.0};
  energies.series.push_back({.label = "change of energy",
                             .x = record.t,
                             .y = in_millijoule(record.change),
                             .colour = charts::kGrey,
                             .width = 4.0});
  energies.series.push_back({.label = "work of the drives",
                             .x = record.t,
                             .y = in_millijoule(record.work),
                             .colour = charts::kBlue});
  return energies;
}

charts::Chart make_loss_chart(const AccountRecord& record) {
  charts::Chart losses{
      .title = "losses", .x_label = "t [s]", .y_label = "[mJ]", .y_min = -0.01, .y_max = 0.28};
  losses.series.push_back(
      {.label = "impact", .x = record.t, .y = in_millijoule(record.impact), .colour = charts::kOrange});
  losses.series.push_back(
      {.label = "friction", .x = record.t, .y = in_millijoule(record.friction), .colour = charts::kBlue});
  losses.series.push_back(
      {.label = "structure", .x = record.t, .y = in_millijoule(record.structural), .colour = charts::kGreen});
  return losses;
}

}  // namespace

Findings compute_whole_account() {
  const AccountRecord record = record_account();
  Findings findings;
  findings.checks.push_back(compare_account(record));
  findings.tables.push_back(make_account_table(record));
  findings.figures.push_back(
      {"energy_account.svg",
       "The account of one run: flexible, 0.25 mm, 10 rad/s. The losses are what work and energy differ by.",
       charts::draw({make_energy_chart(record), make_loss_chart(record)}, 2)});
  return findings;
}

}  // namespace validation
