#pragma once

#include "engine/clearance/contact_derivative.h"
#include "engine/math/buffer.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The contacts of a joint in the system (shift 1 - J) x = known: what they do where their bristles answer, too. With the derivatives
///
///     load = L y + B z,  rate of z = R y + S z  =>  z = (shift 1 - S)^-1 (known + R y)
///
/// by the journal's motion y and the bristles z, of which each pair answers itself alone.
class ShiftedContact {
 public:
  explicit ShiftedContact(std::size_t bristles) : acting_(bristles), inverse_(2 * bristles), response_(bristles), own_(bristles) {}

  /// @param contact  with its derivatives  @param acting  bristles of this joint that touch, in pairs
  /// @returns false if the bristles' own matrix is singular
  [[nodiscard]] RPSUP_INLINE bool factor(const ContactDerivative& contact, const int* acting, int count, double shift) {
    contact_ = &contact;
    rows_ = contact.load_rows();
    count_ = count;
    bool regular = true;
    for (int i = 0; i < count; i += 2) {
      const int b = acting[i];
      acting_[at(i)] = b;
      acting_[at(i + 1)] = b + 1;
      regular = invert_pair(b, shift, &inverse_[at(2 * i)]) && regular;
      answer(i, contact.rate_row(b).by_position, contact.rate_row(b + 1).by_position, &ContactRow::by_position);
      answer(i, contact.rate_row(b).by_rate, contact.rate_row(b + 1).by_rate, &ContactRow::by_rate);
      for (int pair = 0; pair < 2; ++pair)
        for (int row = 0; row < ContactRows::kCount; ++row) add_response(i + pair, contact.load_by_bristle(b + pair)[row], rows_.of[row]);
    }
    return regular;
  }

  /// The load that comes of what is known of the bristles. @param z  all of this joint's
  [[nodiscard]] RPSUP_INLINE LoadVariation<double> start(const double* z) {
    double load[ContactRows::kCount] = {};
    for (int i = 0; i < count_; i += 2) {
      const double first = z[acting_[at(i)]], second = z[acting_[at(i + 1)]];
      for (int pair = 0; pair < 2; ++pair) {
        const double* inverse = &inverse_[at(2 * (i + pair))];
        own_[at(i + pair)] = inverse[0] * first + inverse[1] * second;
        const double* by = contact_->load_by_bristle(acting_[at(i + pair)]);
        for (int row = 0; row < ContactRows::kCount; ++row) load[row] += by[row] * own_[at(i + pair)];
      }
    }
    return {{load[0], load[1], load[2]}, {load[3], load[4], load[5]}, load[ContactRows::kImpactPower], load[ContactRows::kFrictionPower]};
  }

  /// What comes of the journal's motion, that of the bristles with it.
  template <typename T>
  [[nodiscard]] RPSUP_INLINE LoadVariation<T> apply(const JournalVariation<T>& y) const {
    return rows_.apply(y);
  }

  /// Sets the acting bristles, after start().
  RPSUP_INLINE void finish(const JournalVariation<double>& y, double* z) const {
    for (int i = 0; i < count_; ++i) z[acting_[at(i)]] = own_[at(i)] + response_[at(i)].apply(y);
  }

 private:
  [[nodiscard]] RPSUP_INLINE static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  RPSUP_INLINE bool invert_pair(int b, double shift, double* inverse) const {
    const double a00 = shift - contact_->rate_by_bristle(b, b), a01 = -contact_->rate_by_bristle(b, b + 1);
    const double a10 = -contact_->rate_by_bristle(b + 1, b), a11 = shift - contact_->rate_by_bristle(b + 1, b + 1);
    const double inverse_determinant = 1.0 / (a00 * a11 - a01 * a10);
    inverse[0] = a11 * inverse_determinant;
    inverse[1] = -a01 * inverse_determinant;
    inverse[2] = -a10 * inverse_determinant;
    inverse[3] = a00 * inverse_determinant;
    return is_number(inverse_determinant);
  }

  /// How a pair answers the journal's motion: of its rates' rows.
  RPSUP_INLINE void answer(int i, const Lanes& first, const Lanes& second, Lanes ContactRow::*part) {
    const double* inverse = &inverse_[at(2 * i)];
    response_[at(i)].*part = combine(inverse[0], first, inverse[1], second);
    response_[at(i + 1)].*part = combine(inverse[2], first, inverse[3], second);
  }

  RPSUP_INLINE void add_response(int i, double by, ContactRow& row) const {
    row.by_position += by * response_[at(i)].by_position;
    row.by_rate += by * response_[at(i)].by_rate;
  }

  const ContactDerivative* contact_ = nullptr;
  ContactRows rows_;
  int count_ = 0;                ///< bristles that act
  Buffer<int> acting_;
  Buffer<double> inverse_;       ///< 2 x 2 for each pair, row after row
  Buffer<ContactRow> response_;  ///< of the acting bristles
  Buffer<double> own_;           ///< what they would be with the journal held
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
