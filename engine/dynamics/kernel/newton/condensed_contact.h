// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/clearance/contact_derivative.h"
#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/finite.h"
#include "engine/math/lanes.h"
#include "engine/math/number_rows.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The contacts of a joint in the system (shift 1 - J) x = known, with their bristles z eliminated. From the derivatives by the journal's motion y
/// and by z, of which each pair answers itself alone,
///
///     load = L y + B z,  shift z - known = D y + E z,
///     z = (shift 1 - E)^-1 (known + D y),  load = (L + B (shift 1 - E)^-1 D) y + B (shift 1 - E)^-1 known
///
/// @tparam Scalar  double or Complex<double>
template <typename Scalar>
class ShiftedContact {
 public:
  static constexpr std::size_t kJournal = 12;  ///< numbers of a journal's motion

  explicit ShiftedContact(std::size_t bristles)
      : stride_(in_row_blocks(static_cast<int>(bristles))), inverse_(2 * bristles), response_(kJournal, stride_), own_(1, stride_) {}

  /// @param contact  with its derivatives; it and `acting` must stay as they are
  /// @returns false if the bristles' own matrix is singular
  [[nodiscard]] RPSUP_INLINE bool factor(const ContactDerivative& contact, const ActingBristles& acting, const Scalar& shift) {
    contact_ = &contact;
    acting_ = acting;
    for (int row = 0; row < ContactRows::kCount; ++row) {
      const ContactRow& real = contact.load_rows().of[row];
      rows_.of[row] = {NumbersOf<Scalar>::widen(real.by_position), NumbersOf<Scalar>::widen(real.by_rate)};
    }
    bool regular = true;
    for (int i = 0; i < acting.count; i += 2) {
      const int b = acting.own[i];
      Scalar* inverse = &inverse_[at(2 * i)];
      regular = invert_pair(b, shift, inverse) && regular;
      const ContactRow& first = contact.rate_row(b);
      const ContactRow& second = contact.rate_row(b + 1);
      for (int k = 0; k < 2; ++k) {
        const Row response{first.by_position * inverse[2 * k] + second.by_position * inverse[2 * k + 1],
                           first.by_rate * inverse[2 * k] + second.by_rate * inverse[2 * k + 1]};
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
  [[nodiscard]] RPSUP_INLINE LoadVariation<Scalar> start(NumbersAt<Scalar> z) {
    const NumbersAt<Scalar> own = own_.first();
    Wide load{};
    for (int i = 0; i < acting_.count; ++i) {
      const int first = acting_.own[i] & ~1;
      const Scalar* inverse = &inverse_[at(2 * i)];
      const Scalar z_i = inverse[0] * z[first] + inverse[1] * z[first + 1];
      own.set(i, z_i);
      load += Lanes::load(contact_->load_by_bristle(acting_.own[i])) * z_i;
    }
    const auto number = [&](int i) RPSUP_INLINE_LAMBDA { return number_in(load, i); };
    return {{number(0), number(1), number(2)}, {number(3), number(4), number(5)}, number(ContactRows::kImpactPower), number(ContactRows::kFrictionPower)};
  }

  /// What comes of the journal's motion, that of the bristles with it. @tparam T  Scalar, or several of them
  template <typename T>
  [[nodiscard]] RPSUP_INLINE LoadVariation<T> apply(const JournalVariation<T>& y) const {
    return rows_.apply(y);
  }

  /// Sets the acting bristles, after start().
  RPSUP_INLINE void finish(const JournalVariation<Scalar>& y, NumbersAt<Scalar> z) {
    const Scalar numbers[kJournal] = {y.turn.x, y.turn.y, y.turn.z, y.p.x, y.p.y, y.p.z, y.v.x, y.v.y, y.v.z, y.w.x, y.w.y, y.w.z};
    const NumbersAt<Scalar> own = own_.first();
    const RowsAt<Scalar> response = response_.rows(stride_);
    for (int i = 0; i < acting_.count; i += RowLanes::kCount) {
      auto found = own.load(i);
      for (int k = 0; k < static_cast<int>(kJournal); ++k) found += numbers[k] * response.row(k).load(i);
      own.store(i, found);
    }
    for (int i = 0; i < acting_.count; ++i) z.set(acting_.own[i], own[i]);
  }

 private:
  using Wide = typename NumbersOf<Scalar>::template Block<Lanes::kCount>;
  using Row = ContactRowOf<Wide>;

  [[nodiscard]] RPSUP_INLINE static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  RPSUP_INLINE bool invert_pair(int b, const Scalar& shift, Scalar* inverse) const {
    const Scalar a00 = shift - Scalar{contact_->rate_by_bristle(b, b)}, a11 = shift - Scalar{contact_->rate_by_bristle(b + 1, b + 1)};
    const double a01 = -contact_->rate_by_bristle(b, b + 1), a10 = -contact_->rate_by_bristle(b + 1, b);
    const Scalar inverse_determinant = 1.0 / (a00 * a11 - Scalar{a01 * a10});
    inverse[0] = a11 * inverse_determinant;
    inverse[1] = -a01 * inverse_determinant;
    inverse[2] = -a10 * inverse_determinant;
    inverse[3] = a00 * inverse_determinant;
    return is_number(size_of(inverse_determinant));
  }

  RPSUP_INLINE void keep(int i, const Row& response) {
    const RowsAt<Scalar> to = response_.rows(stride_);
    for (int k = 0; k < 6; ++k) {
      to.row(k).set(i, number_in(response.by_position, k));
      to.row(k + 6).set(i, number_in(response.by_rate, k));
    }
  }

  const ContactDerivative* contact_ = nullptr;
  ActingBristles acting_;
  ContactRowsOf<Wide> rows_;
  int stride_;                    ///< room for all bristles in whole groups
  Buffer<Scalar> inverse_;        ///< 2 x 2 for each acting pair, row after row
  NumberRows<Scalar> response_;   ///< of the acting bristles to each number of the journal's motion, side by side
  NumberRows<Scalar> own_;        ///< what they would be with the journal held; then what they are
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
