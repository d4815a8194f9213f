// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/newton/recursive_newton.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

namespace {

constexpr int kOwn = 1;          ///< the first of u in the rest
constexpr int kRest = kOwn + 3;  ///< the last of the nine numbers, and u

/// The nine numbers that forces follow.
template <typename T>
struct Inputs {
  explicit Inputs(const VariedFrame<T>& f) : of{&f.w.x, &f.w.y, &f.w.z, &f.wd.x, &f.wd.y, &f.wd.z, &f.vd.x, &f.vd.y, &f.vd.z} {}
  const T* of[9];
};

/// row . inputs
template <typename Scalar, typename T>
[[nodiscard]] RPSUP_INLINE T apply_row(const InputRow<Scalar>& row, const Inputs<T>& inputs) {
  T sum = row[0] * *inputs.of[0];
  for (int k = 1; k < 9; ++k) sum += row[k] * *inputs.of[k];
  return sum;
}

/// The six numbers of a force.
template <typename T>
struct ForceRows {
  explicit ForceRows(SpatialForce<T>& f) : of{&f.force.x, &f.force.y, &f.force.z, &f.moment.x, &f.moment.y, &f.moment.z} {}
  T* of[6];
};

/// Adds the force that what a body carries needs. @param answer  Body's
template <typename Scalar, typename T>
RPSUP_INLINE void add_answer(const InputRow<Scalar> (&answer)[6], const VariedFrame<T>& f, SpatialForce<T>& force) {
  const Inputs<T> inputs(f);
  const ForceRows<T> rows(force);
  for (int row = 0; row < 6; ++row) *rows.of[row] += apply_row(answer[row], inputs);
}

/// One in a lane, zero in the others.
template <typename Scalar, int count>
[[nodiscard]] RPSUP_INLINE auto unit(int lane) {
  return NumbersOf<Scalar>::widen(LaneBlock<count>::unit(lane));
}

/// A frame that varies by one in each of its nine numbers: the first eight, and the last.
template <typename Scalar>
[[nodiscard]] auto make_inputs() {
  const auto one = [](int lane) { return unit<Scalar, Lanes::kCount>(lane); };
  VariedFrame<decltype(one(0))> f;
  f.w = {one(0), one(1), one(2)};
  f.wd = {one(3), one(4), one(5)};
  f.vd = {one(6), one(7), {}};
  return f;
}
template <typename Scalar>
[[nodiscard]] auto make_last_input() {
  VariedFrame<decltype(unit<Scalar, kRest>(0))> f;
  f.vd.z = unit<Scalar, kRest>(0);
  return f;
}

/// The twelve numbers of a journal's motion.
template <typename T>
[[nodiscard]] RPSUP_INLINE T& number_of(JournalVariation<T>& y, std::size_t k) {
  Vec3<T>& v = k < 3 ? y.turn : k < 6 ? y.p : k < 9 ? y.v : y.w;
  return k % 3 == 0 ? v.x : k % 3 == 1 ? v.y : v.z;
}

/// Inverse of a matrix of n = 1 or 3. False if it is singular.
template <typename Scalar>
[[nodiscard]] bool invert_small(int n, const Scalar (&m)[3][3], Scalar (&inverse)[3][3]) {
  if (n == 1) {
    inverse[0][0] = 1.0 / m[0][0];
    return is_number(size_of(inverse[0][0]));
  }
  const Vec3<Scalar> x{m[0][0], m[0][1], m[0][2]}, y{m[1][0], m[1][1], m[1][2]}, z{m[2][0], m[2][1], m[2][2]};
  const Vec3<Scalar> columns[3] = {cross(y, z), cross(z, x), cross(x, y)};
  const Scalar by = 1.0 / dot(x, columns[0]);
  for (int k = 0; k < 3; ++k) {
    inverse[0][k] = by * columns[k].x;
    inverse[1][k] = by * columns[k].y;
    inverse[2][k] = by * columns[k].z;
  }
  return is_number(size_of(by));
}

[[nodiscard]] std::size_t at(int i) { return static_cast<std::size_t>(i); }

[[nodiscard]] int count_bristles(const std::vector<ClearanceJoint>& joints) {
  int sum = 0;
  for (const ClearanceJoint& joint : joints) sum += joint.bristle_count();
  return sum;
}

constexpr std::size_t kLanes = Lanes::kCount;

/// How many groups hold so many numbers.
[[nodiscard]] std::size_t count_groups(std::size_t numbers) { return (numbers + kLanes - 1) / kLanes; }

}  // namespace

