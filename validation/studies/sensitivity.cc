// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "jobs/statistics/replicate_statistics.h"
#include "validation/studies/study_chapters.h"
#include "validation/studies/text.h"

namespace validation::studies {

namespace {

constexpr double kConverged = 1e-3;  // spread over mean below which a peak is a property of its case: the
                                     // error that default tolerances aim at

ReplicateStatistics statistics_of(const StudyTable& table, const StudyCase& c, const char* metric) {
  return calc_replicate_statistics(table.numbers(table.find(c), metric));
}

Table replicates_table(const Study& study) {
  Table table{.caption =
                  "Peak of |slider acceleration| for t >= 2 s, m/s\u00b2, of five runs of 5 s: the case "
                  "itself and four whose contact stiffness differs from it "
                  "by up to 1e-6 of itself; default integrator and tolerances.",
              .head = {"case", "peak", "mean", "spread", "min", "max", "spread / mean", "RMS, mean",
                       "RMS, spread / mean", "the peak is"},
              .rows = {},
              .row_reproducible_to = {}};
  for (const std::string coupler : kCouplers)
    for (const double clearance : kClearances)
      for (const double velocity : kCrankVelocities) {
        const StudyCase c{clearance, velocity, coupler};
        const ReplicateStatistics peak = statistics_of(study.clearance, c, kPeak);
        const ReplicateStatistics rms = statistics_of(study.clearance, c, "rms_slider_acceleration_m_s2");
        const double relative = *peak.spread / *peak.mean;
        table.rows.push_back(
            {describe(c), to_text("%.2f", study.clearance.number(study.clearance.find(c).front(), kPeak)),
             to_text("%.2f", *peak.mean), to_text("%.2g", *peak.spread), to_text("%.2f", *peak.min),
             to_text("%.2f", *peak.max), to_text("%.1e", relative), to_text("%.3f", *rms.mean),
             to_text("%.1e", *rms.spread / *rms.mean),
             relative < kConverged ? "a property of the case" : "a sample"});
        table.row_reproducible_to.push_back(
            converges(c) ? 10.0 : kSampledReproducibleTo);  // spreads are residuals of rounding
      }
  return table;
}

void add_convergence(const Study& study, const StudyCase& c, Findings& findings) {
  const ReplicateStatistics peak = statistics_of(study.tighter, c, kPeak);
  findings.checks.push_back(
      limit("spread of the replicates' peak over its mean, dopri5 at 1e-9: " + describe(c),
            "a stable motion: about the perturbation itself", *peak.spread / *peak.mean, 1e-4, "1",
            "a hundred times the perturbation of the contact stiffness, 1e-6: impacts in a row multiply it"));
  const double value = study.clearance.number(study.clearance.find(c).front(), kPeak);
  const double tighter = study.tighter.number(study.tighter.find(c).front(), kPeak);
  findings.checks.push_back(compare(
      "peak at default tolerances: " + describe(c), "the same run by dopri5 at a tolerance of 1e-9", value,
      tighter, 1e-3 * tighter, "m/s\u00b2", "0.1 %: what the default tolerance is chosen for"));
}

}  // namespace

ComputedChapter sensitivity(const Study& study) {
  Findings findings;
  for (const StudyCase& c : converging_cases()) add_convergence(study, c, findings);
  findings.tables.push_back(replicates_table(study));
  return {{.name = "sensitivity",
           .title = "Sensitivity: which peaks are a property of their case",
           .text = R"(A joint with clearance may be chaotic: runs that differ by rounding part, until their
peaks share no more than a distribution. Replicates show such cases: the same run again, with the contact
stiffness changed by a relative 1e-6, far less than anyone knows it. Where the spread stays small, the peak
is a property of the case. Below 15 rad/s this is so for all peaks of the sweep, with a flexible coupler as
well, and default tolerances find these peaks. At 15 rad/s the spread grows with the errors of the
integrator: a grazing contact is met or missed, and the peak is one of two that differ by 1 or 2 %. There the
median of some replicates is the better number.

[server/API.md](../server/API.md#replicates) tells how a sweep asks for replicates.)",
           .parts = {}},
          {findings}};
}

}  // namespace validation::studies
