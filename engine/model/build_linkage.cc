// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <variant>

#include "engine/model/applied_force.h"
#include "engine/model/linkage.h"

namespace engine {

namespace {

bool is_none(const Placement& placement) { return is_unrotated(placement) && placement.p.isZero(0.0); }

/// Of a frame that is placed in another one which is placed itself.
Placement compose(const Placement& outer, const Placement& inner) {
  if (is_none(outer)) return inner;
  if (is_none(inner)) return outer;
  return {outer.R * inner.R, outer.R * inner.p + outer.p};
}

/// Placement of a body's frame in the frame of a joint. @param placement  of the joint in the body's frame
Placement inverse_of(const Placement& placement) {
  if (is_none(placement)) return placement;
  const Eigen::Matrix3d R = placement.R.transpose();
  return {R, -(R * placement.p)};
}

CutKind cut_kind_of(JointKind kind) {
  switch (kind) {
    case JointKind::kRevolute: return CutKind::kRevolute;
    case JointKind::kPrismatic: return CutKind::kPrismatic;
    case JointKind::kCylindrical: return CutKind::kCylindrical;
    case JointKind::kUniversal: return CutKind::kUniversal;
    case JointKind::kSpherical: return CutKind::kSpherical;
    case JointKind::kWeld: return CutKind::kWeld;
    case JointKind::kScrew:
    case JointKind::kPlanar:
    case JointKind::kFree: break;
  }
  throw std::invalid_argument("a joint of this kind closes no loop");
}

class LinkageBuilder {
 public:
  explicit LinkageBuilder(const Linkage& linkage) : linkage_(linkage) {
    built_.bodies.resize(linkage.bodies.size());
    built_.joints.resize(linkage.joints.size());
  }

  BuiltLinkage build() {
    add_joints();
    for (const LinkageSpring& spring : linkage_.springs) add_spring(spring);
    for (const LinkageLoad& load : linkage_.loads) add_load(load);
    for (const LinkageAccelerometer& one : linkage_.accelerometers) add_accelerometer(one);
    add_inertial_forces();
    Mechanism& m = built_.mechanism;
    add_actuations(m);
    m.gravity_W = linkage_.gravity_W;
    m.drive_rows = linkage_.drive_rows;
    m.baumgarte_alpha = linkage_.baumgarte_alpha;
    m.baumgarte_beta = linkage_.baumgarte_beta;
    return std::move(built_);
  }

 private:
  void add_joints() {
    for (std::size_t k = 0; k < linkage_.joints.size(); ++k)
      if (!linkage_.joints[k].cut) add_carrying(linkage_.joints[k], built_.joints[k]);
    for (std::size_t k = 0; k < linkage_.joints.size(); ++k)
      if (linkage_.joints[k].cut || linkage_.joints[k].clearance)
        add_cut(linkage_.joints[k], built_.joints[k]);
  }

  std::size_t index_of(const std::string& body) const {
    const auto found = std::find_if(linkage_.bodies.begin(), linkage_.bodies.end(),
                                    [&](const LinkageBody& b) { return b.name == body; });
    if (found == linkage_.bodies.end()) throw std::invalid_argument("no body has the name " + body);
    return static_cast<std::size_t>(found - linkage_.bodies.begin());
  }

  /// Frame, and placement in it, of an object placed on a body.
  std::pair<FrameIndex, Placement> locate(const std::string& body, Placement placement) const {
    if (body == kGroundName) return {kGround, placement};
    const std::size_t index = index_of(body);
    const std::vector<BodyFrames::Part>& parts = built_.bodies[index].parts;
    if (parts.empty()) throw std::invalid_argument("nothing carries the body " + body);
    std::size_t k = 0;
    while (k + 1 < parts.size() && parts[k + 1].begin < placement.p.x()) ++k;
    const std::optional<UniformBeam>& beam = linkage_.bodies[index].beam;
    if (beam && placement.p.x() == beam->length)  // to the last bit
      placement.p.x() = divide_beam(*beam, linkage_.bodies[index].elements).elements.back().length;
    else
      placement.p.x() -= parts[k].begin;
    return {parts[k].frame, compose(parts[k].placement, placement)};
  }

  void add_carrying(const LinkageJoint& joint, BuiltJoint& made) {
    auto [frame, placement] = locate(joint.from, joint.placement);
    const std::vector<FreedomKind> kinds = freedoms_of(joint);
    made.count = static_cast<int>(kinds.size());
    if (made.count > 0) made.first = static_cast<FrameIndex>(built_.mechanism.coordinates.size());
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      frame = add_freedom(joint.freedoms.at(k), kinds[k], frame, placement);
      built_.mechanism.coordinates.back().continues_joint = k > 0;
      placement = {};
    }
    if (joint.kind == JointKind::kScrew)
      built_.mechanism.couplings.push_back({made.first, made.first + 1, joint.lead});
    place_body(index_of(joint.to), frame, compose(placement, inverse_of(joint.to_placement)));
  }

