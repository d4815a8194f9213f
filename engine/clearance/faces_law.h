// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/axial_faces.h"
#include "engine/clearance/contact_law.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Penetration of the points (x, y) of a face into the shoulder: delta = delta_0 + x delta_x + y delta_y, the
/// rate likewise.
template <typename P, typename V>
struct FaceMotion {
  P delta_0, delta_x, delta_y;  ///< [m], [1]
  V rate_0, rate_x, rate_y;     ///< [m/s], [1/s]

  [[nodiscard]] RPSUP_INLINE P calc_delta(double x, double y) const {
    return delta_0 + (x * delta_x + y * delta_y);
  }
  [[nodiscard]] RPSUP_INLINE V calc_rate(double x, double y) const {
    return rate_0 + (x * rate_x + y * rate_y);
  }
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE FaceMotion<P, V> calc_face_motion(const AxialFaces& faces, int face,
                                                             const RelativeMotion<P, V>& journal) {
  const double side = AxialFaces::side(face), z = faces.z(face);
  const Mat3<P>& R = journal.R;
  const auto axial_velocity = [&](const Vec3<P>& axis)
                           RPSUP_INLINE_LAMBDA { return journal.w.x * axis.y - journal.w.y * axis.x; };
  return {side * (journal.p.z + z * R.z.z) - faces.limit(), side * R.x.z, side * R.y.z,
          side * (journal.v.z + z * axial_velocity(R.z)), side * axial_velocity(R.x),
          side * axial_velocity(R.y)};
}

/// Load of a shoulder on a face.
template <typename V>
struct FaceLoad {
  V force{}, x_force{}, y_force{};  ///< sums over the points of f, x f, y f
  V impact_power{};
  double elastic_energy = 0.0;
};

/// The points one by one.
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE FaceLoad<V> press_face(const AxialFaces& faces, int face,
                                                  const FaceMotion<P, V>& motion) {
  const ClearanceParameters& joint = faces.parameters();
  FaceLoad<V> load;
  for (int k = 0; k < faces.face_points(); ++k) {
    const double x = faces.x()[k], y = faces.y()[k];
    const P delta = motion.calc_delta(x, y);
    if (!(value_of(delta) > 0.0)) continue;
    const V rate = motion.calc_rate(x, y);
    const P elastic = faces.point_stiffness() * delta;
    const V onset = choose_onset_rate(faces.latches(face)[k].rate(), rate, joint.minimum_onset_rate);
    const NormalForce<V> normal = calc_normal_force(elastic, rate, onset, joint.chi, faces.point_damping());
    load.force += normal.total;
    load.x_force += x * normal.total;
    load.y_force += y * normal.total;
    load.impact_power += normal.loss_power;
    load.elastic_energy += 0.5 * value_of(elastic) * value_of(delta);
  }
  return load;
}

/// The points side by side.
[[nodiscard]] RPSUP_INLINE FaceLoad<double> press_face(const AxialFaces& faces, int face,
                                                       const FaceMotion<double, double>& motion) {
  const ClearanceParameters& joint = faces.parameters();
  FaceLoad<double> load;
  for (int k = 0; k < faces.face_points(); k += Lanes::kCount) {
    const Lanes x = Lanes::load(faces.x() + k), y = Lanes::load(faces.y() + k);
    const Lanes beyond = Lanes::all(motion.delta_0) + (motion.delta_x * x + motion.delta_y * y) -
                         Lanes::load(faces.setback() + k);
    const Lanes delta = choose_greater(beyond, Lanes{}, beyond, Lanes{});
    const Lanes rate = Lanes::all(motion.rate_0) + (motion.rate_x * x + motion.rate_y * y);
    const Lanes elastic = faces.point_stiffness() * delta;
    const Lanes onset =
        choose_onset_rate(Lanes::load(faces.latches(face) + k), rate, joint.minimum_onset_rate);
    const NormalForce<Lanes> normal =
        calc_normal_force(elastic, rate, onset, joint.chi, faces.point_damping());
    const Lanes force = choose_greater(beyond, Lanes{}, normal.total, Lanes{});
    load.force += sum(force);
    load.x_force += sum(x * force);
    load.y_force += sum(y * force);
    load.impact_power += sum(choose_greater(beyond, Lanes{}, normal.loss_power, Lanes{}));
    load.elastic_energy += sum(0.5 * elastic * delta);
  }
  return load;
}

/// Contact of the journal's two faces with the bearing's shoulders: points on circles, no friction.
///
///     delta = +-z_b - (L_b / 2 + c_a),  f = K_a / (points of a face) delta (1 + chi rate / rate_onset),
///     or as the normal law says
template <typename P, typename V>
RPSUP_INLINE void add_faces(const AxialFaces& faces, const RelativeMotion<P, V>& journal,
                            JointLoad<V>& load) {
  const Mat3<P>& R = journal.R;
  for (const int face : {0, 1}) {
    const double z = faces.z(face), side = AxialFaces::side(face);
    const double farthest = faces.calc_farthest_point(side, value_of(journal.p.z), value_of(R.x.z),
                                                      value_of(R.y.z), value_of(R.z.z));
    if (!(farthest > faces.limit())) continue;
    const FaceLoad<V> pressed = press_face(faces, face, calc_face_motion(faces, face, journal));
    // The moment of the points' forces -side f along z, each at x R_x + y R_y + z R_z.
    load.force.z -= side * pressed.force;
    load.moment.x -= side * (pressed.x_force * R.x.y + pressed.y_force * R.y.y + z * (pressed.force * R.z.y));
    load.moment.y += side * (pressed.x_force * R.x.x + pressed.y_force * R.y.x + z * (pressed.force * R.z.x));
    load.face_normal_sum += value_of(pressed.force);
    load.face_touches = load.face_touches || pressed.elastic_energy > 0.0;
    load.impact_power += pressed.impact_power;
    load.elastic_energy += pressed.elastic_energy;
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
