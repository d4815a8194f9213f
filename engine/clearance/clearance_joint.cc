// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/clearance_joint.h"

#include "engine/clearance/joint_contact.h"

namespace engine {

namespace {

std::variant<RadialContinuum, RadialElements, PointContacts> make_radial(const ClearanceParameters& joint) {
  if (joint.geometry != ContactGeometry::kJournalInBore) return PointContacts(joint);
  if (joint.form == RadialForm::kElements) return RadialElements(joint);
  return RadialContinuum(joint);
}

}  // namespace

ClearanceJoint::ClearanceJoint(const ClearanceParameters& joint)
    : radial_(make_radial(joint)), faces_(joint) {}

int ClearanceJoint::bristle_count() const {
  return std::visit([](const auto& radial) { return radial.bristle_count(); }, radial_);
}

int ClearanceJoint::ring_count() const {
  if (const PointContacts* contacts = points()) return contacts->count();
  return std::visit([](const auto& radial) { return radial.parameters().n_r; }, radial_);
}

bool ClearanceJoint::calc(const JournalMotion& journal, const double* bristles, double* bristle_rates,
                          ContactLoad& load) const {
  JointLoad<double> sum;
  const bool complete = add_contacts(*this, to_relative_motion(journal), bristles, bristle_rates, sum);
  load = to_contact_load(sum);
  return complete;
}

void ClearanceJoint::add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const {
  std::visit([&](const auto& radial) { radial.add_penetrations(journal, rings); }, radial_);
}

bool ClearanceJoint::follow(const JournalMotion& journal, double dt, double* bristles) {
  if (auto* contacts = std::get_if<PointContacts>(&radial_)) return contacts->follow(journal, bristles);
  auto* elements = std::get_if<RadialElements>(&radial_);
  return elements && elements->follow(journal, dt, bristles);
}

ContactChange ClearanceJoint::advance(const JournalMotion& start, const JournalMotion& end, double dt,
                                      double* bristles) {
  ContactChange change =
      std::visit([&](auto& radial) { return radial.advance(start, end, dt, bristles); }, radial_);
  change += faces_.advance(start, end, dt);
  return change;
}

Eigen::VectorXd ClearanceJoint::widen(const double* bristles) {
  if (auto* elements = std::get_if<RadialElements>(&radial_)) return elements->widen(bristles);
  return Eigen::Map<const Eigen::VectorXd>(bristles, bristle_count());
}

}  // namespace engine
