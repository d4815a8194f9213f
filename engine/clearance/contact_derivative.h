// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/joint_contact.h"
#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/dual_vec3.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Tangent of the journal's motion in the bearing, all in {b}. (JournalTangent_W is the same in W.) @tparam T
/// a number, or a pack
template <typename T>
struct JournalTangent_b {
  Vec3<T> rotation, offset;  ///< of {j}, [rad]; of the journal's centre, [m]
  Vec3<T> v, w;         ///< of the centre's velocity, [m/s], and of the angular velocity, [rad/s]
};

/// Tangent of the load of a joint's contacts, and of the powers that they dissipate.
template <typename T>
struct LoadTangent {
  Vec3<T> force, moment;
  T impact_power{}, friction_power{};
};

/// The acting bristles of a joint: those that touch or are bent. The others have no force and no rate.
struct ActingBristles {
  int first = 0;             ///< of the joint's bristles among all
  const int* index = nullptr;  ///< of each acting one among the joint's, in pairs
  int count = 0;
};

/// The derivatives of one number by the journal's motion, and by the two bristles of a contact point. @tparam
/// Block  eight numbers side by side
template <typename Block>
struct ContactRowOf {
  Block by_position;  ///< rotation, offset
  Block by_rate;      ///< v, w, and the contact point's own two bristles

  template <typename T>
  [[nodiscard]] RPSUP_INLINE T apply(const JournalTangent_b<T>& journal) const {
    return dot3(by_position, 0, journal.rotation) + dot3(by_position, 3, journal.offset) +
           dot3(by_rate, 0, journal.v) + dot3(by_rate, 3, journal.w);
  }
  template <typename T>
  [[nodiscard]] RPSUP_INLINE static T dot3(const Block& by, int first, const Vec3<T>& v) {
    return number_in(by, first) * v.x + number_in(by, first + 1) * v.y + number_in(by, first + 2) * v.z;
  }
};
using ContactRow = ContactRowOf<Lanes>;

/// Rows of the whole load of a joint's contacts: force and moment on the journal, about its centre, in {b},
/// and powers.
template <typename Block>
struct ContactRowsOf {
  static constexpr int kImpactPower = 6, kFrictionPower = 7, kCount = 8;

  template <typename T>
  [[nodiscard]] RPSUP_INLINE LoadTangent<T> apply(const JournalTangent_b<T>& journal) const {
    const auto row = [&](int i) RPSUP_INLINE_LAMBDA { return of[i].apply(journal); };
    return {{row(0), row(1), row(2)}, {row(3), row(4), row(5)}, row(kImpactPower), row(kFrictionPower)};
  }

  ContactRowOf<Block> of[kCount];
};
using ContactRows = ContactRowsOf<Lanes>;

/// The derivatives of all that a joint's contacts do, by the twelve numbers of the journal's motion and by
/// the bristles. Each contact point reads its own two bristles alone: the bristles of all contact points
/// share two directions.
class ContactDerivative {
 public:
  explicit ContactDerivative(std::size_t bristles)
      : constant_bristles_(bristles),
        bristles_(bristles),
        rates_(bristles),
        by_bristle_(bristles),
        rate_rows_(bristles) {
    for (std::size_t b = 0; b < bristles; ++b)
      bristles_[b] = Dual(0.0, Lanes::unit(kBristleLane + static_cast<int>(b % 2)));
  }

  /// @param bristles  of all joints; derivatives of those that do not act are not set
  RPSUP_INLINE void calc(const ClearanceJoint& joint, const RelativeMotion<double, double>& journal,
                         const double* bristles, const ActingBristles& acting) {
    set_bristles(bristles + acting.first, acting);
    differentiate_by_position(joint, journal, acting);
    differentiate_by_rate(joint, journal, acting);
    relax_bristles(acting);
  }

  /// Tangent of the load by that of the journal's motion, the bristles constant.
  template <typename T>
  [[nodiscard]] RPSUP_INLINE LoadTangent<T> apply(const JournalTangent_b<T>& journal) const {
    return rows_.apply(journal);
  }

  /// Derivative of a bristle's rate by one of the two bristles of its contact point.
  [[nodiscard]] RPSUP_INLINE double rate_by_bristle(int bristle, int by) const {
    return rate_rows_[static_cast<std::size_t>(bristle)].by_rate[kBristleLane + by % 2];
  }

  /// @returns whether the load has any derivative but zero
  [[nodiscard]] RPSUP_INLINE bool acts() const {
    for (const ContactRow& row : rows_.of)
      for (int lane = 0; lane < Lanes::kCount; ++lane)
        if (row.by_position[lane] != 0.0 || row.by_rate[lane] != 0.0) return true;
    return false;
  }
  [[nodiscard]] RPSUP_INLINE const ContactRows& load_rows() const { return rows_; }
  [[nodiscard]] RPSUP_INLINE const ContactRow& rate_row(int bristle) const {
    return rate_rows_[static_cast<std::size_t>(bristle)];
  }
  /// Of the outputs of ContactRows, by a bristle.
  [[nodiscard]] RPSUP_INLINE const double* load_by_bristle(int bristle) const {
    return by_bristle_[static_cast<std::size_t>(bristle)].output;
  }

