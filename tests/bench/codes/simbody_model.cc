// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/simbody_model.h"

#include <stdexcept>
#include <utility>

namespace bench {

namespace {

using SimTK::Rotation;
using SimTK::Transform;
using SimTK::UnitVec3;
using SimTK::Vec3;

Vec3 to_simbody(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

SimTK::MobilizedBody make_joint(const PlainBody& plain, SimTK::MobilizedBody& parent) {
  const SimTK::Body::Rigid body(
      SimTK::MassProperties(plain.mass, to_simbody(plain.com), SimTK::Inertia(to_simbody(plain.inertia))));
  const Vec3 p = to_simbody(plain.p_PJ);
  const SimTK::CoordinateAxis axis(plain.joint[0].axis);
  if (plain.joint.size() == 3) {
    const Rotation turned(UnitVec3(SimTK::ZAxis), SimTK::XAxis, Vec3(0, 1, 0), SimTK::YAxis);
    return SimTK::MobilizedBody::Gimbal(parent, Transform(turned, p), body, Transform(turned, Vec3(0)));
  }
  if (plain.joint.size() == 2) {
    const Rotation turned(UnitVec3(axis), SimTK::XAxis, UnitVec3(SimTK::CoordinateAxis(plain.joint[1].axis)),
                          SimTK::YAxis);
    return SimTK::MobilizedBody::Universal(parent, Transform(turned, p), body, Transform(turned, Vec3(0)));
  }
  // a Slider's own axis, and a Pin's
  const Rotation turned(UnitVec3(axis), SimTK::CoordinateAxis(plain.joint[0].slides ? 0 : 2));
  if (plain.joint[0].slides)
    return SimTK::MobilizedBody::Slider(parent, Transform(turned, p), body, Transform(turned, Vec3(0)));
  return SimTK::MobilizedBody::Pin(parent, Transform(turned, p), body, Transform(turned, Vec3(0)));
}

/// A drive law as prescribed motion of a joint's one coordinate.
class PrescribedMotion : public SimTK::Motion::Custom::Implementation {
 public:
  explicit PrescribedMotion(std::function<PlainDriven(double)> law) : law_(std::move(law)) {}

  Implementation* clone() const override { return new PrescribedMotion(*this); }
  SimTK::Motion::Level getLevel(const SimTK::State&) const override { return SimTK::Motion::Position; }
  void calcPrescribedPosition(const SimTK::State& s, int, SimTK::Real* q) const override {
    *q = law_(s.getTime()).q;
  }
  void calcPrescribedPositionDot(const SimTK::State& s, int, SimTK::Real* qd) const override {
    *qd = law_(s.getTime()).qd;
  }
  void calcPrescribedPositionDotDot(const SimTK::State& s, int, SimTK::Real* qdd) const override {
    *qdd = law_(s.getTime()).qdd;
  }

 private:
  std::function<PlainDriven(double)> law_;
};

/// The third turn of a Gimbal is backwards.
double sign_of(int which) { return which == 2 ? -1.0 : 1.0; }

}  // namespace

SimbodyModel::SimbodyModel(const PlainLinkage& plain) : matter(system), forces(system), plain_(plain) {
  SimTK::Force::UniformGravity(forces, matter, to_simbody(plain.gravity_W));
  for (const PlainBody& body : plain.bodies) {
    SimTK::MobilizedBody parent =
        body.parent < 0 ? matter.Ground() : bodies_[static_cast<std::size_t>(body.parent)];
    bodies_.push_back(make_joint(body, parent));
    for (std::size_t k = 0; k < body.joint.size(); ++k)
      add_forces(body.joint[k], bodies_.back(), static_cast<int>(k));
  }
  for (const PlainLoop& loop : plain.loops)
    SimTK::Constraint::Ball(bodies_[static_cast<std::size_t>(loop.bodies[0])], to_simbody(loop.points[0]),
                            bodies_[static_cast<std::size_t>(loop.bodies[1])], to_simbody(loop.points[1]));
}

void SimbodyModel::add_forces(const PlainCoordinate& c, SimTK::MobilizedBody& body, int which) {
  if (c.stiffness > 0.0)
    SimTK::Force::MobilityLinearSpring(forces, body, SimTK::MobilizerQIndex(which), c.stiffness, 0.0);
  if (c.damping > 0.0)
    SimTK::Force::MobilityLinearDamper(forces, body, SimTK::MobilizerUIndex(which), c.damping);
  if (c.drive) SimTK::Motion::Custom(body, new PrescribedMotion(c.drive));  // which owns it
}

void SimbodyModel::place(SimTK::State& state) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (std::size_t k = 0; k < plain_.bodies[i].joint.size(); ++k) {
      const int which = static_cast<int>(k);
      bodies_[i].setOneQ(state, which, sign_of(which) * plain_.bodies[i].joint[k].start);
      bodies_[i].setOneU(state, which, sign_of(which) * plain_.bodies[i].joint[k].start_rate);
    }
}

}  // namespace bench