template <typename Scalar>
template <typename T>
ShiftedBodies<Scalar>::Room<T>::Room(const TreeModel& model)
    : forces(model.joints.size()), own(at(model.coordinates)), frames(model.joints.size()), u(model.free.size()), drive_force(model.drives.size()) {}

template <typename Scalar>
ShiftedBodies<Scalar>::ShiftedBodies(const TreeModel& model, const std::vector<ClearanceJoint>& joints)
    : model_(model),
      free_(static_cast<int>(model.free.size())),
      bristles_(count_bristles(joints)),
      bodies_(model.joints.size()),
      drive_rates_(model.drives.size()),
      touching_(joints.size()),
      journal_matrix_(kJournal * joints.size()),
      journals_(kJournal * joints.size()),
      journal_groups_(count_groups(journals_.size())),
      u_by_journals_(model.free.size() * journal_groups_.size()),
      drive_force_by_journals_(model.drives.size() * journal_groups_.size()),
      room_(model),
      wide_room_(model) {
  for (const TreeCutJoint& joint : model.cut_joints)
    contacts_.push_back(std::make_unique<Contact>(joint, at(joints[at(joint.clearance)].bristle_count())));
}

template <typename Scalar>
void ShiftedBodies<Scalar>::take_up(const BodiesSolution& solution) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const TreeJoint& joint = model_.joints[i];
    body.R = solution.frames[i].R;
    body.p = solution.frames[i].p;
    body.axes = solution.axes[i];
    body.held = solution.held[i];
    for (int k = 0; k < joint.count(); ++k) {
      body.coordinates[k] = solution.held_coordinates[joint.first + k];
      body.rate_of_loss[k] = 2.0 * joint.damping[at(k)] * solution.qd[joint.first + k];
    }
    if (joint.driven) drive_rates_[at(joint.drive)] = solution.qd[joint.first];
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    Contact& contact = *contacts_[k];
    contact.cut = solution.cuts[k];
    contact.derivative = solution.contacts[contact.joint.clearance].get();
    contact.acting = solution.acting[contact.joint.clearance];
  }
}

template <typename Scalar>
bool ShiftedBodies<Scalar>::factor(const Scalar& shift) {
  shift_ = shift;
  inverse_shift_ = 1.0 / shift;
  for (Body& body : bodies_)
    for (InputRow<Scalar>& row : body.answer) row = {};
  bool regular = true;
  for (std::size_t i = bodies_.size(); i-- > 0;) regular = eliminate(i) && regular;
  return regular && factor_contacts();
}

/// Of a joint its u, and what is left goes to its parent.
template <typename Scalar>
bool ShiftedBodies<Scalar>::eliminate(std::size_t i) {
  const TreeJoint& joint = model_.joints[i];
  Body& body = bodies_[i];
  if (!joint.moves) return true;
  const int count = joint.driven ? 0 : joint.count();
  CoordinateVariation<Rest> own[3];
  for (int k = 0; k < count; ++k) {
    const Rest one = unit<Scalar, kRest>(kOwn + k);
    own[k] = {true, inverse_shift_ * one, one, shift_ * one};
  }
  Passed<Rest> rest = respond(i, make_last_input<Scalar>(), own);
  Scalar lacks[3][3];
  for (int k = 0; k < count; ++k)
    for (int m = 0; m < count; ++m) lacks[k][m] = number_in(rest.lacks[k], kOwn + m);
  const bool regular = joint.driven || invert_small(count, lacks, body.inverse);
  const ForceRows<Rest> rows(rest.to_parent);
  for (int row = 0; row < kForces; ++row)
    for (int k = 0; k < count; ++k) body.by_own[row][k] = number_in(*rows.of[row], kOwn + k);
  if (joint.parent_moves) carry(i, count, rest);
  return regular;
}