 private:
  static constexpr int kOutputs = ContactRows::kCount;
  static constexpr int kBristleLane = 6;  ///< the first of its lanes in by_rate

  struct ByBristle {
    double output[kOutputs];
  };

  /// A load that records the derivatives by the two bristles of each contact point.
  struct LoadPerContactPoint : JointLoad<Dual> {
    RPSUP_INLINE void end_contact_point(int bristle) {
      const Lanes now[kOutputs] = {force.x.d,  force.y.d,  force.z.d,      moment.x.d,
                                   moment.y.d, moment.z.d, impact_power.d, friction_power.d};
      for (int i = 0; i < kOutputs; ++i)
        for (int k = 0; k < 2; ++k) {
          by_bristle[bristle + k].output[i] = now[i][kBristleLane + k] - before[k][i];
          before[k][i] = now[i][kBristleLane + k];
        }
    }
    ByBristle* by_bristle = nullptr;
    double before[2][kOutputs] = {};
  };

  RPSUP_INLINE void set_bristles(const double* values, const ActingBristles& acting) {
    for (int i = 0; i < acting.count; ++i) {
      const auto b = static_cast<std::size_t>(acting.index[i]);
      constant_bristles_[b].value = bristles_[b].value = values[b];
      rates_[b] = Dual(0.0);
      by_bristle_[b] = {};
    }
  }
  /// Those that do not act are zero, and so is what they do.
  RPSUP_INLINE void relax_bristles(const ActingBristles& acting) {
    for (int i = 0; i < acting.count; ++i) {
      const auto b = static_cast<std::size_t>(acting.index[i]);
      constant_bristles_[b].value = bristles_[b].value = 0.0;
    }
  }

  RPSUP_INLINE void differentiate_by_position(const ClearanceJoint& joint,
                                              const RelativeMotion<double, double>& journal,
                                              const ActingBristles& acting) {
    const Vec3<Lanes> rotation{Lanes::unit(0), Lanes::unit(1), Lanes::unit(2)};
    const auto rotated = [&](const Vec3<double>& u)
                            RPSUP_INLINE_LAMBDA { return join(u, cross(rotation, u)); };
    const Vec3<Lanes> shift{Lanes::unit(3), Lanes::unit(4), Lanes::unit(5)};
    const RelativeMotion<Dual, Dual> seeded{
        {rotated(journal.R.x), rotated(journal.R.y), rotated(journal.R.z)},
        join(journal.p, shift),
        join(journal.v, Vec3<Lanes>{}),
        join(journal.w, Vec3<Lanes>{})};
    JointLoad<Dual> load;
    (void)add_contacts(joint, seeded, constant_bristles_.data(), rates_.data(), load);
    store(load, acting, &ContactRow::by_position);
  }

  RPSUP_INLINE void differentiate_by_rate(const ClearanceJoint& joint,
                                          const RelativeMotion<double, double>& journal,
                                          const ActingBristles& acting) {
    const RelativeMotion<double, Dual> seeded{
        journal.R, journal.p, join(journal.v, Vec3<Lanes>{Lanes::unit(0), Lanes::unit(1), Lanes::unit(2)}),
        join(journal.w, Vec3<Lanes>{Lanes::unit(3), Lanes::unit(4), Lanes::unit(5)})};
    LoadPerContactPoint load;
    load.by_bristle = by_bristle_.data();
    (void)add_contacts(joint, seeded, bristles_.data(), rates_.data(), load);
    store(load, acting, &ContactRow::by_rate);
  }

  RPSUP_INLINE void store(const JointLoad<Dual>& load, const ActingBristles& acting,
                          Lanes ContactRow::*part) {
    const Dual* outputs[kOutputs] = {&load.force.x,      &load.force.y,       &load.force.z,
                                     &load.moment.x,     &load.moment.y,      &load.moment.z,
                                     &load.impact_power, &load.friction_power};
    for (int i = 0; i < kOutputs; ++i) rows_.of[i].*part = outputs[i]->d;
    for (int i = 0; i < acting.count; ++i) {
      const auto b = static_cast<std::size_t>(acting.index[i]);
      rate_rows_[b].*part = rates_[b].d;
    }
  }

  Buffer<Dual> constant_bristles_, bristles_, rates_;
  ContactRows rows_;
  Buffer<ByBristle> by_bristle_;      ///< of the same, by each bristle
  Buffer<ContactRow> rate_rows_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
