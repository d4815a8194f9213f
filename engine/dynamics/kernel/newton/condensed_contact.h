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

/// Contacts of a joint in the Newton system, with their bristles z condensed (static condensation, a Schur
/// complement of 2 x 2 blocks): Eq. (K32). From the derivatives by the journal's tangent xi and by z, of
/// which each pair depends on itself alone,
///
///     load = load_xi xi + load_z z,   sigma z - b_z = zd_xi xi + E z
///     =>   z = (sigma 1 - E)^-1 (b_z + zd_xi xi),
///          load = (load_xi + load_z (sigma 1 - E)^-1 zd_xi) xi + load_z (sigma 1 - E)^-1 b_z
///
/// @tparam Scalar  double or Complex<double>
template <typename Scalar>
class CondensedContact {
 public:
  static constexpr std::size_t kJournal = 12;  ///< numbers of a journal's motion

  explicit CondensedContact(std::size_t bristles)
      : stride_(in_row_blocks(static_cast<int>(bristles))),
        inverse_(2 * bristles),
        response_(kJournal, stride_),
        z_(1, stride_) {}

  /// Condenses the bristles. @param contact, acting  must stay as they are until finish()
  /// @returns false if sigma 1 - E is singular
  [[nodiscard]] RPSUP_INLINE bool factor(const ContactDerivative& contact, const ActingBristles& acting,
                                         const Scalar& shift) {
    contact_ = &contact;
    acting_ = acting;
    for (int row = 0; row < ContactRows::kCount; ++row) {
      const ContactRow& real = contact.load_rows().of[row];
      rows_.of[row] = {NumbersOf<Scalar>::widen(real.by_position), NumbersOf<Scalar>::widen(real.by_rate)};
    }
    bool regular = true;
    for (int i = 0; i < acting.count; i += 2) {
      const int b = acting.index[i];
      Scalar* inverse = &inverse_[2 * i];
      regular = invert_pair(b, shift, inverse) && regular;
      const ContactRow& first = contact.rate_row(b);
      const ContactRow& second = contact.rate_row(b + 1);
      for (int k = 0; k < 2; ++k) {
        const Row response{first.by_position * inverse[2 * k] + second.by_position * inverse[2 * k + 1],
                           first.by_rate * inverse[2 * k] + second.by_rate * inverse[2 * k + 1]};
        store_response(i + k, response);
        for (int row = 0; row < ContactRows::kCount; ++row) {
          rows_.of[row].by_position += contact.load_by_bristle(b + k)[row] * response.by_position;
          rows_.of[row].by_rate += contact.load_by_bristle(b + k)[row] * response.by_rate;
        }
      }
    }
    return regular;
  }

  /// The load by the right-hand side b_z, with xi = 0. @param z  b_z of all bristles of this joint
  [[nodiscard]] RPSUP_INLINE LoadTangent<Scalar> start(NumbersAt<Scalar> z) {
    const NumbersAt<Scalar> z_free = z_.first();
    Pack8 load{};
    for (int i = 0; i < acting_.count; ++i) {
      const int first = acting_.index[i] & ~1;
      const Scalar* inverse = &inverse_[2 * i];
      const Scalar z_i = inverse[0] * z[first] + inverse[1] * z[first + 1];
      z_free.set(i, z_i);
      load += Lanes::load(contact_->load_by_bristle(acting_.index[i])) * z_i;
    }
    const auto number = [&](int i) RPSUP_INLINE_LAMBDA { return number_in(load, i); };
    return {{number(0), number(1), number(2)},
            {number(3), number(4), number(5)},
            number(ContactRows::kImpactPower),
            number(ContactRows::kFrictionPower)};
  }

  /// The load by xi. @tparam T  Scalar, or a pack
  template <typename T>
  [[nodiscard]] RPSUP_INLINE LoadTangent<T> apply(const JournalTangent_b<T>& xi) const {
    return rows_.apply(xi);
  }

  /// Writes the acting bristles into z, after start().
  RPSUP_INLINE void finish(const JournalTangent_b<Scalar>& xi, NumbersAt<Scalar> z) {
    const Scalar numbers[kJournal] = {xi.rotation.x, xi.rotation.y, xi.rotation.z, xi.offset.x,
                                      xi.offset.y,   xi.offset.z,   xi.v.x,        xi.v.y,
                                      xi.v.z,        xi.w.x,        xi.w.y,        xi.w.z};
    const NumbersAt<Scalar> z_free = z_.first();
    const RowsAt<Scalar> response = response_.rows(stride_);
    for (int i = 0; i < acting_.count; i += RowLanes::kCount) {
      auto found = z_free.load(i);
      for (int k = 0; k < static_cast<int>(kJournal); ++k) found += numbers[k] * response.row(k).load(i);
      z_free.store(i, found);
    }
    for (int i = 0; i < acting_.count; ++i) z.set(acting_.index[i], z_free[i]);
  }

 private:
  using Pack8 = typename NumbersOf<Scalar>::template Block<Lanes::kCount>;
  using Row = ContactRowOf<Pack8>;

  RPSUP_INLINE bool invert_pair(int b, const Scalar& shift, Scalar* inverse) const {
    const Scalar a00 = shift - Scalar{contact_->rate_by_bristle(b, b)},
                 a11 = shift - Scalar{contact_->rate_by_bristle(b + 1, b + 1)};
    const double a01 = -contact_->rate_by_bristle(b, b + 1), a10 = -contact_->rate_by_bristle(b + 1, b);
    const Scalar inverse_determinant = 1.0 / (a00 * a11 - Scalar{a01 * a10});
    inverse[0] = a11 * inverse_determinant;
    inverse[1] = -a01 * inverse_determinant;
    inverse[2] = -a10 * inverse_determinant;
    inverse[3] = a00 * inverse_determinant;
    return is_number(size_of(inverse_determinant));
  }

  RPSUP_INLINE void store_response(int i, const Row& response) {
    const RowsAt<Scalar> to = response_.rows(stride_);
    for (int k = 0; k < 6; ++k) {
      to.row(k).set(i, number_in(response.by_position, k));
      to.row(k + 6).set(i, number_in(response.by_rate, k));
    }
  }

  const ContactDerivative* contact_ = nullptr;
  ActingBristles acting_;
  ContactRowsOf<Pack8> rows_;
  int stride_;                    ///< bristles, padded to whole blocks
  Buffer<Scalar> inverse_;        ///< (sigma 1 - E)^-1: 2 x 2 for each acting pair, row by row
  NumberRows<Scalar> response_;   ///< (sigma 1 - E)^-1 D: a row for each number of xi
  NumberRows<Scalar> z_;        ///< z with xi = 0; then z
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
