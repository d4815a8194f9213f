// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <utility>

#include "validation/integrators/parts.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/simple_mechanisms.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kInstantsMass = 1.0;        // [kg]
constexpr double kInstantsSpeed = 0.3;       // [m/s]
constexpr double kInstantsGap = 0.25e-3;     // [m]
constexpr double kInstantsStiffness = 4.7e10;// [N/m^1.5]
constexpr double kBand = 1e-10;  // largest distance beyond the bore of a step that ends "there", [m]

double time_in_contact() {
  // m v^2 / 2 = 2/5 K d^2.5; the time in contact is 2 d / v times the integral of (1 - u^2.5)^(-1/2) over [0, 1], 2/5 B(2/5, 1/2).
  const double deepest = std::pow(5.0 * kInstantsMass * kInstantsSpeed * kInstantsSpeed / (4.0 * kInstantsStiffness), 0.4);
  return 0.8 * std::beta(0.4, 0.5) * deepest / kInstantsSpeed;
}

/// Ends of the steps in which the mass comes into contact and leaves it.
class ContactRecord : public QuietObserver {
 public:
  void on_step(const Evaluation& start, const Evaluation& end) override {
    if (start.q[0] <= kInstantsGap && end.q[0] > kInstantsGap) onset = end.t;
    if (start.q[0] > kInstantsGap && end.q[0] <= kInstantsGap) {
      parting = end.t;
      velocity = end.qd[0];
    }
  }
  double onset = 0.0, parting = 0.0, velocity = 0.0;
};

struct Instants {
  double onset_error, end_error;  ///< [s]
  double speed_error;             ///< relative
  long evaluations;
};

Instants run_contact(RunOptions options) {
  options.duration = kInstantsGap / kInstantsSpeed + 2.0 * time_in_contact();
  options.output_rate = 1.0;
  const Mechanism mass = make_free_mass(kInstantsMass, {.c_r = kInstantsGap, .K = kInstantsStiffness, .chi = 0.0, .friction = {}, .worn = {}});
  ContactRecord record;
  const RunOutcome end = run_from(mass, options, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, kInstantsSpeed), record);
  const double onset = kInstantsGap / kInstantsSpeed;
  return {record.onset - onset, record.parting - onset - time_in_contact(), (record.velocity + kInstantsSpeed) / kInstantsSpeed, end.evaluations};
}

}  // namespace

Findings compute_contact_instants() {
  const double band = kBand / kInstantsSpeed;
  const std::string flight = "1 kg at 0.3 m/s across 0.25 mm, elastic contact: ";
  const char* reference_onset = "gap / speed";
  const char* reference_end = "onset + 2.94328 d / v, d = (5 m v^2 / (4 K))^0.4";
  Findings findings;
  Table table{.caption = flight + "errors of onset and end of contact (" + number(1e6 * time_in_contact(), 4) +
                         " us long) and of the rebound. dopri5 ends its steps there; rk4 comes upon it.",
              .head = {"integrator", "onset [s]", "end [s]", "rebound speed, relative", "evaluations"},
              .reproducible_to = 0.2};
  const auto add_row = [&table](const std::string& name, const Instants& at) {
    table.rows.push_back({name, number(at.onset_error, 2), number(at.end_error, 2), number(at.speed_error, 2), std::to_string(at.evaluations)});
  };
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    const Instants at = run_contact({.integrator = Integrator::kDopri5, .relative_tolerance = tolerance, .absolute_tolerance = 0.1 * tolerance});
    add_row("dopri5, tolerance " + number(tolerance), at);
    if (tolerance != 1e-6 && tolerance != 1e-9) continue;
    const std::string name = flight + (tolerance == 1e-6 ? "dopri5 at a tolerance of 1e-6" : "dopri5 at a tolerance of 1e-9");
    findings.checks.push_back(compare(name + ", onset", reference_onset, kInstantsGap / kInstantsSpeed + at.onset_error, kInstantsGap / kInstantsSpeed, band, "s",
                                      "a step ends at most 1e-10 m beyond the bore"));
    const double end = kInstantsGap / kInstantsSpeed + time_in_contact();
    findings.checks.push_back(compare(name + ", end", reference_end, end + at.end_error, end, band + tolerance * time_in_contact(), "s",
                                      "a step ends at most 1e-10 m beyond the bore; and the tolerance's part of the time in contact"));
    findings.checks.push_back(limit(name + ", rebound speed less impact speed, relative", "none is lost: elastic", at.speed_error, 10.0 * tolerance,
                                    "1", "ten times the tolerance, for some thirty to a hundred steps"));
  }
  for (const double step : {1e-5, 5e-6, 2.5e-6}) {
    const Instants at = run_contact({.integrator = Integrator::kRk4, .step = step});
    add_row("rk4, step " + number(step) + " s", at);
    if (step != 5e-6) continue;
    findings.checks.push_back(compare(flight + "rk4 at 5 us, onset", reference_onset, kInstantsGap / kInstantsSpeed + at.onset_error, kInstantsGap / kInstantsSpeed, step, "s",
                                      "one step"));
    const double end = kInstantsGap / kInstantsSpeed + time_in_contact();
    findings.checks.push_back(compare(flight + "rk4 at 5 us, end", reference_end, end + at.end_error, end, step, "s", "one step"));
  }
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace validation