/// How a joint's u follow the parent's variation, and what force that asks of the parent.
/// @param count  of u  @param rest  what comes of the last of the nine numbers
template <typename Scalar>
void ShiftedBodies<Scalar>::carry(std::size_t i, int count, Passed<Rest> rest) {
  const TreeJoint& joint = model_.joints[i];
  Body& body = bodies_[i];
  const CoordinateVariation<Wide> none[3];
  Passed<Wide> most = respond(i, make_inputs<Scalar>(), none);
  Wide by_most[3]{};
  Scalar by_last[3]{};
  for (int k = 0; k < count; ++k)
    for (int m = 0; m < count; ++m) {
      by_most[k] -= body.inverse[k][m] * most.lacks[m];
      by_last[k] -= body.inverse[k][m] * number_in(rest.lacks[m], 0);
    }
  if (joint.driven) {
    by_most[0] = most.lacks[0];
    by_last[0] = number_in(rest.lacks[0], 0);
  }
  for (int k = 0; k < joint.count(); ++k) body.by_parent[k].set(by_most[k], by_last[k]);
  const ForceRows<Wide> most_rows(most.to_parent);
  const ForceRows<Rest> rest_rows(rest.to_parent);
  Body& parent = bodies_[at(joint.parent)];
  for (int row = 0; row < kForces; ++row) {
    Wide answer = parent.answer[row].most() + *most_rows.of[row];
    Scalar last = parent.answer[row].last() + number_in(*rest_rows.of[row], 0);
    for (int k = 0; k < count; ++k) {
      answer += body.by_own[row][k] * by_most[k];
      last += body.by_own[row][k] * by_last[k];
    }
    parent.answer[row].set(answer, last);
  }
}

/// @param f    the parent's variation
/// @param own  of the joint's coordinates
template <typename Scalar>
template <typename T>
typename ShiftedBodies<Scalar>::template Passed<T> ShiftedBodies<Scalar>::respond(std::size_t i, VariedFrame<T> f, const CoordinateVariation<T>* own) const {
  const TreeJoint& joint = model_.joints[i];
  const Body& body = bodies_[i];
  Vec3<T> own_turn;
  vary_joint_frame(joint, body.axes, body.held, body.coordinates, own, f, own_turn);
  SpatialForce<T> force = vary_body_force(joint, body.R, body.held, f);
  add_answer(body.answer, f, force);
  return pass_on(i, own, own_turn, force);
}

/// From who turns with the joint's body to who turns with its parent's, for whom what the joint transmits turns with the joint.
/// @param force  all that is needed behind the joint
template <typename Scalar>
template <typename T>
typename ShiftedBodies<Scalar>::template Passed<T> ShiftedBodies<Scalar>::pass_on(std::size_t i, const CoordinateVariation<T>* own,
                                                                                  const Vec3<T>& own_turn, SpatialForce<T> force) const {
  const TreeJoint& joint = model_.joints[i];
  const Body& body = bodies_[i];
  const SpatialForce<double>& held = body.held.force;
  const auto& axis = body.axes.axis;
  Passed<T> passed;
  if (joint.rotates() && own[0].varies) {
    force.force += cross(own_turn, held.force);
    force.moment += cross(own_turn, held.moment);
  }
  for (int k = 0; k < joint.count(); ++k) {
    passed.lacks[k] = joint.rotates() ? dot(axis[k], force.moment) : dot(axis[k], force.force);
    if (!own[k].varies) continue;
    for (int m = 0; m < k; ++m) passed.lacks[k] -= dot(axis[k], cross(axis[m], held.moment)) * own[m].q;  // an axis turns with those before it
    if (joint.sprung) passed.lacks[k] += joint.stiffness[at(k)] * own[k].q + joint.damping[at(k)] * own[k].qd;
  }
  passed.to_parent = force;
  passed.to_parent.moment += cross(body.axes.r, force.force);
  if (!joint.rotates() && own[0].varies) passed.to_parent.moment += own[0].q * cross(axis[0], held.force);
  return passed;
}

