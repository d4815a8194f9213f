// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/make_plain_linkage.h"

#include <stdexcept>

#include "tests/bench/codes/joint_contact.h"
#include "tests/bench/support/cases.h"

namespace bench {

namespace {

PlainCoordinate take_coordinate(const engine::Mechanism& mechanism, engine::FrameIndex i,
                                const Coordinates& at) {
  const engine::Coordinate& c = mechanism.coordinates[static_cast<std::size_t>(i)];
  PlainCoordinate plain{c.name,
                        c.motion == engine::Motion::kTranslation,
                        static_cast<int>(c.axis),
                        c.stiffness,
                        c.damping,
                        {},
                        at.q[i],
                        at.qd[i]};
  for (const engine::Drive& drive : mechanism.drives)
    if (drive.coordinate == i)
      plain.drive = [law = drive.law](double t) {
        const engine::DrivenMotion motion = engine::calc_driven_motion(law, t);
        return PlainDriven{motion.q, motion.qd, motion.qdd};
      };
  return plain;
}

/// A frame without mass is inside a joint and belongs to the body after it.
/// @param measured  coordinate
PlainLinkage take_tree(const engine::Mechanism& mechanism, const Coordinates& at,
                       engine::FrameIndex measured) {
  PlainLinkage plain;
  plain.gravity_W = mechanism.gravity_W;
  std::vector<int> body_of;
  PlainBody body;
  for (std::size_t i = 0; i < mechanism.coordinates.size(); ++i) {
    const engine::Coordinate& c = mechanism.coordinates[i];
    if (!engine::is_unrotated(c.placement))
      throw std::invalid_argument("a joint's frame is turned in its parent");
    if (body.joint.empty()) {
      body.parent = c.parent == engine::kGround ? -1 : body_of[static_cast<std::size_t>(c.parent)];
      body.p_PJ = c.placement.p;
    }
    body.joint.push_back(take_coordinate(mechanism, static_cast<engine::FrameIndex>(i), at));
    body_of.push_back(static_cast<int>(plain.bodies.size()));
    if (c.mass == 0.0) continue;
    if (!c.inertia.isDiagonal(0.0)) throw std::invalid_argument("a body's axes are not its principal ones");
    body.mass = c.mass;
    body.com = c.com;
    body.inertia = c.inertia.diagonal();
    plain.bodies.push_back(body);
    body = {};
  }
  plain.measured = body_of[static_cast<std::size_t>(measured)];
  for (const engine::CutJoint& joint : mechanism.cut_joints) {
    const int bearing = body_of[static_cast<std::size_t>(joint.bearing_frame)];
    const int journal = body_of[static_cast<std::size_t>(joint.journal_frame)];
    if (joint.clearance) {
      plain.bearing = bearing;
      plain.journal = journal;
      plain.forces = make_joint_forces(joint);
    } else if (joint.kind == engine::CutKind::kSpherical) {
      plain.loops.push_back({{bearing, journal}, {joint.bearing.p, joint.journal.p}});
    } else {
      throw std::invalid_argument("a loop is closed by another joint than a spherical one");
    }
  }
  return plain;
}

}  // namespace

PlainLinkage make_plain_linkage(const engine::RpsupParameters& parameters) {
  const engine::Rpsup rpsup = engine::build_rpsup(parameters);
  PlainLinkage plain = take_tree(rpsup.mechanism, assemble(rpsup.mechanism), rpsup.layout.slider);
  plain.steady_from = parameters.run_up;
  return plain;
}

PlainLinkage make_plain_linkage_in_contact(const engine::RpsupParameters& parameters) {
  const engine::Rpsup rpsup = engine::build_rpsup(parameters);
  return take_tree(rpsup.mechanism, assemble_in_contact(parameters, rpsup), rpsup.layout.slider);
}

PlainLinkage make_plain_linkage(const engine::Mechanism& mechanism, engine::FrameIndex measured) {
  return take_tree(mechanism, assemble(mechanism), measured);
}

}  // namespace bench
