// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/clearance/contact_derivative.h"
#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/dynamics/newton_euler.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Tangent of the journal's motion in the bearing, in W, corotational with the bearing. (JournalTangent_b is
/// the same in {b}.)
template <typename T>
struct JournalTangent_W {
  Vec3<T> rotation, offset;  ///< of {j} in {b}; of the journal's centre from the bearing's
  Vec3<T> v, w;
};

/// Tangent of a journal's motion from those of bearing and journal, Eq. (K19).
template <typename T>
[[nodiscard]] RPSUP_INLINE JournalTangent_W<T> calc_journal_tangent(const CutJointMotion<double, double>& cut,
                                                                    const FrameTangent<T>& b,
                                                                    const FrameTangent<T>& j) {
  const Vec3<double> d = cut.j.p - cut.b.p;
  JournalTangent_W<T> journal;
  journal.rotation = j.rotation - b.rotation;
  journal.offset = j.translation - b.translation - cross(b.rotation, d);
  journal.w = j.w + cross(journal.rotation, cut.j.w) - b.w;
  journal.v = j.v + cross(journal.rotation, cut.j.v) - b.v - cross(b.w, d) - cross(cut.b.w, journal.offset);
  return journal;
}

/// The same quantity in {b}. @param R  of the bearing
template <typename T>
[[nodiscard]] RPSUP_INLINE JournalTangent_b<T> to_bearing_frame(const Mat3<double>& R,
                                                                const JournalTangent_W<T>& journal) {
  return {transpose_times(R, journal.rotation), transpose_times(R, journal.offset),
          transpose_times(R, journal.v), transpose_times(R, journal.w)};
}

/// A load on a journal as a seed.
struct ContactLoadSeed {
  std::size_t joint;   ///< of those with clearance
  const double* load;  ///< force, and moment about the journal's centre, in {b}
  double* column;      ///< of the Jacobian, for the derivatives by this load
  TangentPack seed;    ///< one in the load's lane
};

/// Tangents of the bias forces of bearing and journal by the load of their contacts, about the origins of the
/// bodies, each corotational with its body.
template <typename T>
struct ContactForceTangent {
  SpatialForce<T> on_bearing, on_journal;
};

/// Eq. (K20).
/// @param rotation, offset  of JournalTangent_W
/// @param load  in {b}
/// @param bearing_offset, journal_offset  from the bodies' origins to the journal's centre
template <typename T>
[[nodiscard]] RPSUP_INLINE ContactForceTangent<T> calc_contact_force_tangent(
    const CutJointMotion<double, double>& cut, const Vec3<T>& rotation, const Vec3<T>& offset,
    const LoadTangent<T>& load, const Vec3<double>& bearing_offset, const Vec3<double>& journal_offset) {
  const Vec3<T> force = cut.b.R * load.force;
  const Vec3<T> moment = cut.b.R * load.moment;
  const Vec3<T> force_j = force - cross(rotation, cut.reaction);
  const Vec3<T> moment_j = moment - cross(rotation, cut.b.R * cut.load.moment);
  ContactForceTangent<T> forces;
  forces.on_bearing = {force, moment + cross(bearing_offset, force) + cross(offset, cut.reaction)};
  forces.on_journal = {-force_j, -(moment_j + cross(journal_offset, force_j))};
  return forces;
}

RPSUP_INLINE void add_load_seed(const ContactLoadSeed& of, LoadTangent<TangentPack>& load) {
  load.force += Vec3<TangentPack>{of.load[0] * of.seed, of.load[1] * of.seed, of.load[2] * of.seed};
  load.moment += Vec3<TangentPack>{of.load[3] * of.seed, of.load[4] * of.seed, of.load[5] * of.seed};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
