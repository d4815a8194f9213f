#pragma once

#include "engine/clearance/contact_derivative.h"
#include "engine/math/buffer.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The contacts of a joint in the system (shift 1 - J) x = known, with their bristles z eliminated. From the derivatives by the journal's motion y
/// and by z, of which each pair answers itself alone,
///
///     load = L y + B z,  shift z - known = D y + E z,
///     z = (shift 1 - E)^-1 (known + D y),  load = (L + B (shift 1 - E)^-1 D) y + B (shift 1 - E)^-1 known
class ShiftedContact {
 public:
  static constexpr std::size_t kJournal = 12;  ///< numbers of a journal's motion

  explicit ShiftedContact(std::size_t bristles)
      : stride_(in_groups(bristles)), inverse_(2 * bristles), response_(kJournal * stride_), own_(stride_), found_(stride_) {}

  /// @param contact  with its derivatives; it and `acting` must stay as they are
  /// @returns false if the bristles' own matrix is singular
  [[nodiscard]] RPSUP_INLINE bool factor(const ContactDerivative& contact, const ActingBristles& acting, double shift) {
    contact_ = &contact;
    acting_ = acting;
    rows_ = contact.load_rows();
    bool regular = true;
    for (int i = 0; i < acting.count; i += 2) {
      const int b = acting.own[i];
      double* inverse = &inverse_[at(2 * i)];
      regular = invert_pair(b, shift, inverse) && regular;
      const ContactRow& first = contact.rate_row(b);
      const ContactRow& second = contact.rate_row(b + 1);
      for (int k = 0; k < 2; ++k) {
        const ContactRow response{combine(inverse[2 * k], first.by_position, inverse[2 * k + 1], second.by_position),
                                  combine(inverse[2 * k], first.by_rate, inverse[2 * k + 1], second.by_rate)};
        keep(i + k, response);
        for (int row = 0; row < ContactRows::kCount; ++row) {
          rows_.of[row].by_position += contact.load_by_bristle(b + k)[row] * response.by_position;
          rows_.of[row].by_rate += contact.load_by_bristle(b + k)[row] * response.by_rate;
        }
      }
    }
    return regular;
  }

  /// The load that comes of what is known of the bristles. @param z  all of this joint's
  [[nodiscard]] RPSUP_INLINE LoadVariation<double> start(const double* z) {
    Lanes load{};
    for (int i = 0; i < acting_.count; ++i) {
      const double* pair = z + (acting_.own[i] & ~1);
      const double* inverse = &inverse_[at(2 * i)];
      own_[at(i)] = inverse[0] * pair[0] + inverse[1] * pair[1];
      load += own_[at(i)] * Lanes::load(contact_->load_by_bristle(acting_.own[i]));
    }
    return {{load[0], load[1], load[2]}, {load[3], load[4], load[5]}, load[ContactRows::kImpactPower], load[ContactRows::kFrictionPower]};
  }

  /// What comes of the journal's motion, that of the bristles with it.
  template <typename T>
  [[nodiscard]] RPSUP_INLINE LoadVariation<T> apply(const JournalVariation<T>& y) const {
    return rows_.apply(y);
  }

  /// Sets the acting bristles, after start().
  RPSUP_INLINE void finish(const JournalVariation<double>& y, double* z) {
    const double numbers[kJournal] = {y.turn.x, y.turn.y, y.turn.z, y.p.x, y.p.y, y.p.z, y.v.x, y.v.y, y.v.z, y.w.x, y.w.y, y.w.z};
    for (std::size_t i = 0; i < at(acting_.count); i += Lanes::kCount) {
      Lanes found = Lanes::load(&own_[i]);
      for (std::size_t k = 0; k < kJournal; ++k) found += numbers[k] * Lanes::load(&response_[k * stride_ + i]);
      found.store(&found_[i]);
    }
    for (int i = 0; i < acting_.count; ++i) z[acting_.own[i]] = found_[at(i)];
  }

 private:
  [[nodiscard]] RPSUP_INLINE static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] static std::size_t in_groups(std::size_t n) { return (n + Lanes::kCount - 1) / Lanes::kCount * Lanes::kCount; }

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

  RPSUP_INLINE void keep(int i, const ContactRow& response) {
    for (int k = 0; k < 6; ++k) {
      response_[at(k) * stride_ + at(i)] = response.by_position[k];
      response_[at(k + 6) * stride_ + at(i)] = response.by_rate[k];
    }
  }

  const ContactDerivative* contact_ = nullptr;
  ActingBristles acting_;
  ContactRows rows_;
  std::size_t stride_;           ///< room for all bristles in whole groups
  Buffer<double> inverse_;       ///< 2 x 2 for each acting pair, row after row
  Buffer<double> response_;      ///< of the acting bristles to each number of the journal's motion, side by side
  Buffer<double> own_;           ///< what they would be with the journal held
  Buffer<double> found_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
