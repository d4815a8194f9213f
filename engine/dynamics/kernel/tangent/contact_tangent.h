// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/contact_derivative.h"
#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/dynamics/newton_euler.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// How a journal's place and motion against its bearing vary, in W, as an observer sees them who turns with the bearing.
template <typename T>
struct VariedJournal {
  Vec3<T> turn, offset;
  Vec3<T> v, w;
};

/// How a frame varies whose origin is at r from that of f, and which moves with it: its turn, shift, v and w.
template <typename T>
[[nodiscard]] RPSUP_INLINE VariedFrame<T> move_origin(VariedFrame<T> f, const Vec3<double>& r) {
  f.shift += cross(f.turn, r);
  f.v += cross(f.w, r);
  return f;
}

/// @param b, j  variations of bearing and journal
template <typename T>
[[nodiscard]] RPSUP_INLINE VariedJournal<T> vary_journal(const CutJointMotion<double, double>& cut, const VariedFrame<T>& b,
                                                         const VariedFrame<T>& j) {
  const Vec3<double> d = cut.j.p - cut.b.p;
  VariedJournal<T> varied;
  varied.turn = j.turn - b.turn;
  varied.offset = j.shift - b.shift - cross(b.turn, d);
  varied.w = j.w + cross(varied.turn, cut.j.w) - b.w;
  varied.v = j.v + cross(varied.turn, cut.j.v) - b.v - cross(b.w, d) - cross(cut.b.w, varied.offset);
  return varied;
}

/// In {b}. @param R  the bearing's
template <typename T>
[[nodiscard]] RPSUP_INLINE JournalVariation<T> see_from_bearing(const Mat3<double>& R, const VariedJournal<T>& varied) {
  return {transpose_times(R, varied.turn), transpose_times(R, varied.offset), transpose_times(R, varied.v), transpose_times(R, varied.w)};
}

/// How what the bodies of bearing and journal need varies with the load of their contacts, about their origins, each seen by the observer who
/// turns with it.
template <typename T>
struct VariedNeed {
  SpatialForce<T> of_bearing, of_journal;
};

/// @param turn, offset  of the journal, as VariedJournal has them
/// @param load          in {b}
/// @param bearing_arm, journal_arm  from the bodies' origins to the journal's centre
template <typename T>
[[nodiscard]] RPSUP_INLINE VariedNeed<T> vary_need(const CutJointMotion<double, double>& cut, const Vec3<T>& turn, const Vec3<T>& offset,
                                                   const LoadVariation<T>& load, const Vec3<double>& bearing_arm, const Vec3<double>& journal_arm) {
  const Vec3<T> force = cut.b.R * load.force;
  const Vec3<T> moment = cut.b.R * load.moment;
  const Vec3<T> own_force = force - cross(turn, cut.reaction);
  const Vec3<T> own_moment = moment - cross(turn, cut.b.R * cut.load.moment);
  VariedNeed<T> need;
  need.of_bearing = {force, moment + cross(bearing_arm, force) + cross(offset, cut.reaction)};
  need.of_journal = {-own_force, -(own_moment + cross(journal_arm, own_force))};
  return need;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
