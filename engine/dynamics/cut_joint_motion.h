// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/contact_law.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Motion and load of a cut joint.
template <typename P, typename V>
struct CutJointMotion {
  Frame<P, V> b, j;                ///< bearing and journal
  RelativeMotion<P, V> journal;    ///< of {j} in {b}
  JointLoad<V> load;               ///< of a joint with clearance
  Vec3<V> reaction;                ///< force on the journal at its centre, in W, [N]
  Vec3<V> moment;                  ///< on the journal, about its centre, in W, [N m]
};

/// Frame of a bearing or journal, from the frame of its body. @param accelerations  whether to compute wd and
/// vd
template <typename Placement, typename P, typename V>
[[nodiscard]] RPSUP_INLINE Frame<P, V> placed_frame(const Placement& placement, const Frame<P, V>& body,
                                                    bool accelerations) {
  Frame<P, V> placed;
  placed.R = placement.rotated ? multiply_constant(body.R, placement.data().R) : body.R;
  placed.p = body.p;
  placed.w = body.w;
  placed.v = body.v;
  if (accelerations) {
    placed.wd = body.wd;
    placed.vd = body.vd;
  }
  if (!placement.shifted) return placed;
  const Vec3<P> r = rotate_constant(body.R, placement.data().p, placement.along_x);
  if (accelerations) {
    shift_frame(r, true, placed);
  } else {
    placed.p += r;
    placed.v += cross(body.w, r);
  }
  return placed;
}

/// Computes the frames of bearing and journal from those of their bodies, and the journal's motion in the
/// bearing. Accelerations are computed for ideal joints only: their rows need them.
template <typename Joint, typename P, typename V>
RPSUP_INLINE void calc_cut_joint_motion(const Joint& joint, const Frame<P, V>& bearing_body,
                                        const Frame<P, V>& journal_body, CutJointMotion<P, V>& cut) {
  const bool ideal = !joint.has_clearance();
  cut.b = placed_frame(joint.bearing, bearing_body, ideal);
  cut.j = placed_frame(joint.journal, journal_body, ideal);
  const Vec3<P> offset = cut.j.p - cut.b.p;
  const Mat3<P>& R = cut.b.R;
  cut.journal.R = {transpose_times(R, cut.j.R.x), transpose_times(R, cut.j.R.y),
                   transpose_times(R, cut.j.R.z)};
  cut.journal.p = transpose_times(R, offset);
  cut.journal.v =
      transpose_times(R, cut.j.v - bearing_body.v - cross(bearing_body.w, cut.j.p - bearing_body.p));
  cut.journal.w = transpose_times(R, cut.j.w - cut.b.w);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