/// y of all journals that touch: what is known of them, and what they answer to themselves through the contacts.
template <typename Scalar>
bool ShiftedBodies<Scalar>::factor_contacts() {
  touching_count_ = 0;
  bool regular = true;
  for (const std::unique_ptr<Contact>& contact : contacts_) {
    if (contact->acting.count == 0 && !contact->derivative->acts()) continue;
    touching_[touching_count_++] = contact.get();
    regular = contact->shifted.factor(*contact->derivative, contact->acting, shift_) && regular;
  }
  journal_matrix_.resize(kJournal * touching_count_);
  groups_ = count_groups(kJournal * touching_count_);
  journal_groups_.fill({});
  for (std::size_t group = 0; group < groups_; ++group) answer_journals(group);
  return journal_matrix_.factor() && regular;
}

/// What comes of a group of the journals' numbers: all that varies, these numbers with it.
template <typename Scalar>
void ShiftedBodies<Scalar>::answer_journals(std::size_t group) {
  const std::size_t first = group * kLanes;
  const std::size_t end = std::min(first + kLanes, journal_matrix_.size());
  wide_room_.forces.fill({});
  for (std::size_t t = 0; t < touching_count_; ++t) {
    const Contact& contact = *touching_[t];
    JournalVariation<Wide> y;
    for (std::size_t column = std::max(first, t * kJournal); column < std::min(end, (t + 1) * kJournal); ++column)
      number_of(y, column - t * kJournal) = unit<Scalar, Lanes::kCount>(static_cast<int>(column - first));
    const Mat3<double>& R = contact.cut.b.R;
    add_need<Wide>(contact, R * y.turn, R * y.p, contact.shifted.apply(y), wide_room_);
  }
  pass_inwards<Wide>(nullptr, wide_room_);
  pass_outwards<Wide>(nullptr, wide_room_);
  for (std::size_t i = 0; i < wide_room_.u.size(); ++i) u_by_journals_[i * groups_ + group] = wide_room_.u[i];
  for (std::size_t d = 0; d < drive_rates_.size(); ++d) drive_force_by_journals_[d * groups_ + group] = wide_room_.drive_force[d];
  for (std::size_t t = 0; t < touching_count_; ++t) {
    JournalVariation<Wide> y = calc_journal(*touching_[t], wide_room_);
    for (std::size_t k = 0; k < kJournal; ++k)
      for (std::size_t column = first; column < end; ++column) {
        const std::size_t row = t * kJournal + k;
        journal_matrix_(row, column) = Scalar{row == column ? 1.0 : 0.0} - number_in(number_of(y, k), static_cast<int>(column - first));
      }
  }
}

/// @param turn, offset  of the journal, in W
template <typename Scalar>
template <typename T>
void ShiftedBodies<Scalar>::add_need(const Contact& contact, const Vec3<T>& turn, const Vec3<T>& offset, const LoadVariation<T>& load, Room<T>& room) const {
  const TreeCutJoint& joint = contact.joint;
  const Vec3<double>& centre = contact.cut.j.p;
  const VariedNeed<T> need =
      vary_need(contact.cut, turn, offset, load, arm_of(joint.bearing_joint, centre), arm_of(joint.journal_joint, centre));
  if (joint.bearing_joint >= 0) room.forces[at(joint.bearing_joint)] += need.of_bearing;
  if (joint.journal_joint >= 0) room.forces[at(joint.journal_joint)] += need.of_journal;
}

template <typename Scalar>
template <typename T>
JournalVariation<T> ShiftedBodies<Scalar>::calc_journal(const Contact& contact, const Room<T>& room) const {
  const CutJointMotion<double, double>& cut = contact.cut;
  const VariedFrame<T> b = see_at(contact.joint.bearing_joint, cut.b.p, room);
  const VariedFrame<T> j = see_at(contact.joint.journal_joint, cut.j.p, room);
  return see_from_bearing(cut.b.R, vary_journal(cut, b, j));
}

