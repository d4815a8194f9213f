// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/sliding_work.h"

#include <cmath>
#include <cstddef>

#include "engine/clearance/contact_law.h"
#include "engine/model/rpsup.h"

namespace engine {

namespace {

/// Without clearance nothing is read of it but the number of rings.
ClearanceParameters joint_of(const RpsupParameters& parameters) {
  if (parameters.c_r > 0.0) return make_clearance(parameters);
  ClearanceParameters none;
  none.c_r = 0.0;
  none.n_r = parameters.radial_levels;
  return none;
}

/// In proportion to the elastic force of a ring; that of contact elements on an arc falls like Hertz's.
double calc_share(const ClearanceParameters& joint, double delta) {
  return joint.cylinders.law == StiffnessLaw::kHertz ? delta * std::sqrt(delta)
                                                     : joint.cylinders.calc(delta).force;
}

SlidingWork::RingContact calc_ring_contact(const ClearanceParameters& joint, const JournalMotion& journal,
                                           int ring) {
  const Eigen::Vector3d axial = calc_ring_position(joint, ring) * journal.R_bj.col(2);
  const Eigen::Vector2d offset = (journal.p_bj + axial).head<2>();
  const double distance = offset.norm();
  if (distance <= joint.c_r) return {};
  const double delta =
      distance - joint.c_r -
      (joint.worn ? joint.worn->calc_added_clearance(ring, std::atan2(offset[1], offset[0])).value : 0.0);
  if (delta <= 0.0) return {};
  const Eigen::Vector3d normal(offset[0] / distance, offset[1] / distance, 0.0);
  const Eigen::Vector3d velocity = journal.calc_velocity(axial + joint.r_j() * normal);
  return {delta, calc_share(joint, delta), normal[0], normal[1],
          (velocity - velocity.dot(normal) * normal).norm()};
}

}  // namespace

SlidingWork::SlidingWork(const RpsupParameters& parameters) : SlidingWork(joint_of(parameters), 0) {}

SlidingWork::SlidingWork(const ClearanceParameters& joint, std::size_t index)
    : joint_(joint),
      index_(index),
      before_(static_cast<std::size_t>(joint_.n_r)),
      after_(before_),
      contacts_(before_.size()) {}

void SlidingWork::calc_ring_contacts(const JointState& joint) {
  const bool touches = joint.load.radial_normal_sum > 0.0;
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    contacts_[i] = touches ? calc_ring_contact(joint_, joint.journal, static_cast<int>(i)) : RingContact{};
}

void SlidingWork::add(const JointState& joint, double time) {
  double sum = 0.0;
  for (const RingContact& contact : contacts_) sum += contact.share;
  if (!(sum > 0.0)) return;  // nothing, or the faces alone
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const RingContact& contact = contacts_[i];
    const double work = joint.load.radial_normal_sum * (contact.share / sum) * contact.speed * time;
    after_[i].work += work;
    after_[i].work_x += work * contact.n_x;
    after_[i].work_y += work * contact.n_y;
    after_[i].work_delta += work * contact.delta;
  }
}

void SlidingWork::take_step(const Evaluation& start, const Evaluation& end) {
  before_ = after_;
  const double half = 0.5 * (end.t - start.t);
  // Else the journal is where the step before left it.
  if (start.t != end_) calc_ring_contacts(start.joints[index_]);
  add(start.joints[index_], half);
  calc_ring_contacts(end.joints[index_]);
  add(end.joints[index_], half);
  start_ = start.t;
  end_ = end.t;
}

SlidingWork::Ring SlidingWork::at(std::size_t ring, double part) const {
  const Ring& a = before_[ring];
  const Ring& b = after_[ring];
  return {std::lerp(a.work, b.work, part), std::lerp(a.work_x, b.work_x, part),
          std::lerp(a.work_y, b.work_y, part), std::lerp(a.work_delta, b.work_delta, part)};
}

double SlidingWork::total() const {
  double sum = 0.0;
  for (const Ring& ring : after_) sum += ring.work;
  return sum;
}

std::vector<Channel> SlidingWork::channels(const std::string& prefix) const {
  std::vector<Channel> channels;
  for (std::size_t ring = 0; ring < after_.size(); ++ring) add_ring_channels(prefix, ring, channels);
  return channels;
}

void SlidingWork::add_ring_channels(const std::string& prefix, std::size_t ring,
                                    std::vector<Channel>& channels) const {
  const auto add = [&](const char* ending, const char* more, double Ring::*part) {
    Channel& channel = channels.emplace_back();
    channel.info.key = prefix + "ring_" + std::to_string(ring + 1) + "_sliding_work" + ending;
    channel.info.help =
        "Time integral of normal force × sliding speed of this ring of the journal since t = 0";
    channel.info.help += more;
    channel.read = make_reading(ring, part);
  };
  add("_j", prefix.empty() ? "; null without clearance" : "", &Ring::work);
  add("_x_j", ", weighted with x of the contact normal", &Ring::work_x);
  add("_y_j", ", weighted with y of the contact normal", &Ring::work_y);
  if (joint_.worn)
    add("_penetration_j_m", ", weighted with the penetration; of worn bores only", &Ring::work_delta);
}

Reading SlidingWork::make_reading(std::size_t ring, double Ring::*part) const {
  const bool has_clearance = joint_.c_r > 0.0;
  if (!has_clearance) return [](const Evaluation&) { return kNoValue; };
  return [this, ring, part](const Evaluation& instant) { return at(ring, fraction_of(instant.t)).*part; };
}

}  // namespace engine
