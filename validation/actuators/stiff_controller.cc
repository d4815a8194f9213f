// SPDX-License-Identifier: Apache-2.0
// The paper's linkage, its crank moved by a controller that is ever stiffer.

#include <cmath>
#include <string>
#include <utility>

#include "charts/chart.h"
#include "engine/model/rpsup_geometry.h"
#include "validation/actuators/parts.h"
#include "validation/support/runs.h"

namespace validation {

namespace {

constexpr double kPeakWithin = 1e-3;

RpsupParameters make_linkage() {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  parameters.run_up = 0.5;
  parameters.rod_law = StrokeLaw::kCycloidal;  // no jumps, which a controller could not follow
  return parameters;
}

/// @param gain  of the position, [N m/rad]; critically damped with the inertia of crank and rod
double find_peak(RpsupParameters parameters, double gain) {
  constexpr double kCrankInertia = 0.03;  // [kg m^2], about
  const RunOptions options{.duration = 2.0,
                           .integrator = Integrator::kRadau5,
                           .relative_tolerance = 1e-8,
                           .absolute_tolerance = 1e-8};
  if (gain > 0.0)
    parameters.crank_actuator = Controller{.target = crank_law(parameters),
                                           .controlled = Controller::Controlled::kPosition,
                                           .proportional = gain,
                                           .derivative = 2.0 * std::sqrt(gain * kCrankInertia)};
  return metric(run_rpsup(parameters, options), "peak_slider_acceleration_m_s2");
}

charts::Chart make_deviation_chart(charts::Series deviations) {
  charts::Chart chart{.title = "Deviation of the peak from that of the prescribed motion",
                      .x_label = "gain, N m/rad",
                      .y_label = "relative deviation",
                      .x_scale = charts::Scale::kLog,
                      .y_scale = charts::Scale::kLog};
  chart.series.push_back(std::move(deviations));
  return chart;
}

/// Deviation of the peak from that of the prescribed motion, over the gain.
charts::Series find_deviations() {
  const RpsupParameters parameters = make_linkage();
  const double prescribed = find_peak(parameters, 0.0);
  charts::Series series{.markers = true};
  for (const double gain : {1e3, 3e3, 1e4, 3e4, 1e5, 3e5}) {
    series.x.push_back(gain);
    series.y.push_back(std::abs(find_peak(parameters, gain) / prescribed - 1.0));
  }
  return series;
}

}  // namespace

Findings compute_stiff_controller() {
  charts::Series deviations = find_deviations();
  Findings findings;
  findings.checks.push_back(
      limit("peak of the slider's acceleration, the crank under control of its position with 3e5 N m/rad",
            "the prescribed motion", deviations.y.back(), kPeakWithin, "1",
            "the deviation falls with the gain: 3e5 is where it is below 0.1 %"));
  findings.figures.push_back({.file = "stiff_controller.svg",
                              .caption = "Peak of the slider's acceleration with a controller on the crank, "
                                         "against the prescribed motion, over the gain",
                              .svg = charts::draw({make_deviation_chart(std::move(deviations))}, 1)});
  return findings;
}

}  // namespace validation