/// How the frame of a joint's body varies, with the origin at p.
template <typename Scalar>
template <typename T>
VariedFrame<T> ShiftedBodies<Scalar>::see_at(int joint, const Vec3<double>& p, const Room<T>& room) const {
  return joint < 0 ? VariedFrame<T>{} : move_origin(room.frames[at(joint)], arm_of(joint, p));
}

/// From the origin of a joint's body to p.
template <typename Scalar>
Vec3<double> ShiftedBodies<Scalar>::arm_of(int joint, const Vec3<double>& p) const { return joint < 0 ? p : p - bodies_[at(joint)].p; }

/// How a free coordinate varies with u = 0.
template <typename Scalar>
template <typename T>
CoordinateVariation<T> ShiftedBodies<Scalar>::vary_known(const TreeJoint& joint, int k, const NumbersAt<Scalar>* known) const {
  if constexpr (std::is_same_v<T, Scalar>) {
    const int i = joint.first_free + k;
    return {true, inverse_shift_ * (*known)[i], T{}, -(*known)[free_ + i]};
  } else {
    return {true, T{}, T{}, T{}};
  }
}

/// All that is known of forces goes to the root.
/// @param known  (q, v) of the system's right-hand side; null: zero
template <typename Scalar>
template <typename T>
void ShiftedBodies<Scalar>::pass_inwards(const NumbersAt<Scalar>* known, Room<T>& room) const {
  for (std::size_t i = bodies_.size(); i-- > 0;) {
    const TreeJoint& joint = model_.joints[i];
    const Body& body = bodies_[i];
    CoordinateVariation<T> varies[3];
    Vec3<T> own_turn;
    SpatialForce<T>& force = room.forces[i];
    if (known && !joint.driven) {
      for (int k = 0; k < joint.count(); ++k) varies[k] = vary_known<T>(joint, k, known);
      VariedFrame<T> f;
      vary_joint_frame(joint, body.axes, body.held, body.coordinates, varies, f, own_turn);
      force += vary_body_force(joint, body.R, body.held, f);
      add_answer(body.answer, f, force);
    }
    Passed<T> passed = pass_on(i, varies, own_turn, force);
    T* own = &room.own[at(joint.first)];
    if (joint.driven) {
      own[0] = passed.lacks[0];
    } else {
      for (int k = 0; k < joint.count(); ++k) {
        own[k] = T{};
        for (int m = 0; m < joint.count(); ++m) own[k] -= body.inverse[k][m] * passed.lacks[m];
      }
      const ForceRows<T> rows(passed.to_parent);
      for (int row = 0; row < kForces; ++row)
        for (int k = 0; k < joint.count(); ++k) *rows.of[row] += body.by_own[row][k] * own[k];
    }
    if (joint.parent >= 0) room.forces[at(joint.parent)] += passed.to_parent;
  }
}

/// And u comes back.
template <typename Scalar>
template <typename T>
void ShiftedBodies<Scalar>::pass_outwards(const NumbersAt<Scalar>* known, Room<T>& room) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TreeJoint& joint = model_.joints[i];
    const Body& body = bodies_[i];
    const T* own = &room.own[at(joint.first)];
    T found[3];
    for (int k = 0; k < joint.count(); ++k) found[k] = own[k];
    VariedFrame<T> f;
    if (joint.parent_moves) {
      f = room.frames[at(joint.parent)];
      const Inputs<T> inputs(f);
      for (int k = 0; k < joint.count(); ++k) found[k] += apply_row(body.by_parent[k], inputs);
    }
    if (joint.driven) room.drive_force[at(joint.drive)] = found[0];
    if (!joint.moves) continue;
    CoordinateVariation<T> varies[3];
    for (int k = 0; k < joint.count() && !joint.driven; ++k) {
      room.u[at(joint.first_free + k)] = found[k];
      varies[k] = vary_known<T>(joint, k, known);
      varies[k].q += inverse_shift_ * found[k];
      varies[k].qd = found[k];
      varies[k].qdd += shift_ * found[k];
    }
    Vec3<T> own_turn;
    vary_joint_frame(joint, body.axes, body.held, body.coordinates, varies, f, own_turn);
    room.frames[i] = f;
  }
}

