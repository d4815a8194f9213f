#pragma once

#include <algorithm>

namespace engine {

/// Penetration (> 0 in contact; minus the gap otherwise) and its rate at one place of two surfaces.
struct Penetration {
  double delta = 0.0;  ///< [m]
  double rate = 0.0;   ///< [m/s]
};

/// Normal force and what of it is elastic.
struct NormalForce {
  double total = 0.0;    ///< f_n, [N], >= 0
  double elastic = 0.0;  ///< [N]
  /// Power that the contact takes from the motion for good.
  [[nodiscard]] double calc_loss_power(double rate) const { return (total - elastic) * rate; }
};

/// Lankarani and Nikravesh's damping on a given elastic force, Eq. (11.1): f_n = f_e (1 + chi rate / rate_onset), never negative.
///
/// With chi = 3/4 (1 - k_r^2) the rebound is not k_r times the impact velocity: k_r = 0.9 returns 0.9132.
[[nodiscard]] inline NormalForce calc_normal_force(double elastic, double rate, double onset_rate, double chi) {
  return {std::max(0.0, elastic * (1.0 + chi * rate / onset_rate)), elastic};
}

/// What became of a joint's contacts in a step.
struct ContactChange {
  bool any = false;     ///< some contact began or ended
  int ring_onsets = 0;  ///< rings that had no contact and now have one
};

/// The penetration rate at the onset of a contact, kept until it ends.
///
/// A contact is delta > 0. It opens and closes between steps only; inside the step in which it begins, the current rate serves.
class OnsetLatch {
 public:
  [[nodiscard]] bool in_contact() const { return rate_ > 0.0; }

  /// The rate for the normal force: the latched one, or in a contact that has just begun the current one.
  [[nodiscard]] double onset_rate(double current_rate, double minimum) const {
    return in_contact() ? rate_ : std::max(current_rate, minimum);
  }

  /// Moves on by a step with the penetrations at its two ends; the onset rate is read where the cubic through them crosses zero.
  /// @returns true if the contact began or ended
  bool advance(const Penetration& start, const Penetration& end, double dt, double minimum);

 private:
  double rate_ = 0.0;  ///< 0: no contact
};

/// The cubic delta(s), s in [0, 1], through two penetrations and their rates, a step of dt apart.
class PenetrationCubic {
 public:
  PenetrationCubic(const Penetration& start, const Penetration& end, double dt);

  [[nodiscard]] double delta(double s) const { return ((a_ * s + b_) * s + c_) * s + d_; }
  [[nodiscard]] double rate(double s) const { return ((3.0 * a_ * s + 2.0 * b_) * s + c_) / dt_; }
  /// Where it crosses zero in [low, high], given that the signs differ there.
  [[nodiscard]] double find_root(double low, double high) const;
  /// Where the extreme lies that is between two ends whose rates have opposite signs.
  [[nodiscard]] double find_extreme() const;

 private:
  double dt_;
  double a_, b_, c_, d_;
};

}  // namespace engine
