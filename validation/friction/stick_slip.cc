// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "charts/chart.h"
#include "validation/friction/parts.h"
#include "validation/friction/published_law.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/simple_mechanisms.h"

namespace validation {

namespace {

constexpr double kPull = 0.1;      // [m/s]
constexpr double kDuration = 25.0; // [s]

/// The mass's position and what pulls and holds it.
class SliderRecord : public QuietObserver {
 public:
  void on_step(const Evaluation& /*start*/, const Evaluation& end) override { take_normal(end); }
  void on_sample(const Evaluation& at) override {
    t.push_back(at.t);
    position.push_back(at.q[0] + at.q[1]);
    end_of_spring.push_back(at.q[0]);
    friction.push_back(at.joints[0].load.friction_sum);
    take_normal(at);
  }

  std::vector<double> t, position, end_of_spring, friction;
  double normal_off = 0.0;  ///< largest |f_n - 1 N|

 private:
  void take_normal(const Evaluation& at) {
    normal_off = std::max(normal_off, std::abs(at.joints[0].load.radial_normal_sum - 1.0));
  }
};

SliderRecord record_stick_slip() {
  const Mechanism slider = make_slider(published_law(), kPull, 2.0);
  RunOptions options;
  options.duration = kDuration;
  options.output_rate = 40.0;
  options.integrator = Integrator::kDopri5;
  options.relative_tolerance = 1e-10;
  options.absolute_tolerance = 1e-13;
  options.step_limit = 1'000'000;  // some 75,000 are needed
  SliderRecord record;
  run_from(slider, options, Eigen::Vector3d(0.0, 0.0, resting_height(slider)),
           Eigen::Vector3d(0.0, -kPull, 0.0), record);
  return record;
}

Figure draw_stick_slip(const SliderRecord& record) {
  charts::Chart position{.title = "position", .x_label = "t [s]", .y_label = "[m]", .y_max = 3.2};
  position.series.push_back({.label = "mass", .x = record.t, .y = record.position});
  position.series.push_back(
      {.label = "end of the spring", .x = record.t, .y = record.end_of_spring, .colour = charts::kGrey});
  charts::Chart force{.title = "friction force", .x_label = "t [s]", .y_label = "[N]"};
  force.series.push_back({.x = record.t, .y = record.friction, .colour = charts::kOrange});
  return {"friction_stick_slip.svg",
          "Stick-slip: 1 kg pulled by a spring of 2 N/m whose end moves at 0.1 m/s, computed as a mechanism "
          "with a clearance joint.",
          charts::draw({position, force}, 2)};
}

}  // namespace

Findings compute_stick_slip() {
  const SliderRecord record = record_stick_slip();
  Findings findings;
  findings.checks.push_back(compare(
      "stick-slip (1 kg, spring 2 N/m pulled at 0.1 m/s from rest), the whole engine: position after 25 s",
      "a program of its own for this experiment: the law for one direction, 80-bit numbers, Fehlberg 7(8) at "
      "1e-15",
      record.position.back(), 1.9088391992, 1e-10, "m",
      "the reference is known to ten decimals; dopri5 at a tolerance of 1e-10"));
  findings.checks.push_back(limit(
      "stick-slip: normal force on the sliding journal", "1 N, the weight of the mass", record.normal_off,
      1e-9, "N", "penetration of 0.46 mm as the difference of lengths near 1 mm: rounding times K"));
  findings.figures.push_back(draw_stick_slip(record));
  return findings;
}

}  // namespace validation
