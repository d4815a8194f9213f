// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/clearance/contact_law.h"
#include "engine/model/rpsup.h"
#include "engine/simulate.h"
#include "validation/friction/parts.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kLimit = 0.16;  // [m/s]

/// Record of the sliding of a joint's rings.
class SlidingRecord : public QuietObserver {
 public:
  explicit SlidingRecord(const ClearanceParameters& joint) : joint_(joint) {}

  void on_step(const Evaluation& start, const Evaluation& end) override {
    const double dt = end.t - start.t;
    for (int ring = 0; ring < joint_.n_r; ++ring) take_ring(start.joints[0].journal, ring, dt);
    const double from = start.joints[0].load.friction_power;
    const double to = end.joints[0].load.friction_power;
    returned_ += dt * std::max(0.0, -0.5 * (from + to));
    friction_loss_ = end.energy.friction_loss;
    ratio = std::max(ratio,
                     end.joints[0].load.friction_sum / std::max(end.joints[0].load.radial_normal_sum, 1e-9));
    work_ += (end.energy.drive_work - start.energy.drive_work).cwiseAbs().sum();
    if (steps_++ == 0) first_balance_ = start.energy.calc_balance();
    imbalance_ = std::max(imbalance_, std::abs(end.energy.calc_balance() - first_balance_));
  }

  double largest = 0.0;                                              ///< sliding speed, [m/s]
  double ratio = 0.0;                                                ///< largest friction over normal force
  [[nodiscard]] double mean() const { return path_ / time_; }        ///< [m/s]
  [[nodiscard]] double share_beyond() const { return beyond_ / time_; }
  [[nodiscard]] double share_returned() const { return returned_ / friction_loss_; }
  [[nodiscard]] double residual() const {
    return imbalance_ / work_;
  }  ///< of the energy account, over the work done

 private:
  void take_ring(const JournalMotion& journal, int ring, double dt) {
    const Eigen::Vector3d axial = calc_ring_position(joint_, ring) * journal.R_bj.col(2);
    const Eigen::Vector3d centre = journal.p_bj + axial;
    const double distance = std::hypot(centre.x(), centre.y());
    if (!(distance > joint_.c_r)) return;
    const Eigen::Vector3d n(centre.x() / distance, centre.y() / distance, 0.0);
    const Eigen::Vector3d velocity = journal.calc_velocity(axial + joint_.r_j() * n);
    const double speed = (velocity - n.dot(velocity) * n).norm();
    time_ += dt;
    path_ += dt * speed;
    if (speed > kLimit) beyond_ += dt;
    largest = std::max(largest, speed);
  }

  ClearanceParameters joint_;
  double time_ = 0.0, path_ = 0.0, beyond_ = 0.0;
  double returned_ = 0.0, friction_loss_ = 0.0;
  double first_balance_ = 0.0, imbalance_ = 0.0, work_ = 0.0;
  long steps_ = 0;
};

struct RunCase {
  double c_r, crank_velocity, duration;
};

SlidingRecord record_sliding(const RunCase& c) {
  RpsupParameters parameters;
  parameters.c_r = c.c_r;
  parameters.crank_velocity = c.crank_velocity;
  const Rpsup rpsup = build_rpsup(parameters);
  SlidingRecord record(*rpsup.mechanism.cut_joints[0].clearance);
  (void)simulate(rpsup.mechanism, {.duration = c.duration, .output_rate = 10.0}, record);
  return record;
}

void add_run_case(Findings& findings, Table& table, const RunCase& c) {
  const SlidingRecord record = record_sliding(c);
  table.rows.push_back({number(1e3 * c.c_r), number(c.crank_velocity), number(c.duration),
                        number(record.largest), number(record.mean()),
                        number(100.0 * record.share_beyond(), 2) + " %", number(record.ratio),
                        number(100.0 * record.share_returned(), 2) + " %"});
  findings.checks.push_back(limit("rigid, " + number(1e3 * c.c_r) + " mm, " + number(c.crank_velocity) +
                                      " rad/s, " + number(c.duration) +
                                      " s: change of energy less work plus losses, over the work",
                                  "none: friction loses what its force does", record.residual(), 1e-6, "1",
                                  "tolerance of the integration, 1e-6"));
}

}  // namespace

Findings compute_sliding_speeds() {
  Findings findings;
  Table table{.caption =
                  "How fast the journal slides where it touches the bore (rigid coupler, defaults). Energy "
                  "returned: by bristles that "
                  "spring back, as a share of the energy lost to friction.",
              .head = {"clearance [mm]", "crank [rad/s]", "duration [s]", "largest speed [m/s]", "mean [m/s]",
                       "contact time beyond 0.16 m/s", "largest friction / normal force", "energy returned"},
              .reproducible_to = 0.05,
              .keys = 3};
  for (const RunCase& c : {RunCase{0.25e-3, 10.0, 4.0}, RunCase{0.5e-3, 15.0, 4.0}})
    add_run_case(findings, table, c);
  findings.tables.push_back(table);
  return findings;
}

}  // namespace validation