  FrameIndex add_freedom(const LinkageFreedom& freedom, const FreedomKind& kind, FrameIndex parent,
                         const Placement& placement) {
    const FrameIndex index = add({.name = freedom.name,
                                  .parent = parent,
                                  .placement = placement,
                                  .motion = kind.motion,
                                  .axis = kind.axis,
                                  .stiffness = freedom.stiffness,
                                  .damping = freedom.damping,
                                  .assembly_guess = freedom.guess,
                                  .start = freedom.start,
                                  .start_rate = freedom.start_rate,
                                  .spring_yields = true});
    if (freedom.drive) built_.mechanism.drives.push_back({index, *freedom.drive});
    return index;
  }

  /// Behind all other coordinates.
  void add_actuations(Mechanism& m) const {
    for (std::size_t k = 0; k < linkage_.joints.size(); ++k)
      for (std::size_t i = 0; i < linkage_.joints[k].freedoms.size(); ++i) {
        const LinkageFreedom& freedom = linkage_.joints[k].freedoms[i];
        const FrameIndex coordinate = built_.joints[k].first + static_cast<FrameIndex>(i);
        if (freedom.actuator)
          std::visit([&](const auto& actuator) { add_actuation(m, coordinate, actuator); },
                     *freedom.actuator);
        if (freedom.load) add_actuation(m, coordinate, *freedom.load);
        if (freedom.friction) add_actuation(m, coordinate, *freedom.friction);
      }
  }

  FrameIndex add(Coordinate coordinate) {
    built_.mechanism.coordinates.push_back(std::move(coordinate));
    return static_cast<FrameIndex>(built_.mechanism.coordinates.size()) - 1;
  }

  void place_body(std::size_t index, FrameIndex frame, const Placement& placement) {
    const LinkageBody& body = linkage_.bodies[index];
    std::vector<BodyFrames::Part>& parts = built_.bodies[index].parts;
    if (!body.beam) {
      parts.push_back({frame, placement, 0.0});
      add_mass(frame, placement, body.mass, body.com, body.inertia);
      built_.mechanism.links.push_back({body.name, frame, placement});
      return;
    }
    place_beam(body, frame, placement, parts);
  }

  void place_beam(const LinkageBody& body, FrameIndex frame, Placement placement,
                  std::vector<BodyFrames::Part>& parts) {
    const DividedBeam divided = divide_beam(*body.beam, body.elements);
    double begin = 0.0;
    for (std::size_t r = 0; r < divided.elements.size(); ++r) {
      const RigidElement& rfe = divided.elements[r];
      const std::string name = body.name + "," + std::to_string(r);
      if (r > 0) {
        placement.p += placement.R.col(0) * divided.elements[r - 1].length;
        frame = add_sde(name, frame, placement, divided.sde);
        placement = {};
      }
      parts.push_back({frame, placement, begin});
      add_mass(frame, placement, rfe.mass, {0.5 * rfe.length, 0.0, 0.0}, rfe.inertia.asDiagonal());
      built_.mechanism.links.push_back({name, frame, placement});
      begin += rfe.length;
    }
  }

  /// R_z(psi) R_y(theta) R_x(phi) between two elements.
  FrameIndex add_sde(const std::string& name, FrameIndex parent, Placement placement,
                     const SpringDamperElement& sde) {
    constexpr std::array<Axis, 3> kAxes{Axis::kZ, Axis::kY, Axis::kX};
    for (std::size_t k = 0; k < kAxes.size(); ++k) {
      parent = add({.name = name + "," + std::to_string(k),
                    .parent = parent,
                    .placement = placement,
                    .axis = kAxes[k],
                    .stiffness = sde.stiffness[static_cast<Eigen::Index>(k)],
                    .damping = sde.damping[static_cast<Eigen::Index>(k)]});
      placement = {};
    }
    return parent;
  }

  /// Adds a body placed in a frame to what the frame already carries.
  void add_mass(FrameIndex frame, const Placement& placement, double mass, const Eigen::Vector3d& com,
                const Eigen::Matrix3d& inertia) {
    if (frame == kGround) return;
    Coordinate& c = built_.mechanism.coordinates[static_cast<std::size_t>(frame)];
    const auto steiner = [](double m, const Eigen::Vector3d& at) -> Eigen::Matrix3d {
      return m * (at.squaredNorm() * Eigen::Matrix3d::Identity() - at * at.transpose());
    };
    if (is_none(placement) && c.mass == 0.0) {
      c.mass = mass;
      c.com = com;
      c.inertia = inertia;
      return;
    }
    const Eigen::Vector3d at = placement.R * com + placement.p;
    const Eigen::Matrix3d moved =
        placement.R * (inertia - steiner(mass, com)) * placement.R.transpose() + steiner(mass, at);
    const double sum = c.mass + mass;
    c.com = sum > 0.0 ? Eigen::Vector3d((c.mass * c.com + mass * at) / sum) : at;
    c.mass = sum;
    c.inertia += moved;
  }

