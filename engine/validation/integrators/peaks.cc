#include <cmath>
#include <string>
#include <utility>

#include "engine/validation/integrators/parts.h"
#include "engine/validation/support/runs.h"
#include "engine/validation/support/text.h"

namespace engine::validation {

namespace {

struct PeakCase {
  std::string name;
  Coupler coupler;
  double c_r, crank_velocity;
};

}  // namespace

Findings compute_peaks() {
  Findings findings;
  Table table{.caption = "Largest slider acceleration in [2 s, 4 s] by two methods that share neither formula nor step.",
              .head = {"case", "dopri5, default tolerance [m/s²]", "at [s]", "rk4, 5 us [m/s²]", "at [s]"},
              .reproducible_to = 1e-4};
  for (const PeakCase& c : {PeakCase{"rigid, 0.25 mm, 5 rad/s", Coupler::kRigid, 0.25e-3, 5.0},
                            PeakCase{"rigid, 0.5 mm, 10 rad/s", Coupler::kRigid, 0.5e-3, 10.0},
                            PeakCase{"flexible, 0.25 mm, 5 rad/s", Coupler::kFlexible, 0.25e-3, 5.0}}) {
    RpsupParameters parameters;
    parameters.coupler = c.coupler;
    parameters.c_r = c.c_r;
    parameters.crank_velocity = c.crank_velocity;
    const RunResult dopri5 = run_rpsup(parameters, {.duration = 4.0, .output_rate = 10.0});
    const RunResult rk4 = run_rpsup(parameters, {.duration = 4.0, .output_rate = 10.0, .integrator = Integrator::kRk4, .step = 5e-6});
    const double peak = metric(dopri5, "peak_slider_acceleration_m_s2");
    const double other = metric(rk4, "peak_slider_acceleration_m_s2");
    const double time = metric(dopri5, "peak_slider_acceleration_time_s");
    const double other_time = metric(rk4, "peak_slider_acceleration_time_s");
    findings.checks.push_back(compare(c.name + ", 4 s: peak acceleration of the slider by dopri5 at its default tolerance", "rk4 in steps of 5 us", peak,
                                      other, 1e-4 * other, "m/s²", "each is right to some 1e-5: see the table of work and precision"));
    findings.checks.push_back(compare(c.name + ", 4 s: time of that peak", "rk4 in steps of 5 us", time, other_time, 1e-6, "s",
                                      "the same impact, at a thousandth of its length"));
    table.rows.push_back({c.name, number(peak, 7), number(time, 8), number(other, 7), number(other_time, 8)});
  }
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace engine::validation
