// SPDX-License-Identifier: Apache-2.0
#include "validation/studies/paper_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <tuple>

#include "engine/analysis/quantities.h"
#include "charts/chart.h"
#include "validation/studies/text.h"

namespace validation::studies {

namespace {

constexpr double kFrom = 2.0;       // [s]: the run-up is over
constexpr double kOrbitTo = 4.0;    // [s]; longer, and the orbits are a blot
constexpr std::size_t kColumns = 440;  // of pixels in a chart
constexpr std::array<const char*, 4> kColours{charts::kGreen, charts::kBlue, charts::kOrange,
                                              charts::kPurple};

/// The least and the largest acceleration of each column of pixels, one after the other: no spike is lost.
charts::Series acceleration_series(const Study& study, const StudyTable& table, const StudyCase& c,
                                   const char* colour) {
  const engine::Trajectory run =
      study.read_trajectory(table.text(table.find(c).front(), "job_id"),
                            {"slider_acceleration_min_m_s2", "slider_acceleration_max_m_s2"}, kFrom);
  const auto& [t, least, most] = std::tie(run.columns.at(0), run.columns.at(1), run.columns.at(2));
  charts::Series series{.colour = colour, .width = 1.0};
  for (std::size_t from = 0; from < t.size();) {
    const double width = (t.back() - t.front()) / static_cast<double>(kColumns);
    std::size_t to = from + 1;
    while (to < t.size() && t[to] < t[from] + width) ++to;
    const auto first = static_cast<std::ptrdiff_t>(from);
    const auto last = static_cast<std::ptrdiff_t>(to);
    series.x.insert(series.x.end(), 2, t[from]);
    series.y.push_back(*std::min_element(least.begin() + first, least.begin() + last));
    series.y.push_back(*std::max_element(most.begin() + first, most.begin() + last));
    from = to;
  }
  return series;
}

/// One drive of each velocity's ideal job.
charts::Chart draw_input(const Study& study, const char* title, const char* channel, const char* label,
                         const std::vector<std::size_t>& velocities) {
  charts::Chart chart{.title = title, .x_label = "time, s", .y_label = label};
  for (const std::size_t k : velocities) {
    const engine::Trajectory run = study.read_trajectory(
        study.ideal.text(study.ideal.find({0.0, kCrankVelocities[k], "rigid"}).front(), "job_id"), {channel},
        0.0);
    charts::Series series{.label = velocities.size() > 1 ? to_text("%g rad/s", kCrankVelocities[k]) : "",
                          .colour = kColours[k],
                          .width = 1.5};
    constexpr std::size_t kEvery = 10;  // milliseconds: the laws are smooth
    for (std::size_t i = 0; i < run.columns[0].size(); i += kEvery) {
      series.x.push_back(run.columns[0][i]);
      series.y.push_back(run.columns[1][i]);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Figure draw_inputs(const Study& study) {
  const std::vector<charts::Chart> charts{
      draw_input(study, "(a) crank (1,1)", "crank_velocity_rad_s", "velocity, rad/s", {0, 1, 2, 3}),
      draw_input(study, "(b) sliding rod (1,2)", "rod_displacement_m", "displacement, m", {0})};
  return {"fig4.svg",
          "The paper's Fig. 4: (a) crank (1,1) reaches its velocity in 2 s; (b) sliding rod (1,2) goes "
          "out and back in 1 s and pauses for 0.5 s",
          charts::draw(charts, 2)};
}

Figure draw_ideal(const Study& study) {
  std::vector<charts::Chart> charts;
  for (const std::string coupler : kCouplers) {
    charts::Chart chart{.title = "ideal joint, " + coupler + " coupler",
                        .x_label = "time, s",
                        .y_label = "slider acceleration, m/s\u00b2"};
    for (std::size_t k = std::size(kCrankVelocities); k-- > 0;) {
      charts::Series series =
          acceleration_series(study, study.ideal, {0.0, kCrankVelocities[k], coupler}, kColours[k]);
      series.label = to_text("%g rad/s", kCrankVelocities[k]);
      chart.series.push_back(series);
    }
    charts.push_back(chart);
  }
  return {"fig5.svg",
          "The paper's Fig. 5: acceleration of slider (2,1) without clearance, (a) rigid and (b) flexible "
          "coupler. Both give the same courses, whose "
          "amplitude grows with the velocity",
          charts::draw(charts, 2)};
}

Figure draw_accelerations(const Study& study, double clearance, const char* file, const char* number,
                          const char* seen) {
  std::vector<charts::Chart> charts;
  for (std::size_t k = 0; k < std::size(kCrankVelocities); ++k)
    for (const std::string coupler : kCouplers) {
      const StudyCase c{clearance, kCrankVelocities[k], coupler};
      charts.push_back({.title = describe(c),
                        .x_label = "time, s",
                        .y_label = "slider acceleration, m/s\u00b2",
                        .series = {acceleration_series(study, study.clearance, c, kColours[k])}});
    }
  return {file,
          std::string("The paper's ") + number +
              to_text(": acceleration of slider (2,1) with %g mm of radial clearance, ", clearance) +
              "left: (a) rigid, right: (b) flexible coupler. " + seen,
          charts::draw(charts, 2, 520, 240)};
}

charts::Series circle(double radius) {
  charts::Series series{.colour = charts::kGrey, .width = 1.0};
  for (int k = 0; k <= 90; ++k) {
    series.x.push_back(radius * std::cos(2.0 * std::numbers::pi * k / 90.0));
    series.y.push_back(radius * std::sin(2.0 * std::numbers::pi * k / 90.0));
  }
  return series;
}

charts::Chart draw_orbit(const Study& study, const StudyCase& c, const char* colour) {
  const engine::Trajectory run =
      study.read_trajectory(study.clearance.text(study.clearance.find(c).front(), "job_id"),
                            {"journal_x_mm", "journal_y_mm"}, kFrom);
  charts::Series orbit{.colour = colour, .width = 0.6};
  for (std::size_t i = 0; i < run.columns[0].size() && run.columns[0][i] <= kOrbitTo; ++i) {
    orbit.x.push_back(run.columns[1][i]);
    orbit.y.push_back(run.columns[2][i]);
  }
  const double edge = 1.08 * c.clearance_mm;
  return {.title = describe(c),
          .x_label = "x in the bearing, mm",
          .y_label = "y, mm",
          .x_min = -edge,
          .x_max = edge,
          .y_min = -edge,
          .y_max = edge,
          .series = {circle(c.clearance_mm), orbit},
          .equal_axes = true};
}

Figure draw_orbits(const Study& study, double clearance, const char* file, const char* number,
                   const char* seen) {
  std::vector<charts::Chart> charts;
  for (const std::string coupler : kCouplers)
    for (std::size_t k = 0; k < std::size(kCrankVelocities); ++k)
      charts.push_back(draw_orbit(study, {clearance, kCrankVelocities[k], coupler}, kColours[k]));
  return {file,
          std::string("The paper's ") + number +
              to_text(": journal centre inside the bearing from 2 s to 4 s, %g mm of radial clearance (grey: "
                      "the clearance circle), ",
                      clearance) +
              "above: (a) rigid, below: (b) flexible coupler. " + seen,
          charts::draw(charts, 4, 310, 305)};
}

}  // namespace

std::vector<Figure> draw_paper_figures(const Study& study) {
  return {
      draw_inputs(study),
      draw_ideal(study),
      draw_accelerations(study, 0.25, "fig6.svg", "Fig. 6",
                         "Peaks stand where the guide's force changes its sign, twice a turn; at 15 rad/s "
                         "the highest ones of the rigid coupler are "
                         "about twice those of the flexible one"),
      draw_accelerations(study, 0.5, "fig7.svg", "Fig. 7",
                         "At 15 rad/s the peaks are lower than with 0.25 mm, at 10 rad/s higher"),
      draw_orbits(study, 0.25, "fig8.svg", "Fig. 8",
                  "The journal slides along the lower half of the bore and turns back at its sides; at 12 "
                  "and 15 rad/s it hops there"),
      draw_orbits(
          study, 0.5, "fig9.svg", "Fig. 9",
          "The journal flies less than with 0.25 mm: hops show with the rigid coupler at 15 rad/s alone")};
}

}  // namespace validation::studies