  void add_cut(const LinkageJoint& joint, BuiltJoint& made) {
    Placement from = joint.placement, to = joint.to_placement;
    if (!joint.cut)
      for (Placement* placement : {&from, &to}) placement->R *= rotation_between(Axis::kZ, joint.axes[0]);
    const auto [bearing_frame, bearing] = locate(joint.from, from);
    const auto [journal_frame, journal] = locate(joint.to, to);
    made.cut = static_cast<int>(built_.mechanism.cut_joints.size());
    built_.mechanism.cut_joints.push_back({.kind = cut_kind_of(joint.kind),
                                           .bearing_frame = bearing_frame,
                                           .journal_frame = journal_frame,
                                           .bearing = bearing,
                                           .journal = journal,
                                           .clearance = joint.clearance});
  }

  void add_spring(const LinkageSpring& spring) {
    const auto [from_frame, from] = locate(spring.from, {.p = spring.at});
    const auto [to_frame, to] = locate(spring.to, {.p = spring.to_at});
    built_.mechanism.springs.push_back({.from_frame = from_frame,
                                        .to_frame = to_frame,
                                        .from = from.p,
                                        .to = to.p,
                                        .stiffness = spring.stiffness,
                                        .damping = spring.damping,
                                        .drag = spring.drag,
                                        .free_length = spring.free_length.value_or(0.0)});
  }

  void add_load(const LinkageLoad& load) {
    const auto [frame, at] = locate(load.body, {.p = load.at});
    const Eigen::Matrix3d R = load.follows_body ? at.R : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    built_.mechanism.body_loads.push_back(
        {frame, at.p, R * load.force, R * load.moment, load.follows_body, load.law});
  }

  void add_accelerometer(const LinkageAccelerometer& one) {
    const auto [frame, at] = locate(one.body, {.p = one.at});
    const Eigen::Matrix3d R = one.follows_body ? at.R : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    built_.accelerometers.push_back({.frame = frame, .at = at.p, .direction = R * one.direction});
  }

  void add_inertial_forces() {
    Mechanism& m = built_.mechanism;
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<Signal>& law = linkage_.ground_acceleration[static_cast<std::size_t>(axis)];
      for (std::size_t i = 0; law && i < m.coordinates.size(); ++i)
        if (const Coordinate& c = m.coordinates[i]; c.mass > 0.0)
          m.body_loads.push_back({static_cast<FrameIndex>(i), c.com, -c.mass * Eigen::Vector3d::Unit(axis),
                                  Eigen::Vector3d::Zero(), false, *law});
    }
  }

  const Linkage& linkage_;
  BuiltLinkage built_;
};

}  // namespace

Eigen::Matrix3d rotation_between(Axis from, Axis to) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  const int by = static_cast<int>(to) - static_cast<int>(from) + 3;
  for (int i = 0; i < 3; ++i) R((i + by) % 3, i) = 1.0;
  return R;
}

std::vector<FreedomKind> freedoms_of(const LinkageJoint& joint) {
  const auto turn = [](Axis axis) { return FreedomKind{Motion::kRotation, axis}; };
  const auto slide = [](Axis axis) { return FreedomKind{Motion::kTranslation, axis}; };
  const auto [first, second] = joint.axes;
  if (joint.clearance && !joint.cut) {
    std::vector<FreedomKind> all{slide(Axis::kX), slide(Axis::kY), slide(Axis::kZ), turn(first)};
    for (const Axis axis : {Axis::kZ, Axis::kY, Axis::kX})
      if (axis != first) all.push_back(turn(axis));
    return all;
  }
  switch (joint.kind) {
    case JointKind::kRevolute: return {turn(first)};
    case JointKind::kPrismatic: return {slide(first)};
    case JointKind::kCylindrical:
    case JointKind::kScrew: return {slide(first), turn(first)};
    case JointKind::kUniversal: return {turn(first), turn(second)};
    case JointKind::kSpherical: return {turn(Axis::kZ), turn(Axis::kY), turn(Axis::kX)};
    case JointKind::kPlanar: return {slide(Axis::kX), slide(Axis::kY), turn(Axis::kZ)};
    case JointKind::kFree:
      return {slide(Axis::kX), slide(Axis::kY), slide(Axis::kZ),
              turn(Axis::kZ),  turn(Axis::kY),  turn(Axis::kX)};
    case JointKind::kWeld: return {};
  }
  return {};
}

BuiltLinkage build_linkage(const Linkage& linkage) { return LinkageBuilder(linkage).build(); }

}  // namespace engine
