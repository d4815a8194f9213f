// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/analysis/run_channels.h"
#include "engine/clearance/clearance_parameters.h"
#include "engine/dynamics/evaluation.h"
#include "engine/model/rpsup_parameters.h"

namespace engine {

/// Sliding work for Archard's law: the normal force of each ring of the journal times its sliding speed, over
/// time, with the place on the bore where the ring pressed.
///
///     W = int f_n |v_t| dt,    W_n = int f_n |v_t| n dt,    worn volume = wear coefficient * W
///
/// n is the direction of the ring's offset in the bore. In a worn bore it is that, too: which part of the
/// bore presses then follows from it and from the penetration. A ring's share of the sum of normal forces is
/// that of its elastic force. Trapezoids over the steps, which end where a ring meets or leaves the bore.
class SlidingWork {
 public:
  /// Of one ring, since the start of the run.
  struct Ring {
    double work = 0.0;            ///< W, [J]
    double work_x = 0.0, work_y = 0.0;  ///< W_n in the bearing frame: its direction is the mean one, [J]
    double work_delta = 0.0;            ///< the same with the penetration in the place of n, [J m]
  };

  /// Contact of a ring with the bore; all zero where it does not touch.
  struct RingContact {
    double delta = 0.0;            ///< [m]
    double share = 0.0;            ///< in proportion to its elastic force
    double n_x = 0.0, n_y = 0.0;
    double speed = 0.0;            ///< of sliding, [m/s]
  };

  explicit SlidingWork(const RpsupParameters& parameters);
  /// @param joint  with a bore  @param index  its number among Evaluation::joints
  SlidingWork(const ClearanceParameters& joint, std::size_t index);

  void take_step(const Evaluation& start, const Evaluation& end);

  /// Fraction of the last step at a time, in [0, 1].
  [[nodiscard]] double fraction_of(double t) const {
    return end_ > start_ ? std::clamp((t - start_) / (end_ - start_), 0.0, 1.0) : 1.0;
  }
  /// A ring's at a part of the last step, in [0, 1].
  [[nodiscard]] Ring at(std::size_t ring, double part) const;
  /// Of all rings together, [J].
  [[nodiscard]] double total() const;

  /// Channels of W and W_n of each ring, and of W_delta in a worn bore, which read this.
  /// @param prefix  of their keys
  [[nodiscard]] std::vector<Channel> channels(const std::string& prefix) const;

 private:
  void calc_ring_contacts(const JointState& joint);
  /// Adds so much time of what an instant has: f_n |v_t| and its direction, of each ring. @param joint  as
  /// calc_ring_contacts() had it
  void add(const JointState& joint, double time);
  void add_ring_channels(const std::string& prefix, std::size_t ring, std::vector<Channel>& channels) const;
  /// Reading of one part of a ring's work; null without clearance.
  [[nodiscard]] Reading make_reading(std::size_t ring, double Ring::*part) const;

  const ClearanceParameters joint_;  ///< c_r = 0: without clearance
  const std::size_t index_;
  std::vector<Ring> before_, after_;  ///< at the ends of the last step
  double start_ = 0.0, end_ = -1.0;   ///< of it, [s]; the other way round if there is none
  std::vector<RingContact> contacts_;        ///< of each ring at the end of the last step
};

}  // namespace engine