template <typename Scalar>
void ShiftedBodies<Scalar>::solve_in_place(NumbersAt<Scalar> x) {
  const NumbersAt<Scalar> z = x.from(2 * free_);
  losses_ = {};
  room_.forces.fill({});
  for (std::size_t t = 0; t < touching_count_; ++t) {
    const LoadVariation<Scalar> load = touching_[t]->shifted.start(z.from(touching_[t]->acting.first));
    add_need<Scalar>(*touching_[t], {}, {}, load, room_);
    add_losses(load);
  }
  pass_inwards(&x, room_);
  pass_outwards(&x, room_);
  for (int b = 0; b < bristles_; ++b) z.set(b, inverse_shift_ * z[b]);
  solve_journals(z);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TreeJoint& joint = model_.joints[i];
    for (int k = 0; k < joint.count() && !joint.driven; ++k) losses_.structural += bodies_[i].rate_of_loss[k] * room_.u[at(joint.first_free + k)];
  }
  write_state(x);
}

/// The touching journals' motions, and what they add to all else. @param z  bristles
template <typename Scalar>
void ShiftedBodies<Scalar>::solve_journals(NumbersAt<Scalar> z) {
  for (std::size_t t = 0; t < touching_count_; ++t) {
    JournalVariation<Scalar> y = calc_journal(*touching_[t], room_);
    for (std::size_t k = 0; k < kJournal; ++k) journals_[t * kJournal + k] = number_of(y, k);
  }
  journal_matrix_.solve_in_place(journals_.data());
  for (std::size_t i = 0; i < journal_matrix_.size(); ++i) set_number_in(journal_groups_[i / kLanes], static_cast<int>(i % kLanes), journals_[i]);
  const auto answer = [&](const Wide* by_journals) {
    Wide products{};
    for (std::size_t g = 0; g < groups_; ++g) products += by_journals[g] * journal_groups_[g];
    return sum(products);
  };
  for (std::size_t i = 0; i < room_.u.size(); ++i) room_.u[i] += answer(&u_by_journals_[i * groups_]);
  for (std::size_t d = 0; d < drive_rates_.size(); ++d) room_.drive_force[d] += answer(&drive_force_by_journals_[d * groups_]);
  for (std::size_t t = 0; t < touching_count_; ++t) {
    JournalVariation<Scalar> y;
    for (std::size_t k = 0; k < kJournal; ++k) number_of(y, k) = journals_[t * kJournal + k];
    add_losses(touching_[t]->shifted.apply(y));
    touching_[t]->shifted.finish(y, z.from(touching_[t]->acting.first));
  }
}

template <typename Scalar>
void ShiftedBodies<Scalar>::add_losses(const LoadVariation<Scalar>& load) {
  losses_.impact += load.impact_power;
  losses_.friction += load.friction_power;
}

/// All but the bristles.
template <typename Scalar>
void ShiftedBodies<Scalar>::write_state(NumbersAt<Scalar> x) const {
  for (int i = 0; i < free_; ++i) {
    const Scalar u = room_.u[at(i)];
    x.set(i, inverse_shift_ * (u + x[i]));
    x.set(free_ + i, u);
  }
  const int first = 2 * free_ + bristles_, drives = static_cast<int>(drive_rates_.size());
  const auto add = [&](int i, const Scalar& power) { x.set(first + i, inverse_shift_ * (x[first + i] + power)); };
  for (int d = 0; d < drives; ++d) add(d, drive_rates_[at(d)] * room_.drive_force[at(d)]);
  add(drives, losses_.impact);
  add(drives + 1, losses_.friction);
  add(drives + 2, losses_.structural);
}

template class ShiftedBodies<double>;
template class ShiftedBodies<Complex<double>>;

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
