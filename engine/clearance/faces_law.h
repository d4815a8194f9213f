#pragma once

#include "engine/clearance/axial_faces.h"
#include "engine/clearance/contact_law.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

template <typename P, typename V>
struct FacePenetration {
  Vec3<P> r;        ///< from the journal centre
  P delta;          ///< side z - (L_b / 2 + c_a), z its place along the bearing's axis, [m]
  V rate;           ///< [m/s]
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE FacePenetration<P, V> calc_face_penetration(const RelativeMotion<P, V>& journal, const FacePoint& point, double limit) {
  const Mat3<P>& R = journal.R;
  const Vec3<P> r = point.x * R.x + point.y * R.y + point.z * R.z;
  return {r, point.side * (journal.p.z + r.z) - limit,
          point.side * (journal.v.z + (journal.w.x * r.y - journal.w.y * r.x))};
}

/// Contact of the journal's two faces with the bearing's shoulders: points on circles, no friction.
///
///     delta = +-z_b - (L_b / 2 + c_a),  f = K_a / (points of a face) delta (1 + chi rate / rate_onset), or as the normal law says
template <typename P, typename V>
RPSUP_INLINE void add_faces(const AxialFaces& faces, const RelativeMotion<P, V>& journal, JointLoad<V>& load) {
  const double limit = faces.limit();
  const double x_z = value_of(journal.R.x.z), y_z = value_of(journal.R.y.z), z_z = value_of(journal.R.z.z);
  const double p_z = value_of(journal.p.z);
  const FacePoint* points = faces.points();
  const int count = faces.face_points();
  for (int k = 0; k < 2 * count; ++k) {
    if (k % count == 0 && !(faces.calc_reach(points[k].side, p_z, x_z, y_z, z_z) > limit)) {
      k += count - 1;  // none of this face's points touches
      continue;
    }
    const double z = p_z + (points[k].x * x_z + points[k].y * y_z + points[k].z * z_z);
    if (!(points[k].side * z > limit)) continue;
    const FacePenetration<P, V> touch = calc_face_penetration(journal, points[k], limit);
    if (!(value_of(touch.delta) > 0.0)) continue;
    const P elastic = faces.point_stiffness() * touch.delta;
    const ClearanceParameters& joint = faces.parameters();
    const V onset = choose_onset_rate(faces.latches()[k].rate(), touch.rate, joint.minimum_onset_rate);
    const NormalLaw<V> normal = calc_normal_law(elastic, touch.rate, onset, joint.chi, joint.damping / count);
    const V force = -points[k].side * normal.total;
    load.force.z += force;
    load.moment.x += touch.r.y * force;
    load.moment.y -= touch.r.x * force;
    load.impact_power += normal.loss_power;
    load.elastic_energy += 0.5 * value_of(elastic) * value_of(touch.delta);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
