// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "validation/studies/study_chapters.h"
#include "validation/studies/text.h"

namespace validation::studies {

namespace {

void add_case(const StudyTable& table, const StudyCase& c, Findings& findings) {
  const std::size_t row = table.find(c).front();
  const double residual = table.number(row, "energy_residual");
  findings.checks.push_back(limit("energy account: " + describe(c), "conservation of energy", residual, 1e-6,
                                  "1", "of the work turned over; what default tolerances are meant to keep"));
  findings.tables[0].rows.push_back({describe(c), to_text("%.4g", table.number(row, "impact_loss_j")),
                                     to_text("%.4g", table.number(row, "friction_work_j")),
                                     to_text("%.4g", table.number(row, "structural_loss_j")),
                                     to_text("%.1e", residual)});
  findings.tables[0].row_reproducible_to.push_back(converges(c) ? 3.0 : kSampledReproducibleTo);
}

}  // namespace

ComputedChapter energy_of_the_grid(const Study& study) {
  Findings findings;
  findings.tables.push_back({.caption = "What was lost in 5 s, and what the account leaves open.",
                             .head = {"case", "impact [J]", "friction [J]", "structure [J]", "residual"},
                             .rows = {},
                             .row_reproducible_to = {}});
  for (const std::string coupler : kCouplers) {
    for (const double velocity : kCrankVelocities) add_case(study.ideal, {0.0, velocity, coupler}, findings);
    for (const double clearance : kClearances)
      for (const double velocity : kCrankVelocities)
        add_case(study.clearance, {clearance, velocity, coupler}, findings);
  }
  return {{.name = "energy_of_the_grid",
           .title = "Energy over the paper's grid",
           .text = R"(The energy, less the work of the drives, plus the losses to impacts, friction and the
coupler's dampers, is constant. The residual is the largest departure in a whole run of 5 s at default
settings, over the work turned over in the run (drives and losses, without sign).)",
           .parts = {}},
          {findings}};
}

}  // namespace validation::studies
