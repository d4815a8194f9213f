// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/newton/contact_update.h"

#include <algorithm>
#include <cstddef>

#include "engine/dynamics/kernel/tangent/contact_tangent.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

namespace {

constexpr std::size_t kLanes = Lanes::kCount;

/// Packs that hold so many numbers.
[[nodiscard]] std::size_t count_packs(std::size_t numbers) { return (numbers + kLanes - 1) / kLanes; }

/// One of the twelve numbers of a journal's tangent.
template <typename T>
[[nodiscard]] RPSUP_INLINE T& number_of(JournalTangent_b<T>& xi, std::size_t k) {
  Vec3<T>& v = k < 3 ? xi.rotation : k < 6 ? xi.offset : k < 9 ? xi.v : xi.w;
  return k % 3 == 0 ? v.x : k % 3 == 1 ? v.y : v.z;
}

template <typename Scalar>
void add_losses(const LoadTangent<Scalar>& load, LossPowers<Scalar>& losses) {
  losses.impact += load.impact_power;
  losses.friction += load.friction_power;
}

}  // namespace

template <typename Scalar>
ContactUpdate<Scalar>::ContactUpdate(const TreeModel& model, const std::vector<ClearanceJoint>& joints)
    : touching_(joints.size()),
      capacitance_matrix_(kJournal * joints.size()),
      xi_(kJournal * joints.size()),
      xi_packs_(count_packs(xi_.size())),
      qd_by_xi_(model.free.size() * xi_packs_.size()),
      drive_force_by_xi_(model.drives.size() * xi_packs_.size()),
      pack_work_(model) {
  for (const TreeCutJoint& joint : model.cut_joints)
    contacts_.push_back(std::make_unique<Contact>(joint, joints[joint.clearance].bristle_count()));
}

template <typename Scalar>
void ContactUpdate<Scalar>::set_operating_point(const OperatingPointView& point) {
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    Contact& contact = *contacts_[k];
    contact.cut = point.cuts[k];
    contact.derivative = point.contacts[contact.joint.clearance].get();
    contact.acting = point.acting[contact.joint.clearance];
  }
}

template <typename Scalar>
bool ContactUpdate<Scalar>::factor(const Tree& tree, const Scalar& shift) {
  touching_count_ = 0;
  bool regular = true;
  for (const std::unique_ptr<Contact>& contact : contacts_) {
    if (contact->acting.count == 0 && !contact->derivative->acts()) continue;
    touching_[touching_count_++] = contact.get();
    regular = contact->condensed.factor(*contact->derivative, contact->acting, shift) && regular;
  }
  capacitance_matrix_.resize(kJournal * touching_count_);
  packs_ = count_packs(kJournal * touching_count_);
  xi_packs_.fill({});
  for (std::size_t pack = 0; pack < packs_; ++pack) assemble_capacitance(tree, pack);
  return capacitance_matrix_.factor() && regular;
}

/// Computes columns of T_0^-1 Gamma and of 1 - G T_0^-1 Gamma, for a pack of unit numbers of xi.
template <typename Scalar>
void ContactUpdate<Scalar>::assemble_capacitance(const Tree& tree, std::size_t pack) {
  const std::size_t first = pack * kLanes;
  const std::size_t end = std::min(first + kLanes, capacitance_matrix_.size());
  pack_work_.bias_force.fill({});
  for (std::size_t t = 0; t < touching_count_; ++t) {
    const Contact& contact = *touching_[t];
    JournalTangent_b<Pack8> xi;
    for (std::size_t column = std::max(first, t * kJournal); column < std::min(end, (t + 1) * kJournal);
         ++column)
      number_of(xi, column - t * kJournal) = unit<Scalar, Lanes::kCount>(static_cast<int>(column - first));
    const Mat3<double>& R = contact.cut.b.R;
    add_contact_force<Pack8>(tree, contact, R * xi.rotation, R * xi.offset, contact.condensed.apply(xi),
                             pack_work_);
  }
  tree.solve(pack_work_);
  for (std::size_t i = 0; i < pack_work_.qd.size(); ++i) qd_by_xi_[i * packs_ + pack] = pack_work_.qd[i];
  for (std::size_t d = 0; d < pack_work_.drive_force.size(); ++d)
    drive_force_by_xi_[d * packs_ + pack] = pack_work_.drive_force[d];
  for (std::size_t t = 0; t < touching_count_; ++t) {
    JournalTangent_b<Pack8> xi = journal_tangent(tree, *touching_[t], pack_work_);
    for (std::size_t k = 0; k < kJournal; ++k)
      for (std::size_t column = first; column < end; ++column) {
        const std::size_t row = t * kJournal + k;
        capacitance_matrix_(row, column) =
            Scalar{row == column ? 1.0 : 0.0} -
            number_in(number_of(xi, k), static_cast<int>(column - first));
      }
  }
}

