#include "engine/clearance/radial_contact.h"

#include "engine/clearance/friction.h"

namespace engine {

void add_radial_touch(const ClearanceParameters& joint, const JournalMotion& journal, const RadialTouch& touch, const double* bristle,
                      double* bristle_rate, ContactLoad& load) {
  Eigen::Vector3d force = -touch.normal.total * touch.n;
  load.radial_normal_sum += touch.normal.total;
  load.impact_power += touch.normal.calc_loss_power(touch.rate);
  if (joint.friction) {
    const Eigen::Vector3d velocity = journal.calc_velocity(touch.r);
    const Eigen::Vector3d t(-touch.n.y(), touch.n.x(), 0.0);
    const Eigen::Vector2d v(t.dot(velocity), velocity.z());
    const Eigen::Vector2d z = bristle ? Eigen::Vector2d(bristle[0], bristle[1]) : Eigen::Vector2d(0.0, 0.0);
    const BristleForce friction = calc_bristle_force(*joint.friction, v, z);
    const Eigen::Vector2d tangential = touch.normal.total * friction.force_ratio;
    force -= tangential[0] * t;
    force.z() -= tangential[1];
    load.friction_sum += tangential.norm();
    load.friction_power += tangential.dot(v);
    if (bristle_rate) {
      bristle_rate[0] = friction.bristle_rate[0];
      bristle_rate[1] = friction.bristle_rate[1];
    }
  }
  load.add_force(touch.r, force);
}

}  // namespace engine
