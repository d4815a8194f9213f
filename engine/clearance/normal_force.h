// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// Penetration (> 0 in contact; minus the gap otherwise) and its rate at one place of two surfaces.
struct Penetration {
  double delta = 0.0;  ///< [m]
  double rate = 0.0;   ///< [m/s]
};

/// Changes of a joint's contacts in a step.
struct ContactChange {
  bool any = false;     ///< some contact began or ended
  bool abrupt =
      false;  ///< and more than single elements of rings that had contact before and have some still
  int ring_onsets = 0, face_onsets = 0;  ///< rings and faces that had no contact and now have one

  ContactChange& operator+=(const ContactChange& other) {
    any |= other.any;
    abrupt |= other.abrupt;
    ring_onsets += other.ring_onsets;
    face_onsets += other.face_onsets;
    return *this;
  }
};

/// The penetration rate at the onset of a contact, kept until it ends.
///
/// A contact is delta > 0. It opens and closes between steps only; inside the step in which it begins, the
/// current rate serves.
class OnsetLatch {
 public:
  [[nodiscard]] bool in_contact() const { return rate_ > 0.0; }
  /// The latched rate; 0 without contact.
  [[nodiscard]] double rate() const { return rate_; }

  /// Moves on by a step with the penetrations at its two ends; the onset rate is read where the cubic through
  /// them crosses zero.
  /// @returns true if the contact began or ended
  bool advance(const Penetration& start, const Penetration& end, double dt, double minimum);

 private:
  double rate_ = 0.0;  ///< 0: no contact
};

static_assert(sizeof(OnsetLatch) == sizeof(double),
              "the rates of neighbours are read as numbers side by side");

/// The cubic delta(s), s in [0, 1], through two penetrations and their rates, a step of dt apart.
class PenetrationCubic {
 public:
  PenetrationCubic(const Penetration& start, const Penetration& end, double dt);

  [[nodiscard]] double delta(double s) const { return ((a_ * s + b_) * s + c_) * s + d_; }
  [[nodiscard]] double rate(double s) const { return ((3.0 * a_ * s + 2.0 * b_) * s + c_) / dt_; }
  /// Zero s of delta in [low, high], at whose ends the signs differ.
  [[nodiscard]] double find_root(double low, double high) const;
  /// Place s of the extreme of delta between two ends whose rates have opposite signs.
  [[nodiscard]] double find_extreme() const;

 private:
  double dt_;
  double a_, b_, c_, d_;
};

}  // namespace engine