/// Adds the tangents of the bias forces of bearing and journal, Eq. (K20).
/// @param rotation, offset  of the journal, in W
template <typename Scalar>
template <typename T>
void ContactUpdate<Scalar>::add_contact_force(const Tree& tree, const Contact& contact,
                                              const Vec3<T>& rotation, const Vec3<T>& offset,
                                              const LoadTangent<T>& load,
                                              typename Tree::template Workspace<T>& work) const {
  const TreeCutJoint& joint = contact.joint;
  const Vec3<double>& centre = contact.cut.j.p;
  const ContactForceTangent<T> forces = calc_contact_force_tangent(
      contact.cut, rotation, offset, load, tree.offset_from_origin(joint.bearing_joint, centre),
      tree.offset_from_origin(joint.journal_joint, centre));
  if (joint.bearing_joint >= 0) work.bias_force[joint.bearing_joint] += forces.on_bearing;
  if (joint.journal_joint >= 0) work.bias_force[joint.journal_joint] += forces.on_journal;
}

/// xi of a joint by the frames of its bodies, Eq. (K19).
template <typename Scalar>
template <typename T>
JournalTangent_b<T> ContactUpdate<Scalar>::journal_tangent(
    const Tree& tree, const Contact& contact, const typename Tree::template Workspace<T>& work) const {
  const CutJointMotion<double, double>& cut = contact.cut;
  const FrameTangent<T> b = tree.tangent_at_point(contact.joint.bearing_joint, cut.b.p, work);
  const FrameTangent<T> j = tree.tangent_at_point(contact.joint.journal_joint, cut.j.p, work);
  return to_bearing_frame(cut.b.R, calc_journal_tangent(cut, b, j));
}

template <typename Scalar>
void ContactUpdate<Scalar>::add_bristle_loads(const Tree& tree, NumbersAt<Scalar> z, Workspace& work,
                                              LossPowers<Scalar>& losses) {
  for (std::size_t t = 0; t < touching_count_; ++t) {
    const LoadTangent<Scalar> load = touching_[t]->condensed.start(z.from(touching_[t]->acting.first));
    add_contact_force<Scalar>(tree, *touching_[t], {}, {}, load, work);
    add_losses(load, losses);
  }
}

template <typename Scalar>
void ContactUpdate<Scalar>::apply_woodbury(const Tree& tree, NumbersAt<Scalar> z, Workspace& work,
                                           LossPowers<Scalar>& losses) {
  for (std::size_t t = 0; t < touching_count_; ++t) {
    JournalTangent_b<Scalar> xi = journal_tangent(tree, *touching_[t], work);
    for (std::size_t k = 0; k < kJournal; ++k) xi_[t * kJournal + k] = number_of(xi, k);
  }
  capacitance_matrix_.solve_in_place(xi_.data());
  for (std::size_t i = 0; i < capacitance_matrix_.size(); ++i)
    set_number_in(xi_packs_[i / kLanes], static_cast<int>(i % kLanes), xi_[i]);
  const auto dot_xi = [&](const Pack8* row) {
    Pack8 products{};
    for (std::size_t pack = 0; pack < packs_; ++pack) products += row[pack] * xi_packs_[pack];
    return sum(products);
  };
  for (std::size_t i = 0; i < work.qd.size(); ++i) work.qd[i] += dot_xi(&qd_by_xi_[i * packs_]);
  for (std::size_t d = 0; d < work.drive_force.size(); ++d)
    work.drive_force[d] += dot_xi(&drive_force_by_xi_[d * packs_]);
  for (std::size_t t = 0; t < touching_count_; ++t) {
    JournalTangent_b<Scalar> xi;
    for (std::size_t k = 0; k < kJournal; ++k) number_of(xi, k) = xi_[t * kJournal + k];
    add_losses(touching_[t]->condensed.apply(xi), losses);
    touching_[t]->condensed.finish(xi, z.from(touching_[t]->acting.first));
  }
}

template class ContactUpdate<double>;
template class ContactUpdate<Complex<double>>;

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
