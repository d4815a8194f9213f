// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "engine/dynamics/motion_system.h"
#include "engine/model/rpsup.h"
#include "tests/bench/support/cases.h"

namespace bench {

/// A linkage at t = 0 with every ring in contact (or its ideal joint closed), to be evaluated again and
/// again.
class ContactState {
 public:
  /// @param instruction_set  one of engine::instruction_sets(); empty: the best one
  explicit ContactState(const engine::RpsupParameters& parameters, std::string_view instruction_set = {})
      : rpsup_(engine::build_rpsup(parameters)),
        system_(rpsup_.mechanism, instruction_set),
        at_(system_.make_evaluation()) {
    const Coordinates at = assemble_in_contact(parameters, rpsup_);
    y_ = system_.make_state(at.q, at.qd);
    dydt_ = Eigen::VectorXd::Zero(y_.size());
    settle();
  }
  ContactState(const ContactState&) = delete;  // the system refers to the mechanism
  ContactState& operator=(const ContactState&) = delete;

  /// @param t  an instant whose drives are near those at 0, [s]: the motion of the last ones is kept
  void evaluate(double t = 0.0) { (void)system_.calc_derivative(t, y_, dydt_); }

  [[nodiscard]] double penetration() const { return at_.joints[0].load.max_penetration; }

 private:
  /// Moves the elements' bristles to where the contact is, and makes room for them.
  void settle() {
    (void)system_.calc_derivative(0.0, y_, dydt_, at_);
    (void)system_.prepare_step(at_, 1e-9, y_);
    while (system_.calc_derivative(0.0, y_, dydt_, at_) == engine::EvaluationStatus::kBristleMissing) {
      system_.widen_bristles(y_);
      dydt_.setZero(y_.size());
    }
  }

  engine::Rpsup rpsup_;
  engine::MotionSystem system_;
  engine::Evaluation at_;
  Eigen::VectorXd y_, dydt_;
};

}  // namespace bench
