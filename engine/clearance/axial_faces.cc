#include "engine/clearance/axial_faces.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace engine {

AxialFaces::AxialFaces(const ClearanceParameters& joint)
    : joint_(joint), point_stiffness_(joint.K_a / (joint.n_a * joint.n_ce_axial)) {
  for (const double side : {1.0, -1.0})
    for (int circle = 1; circle <= joint.n_a; ++circle)
      for (int k = 0; k < joint.n_ce_axial; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / joint.n_ce_axial;
        const double radius = joint.r_j() * circle / joint.n_a;
        points_.emplace_back(radius * std::cos(angle), radius * std::sin(angle), side * 0.5 * joint.L_b);
      }
  latches_.resize(points_.size());
}

template <typename Visit>
void AxialFaces::for_each_point(const JournalMotion& journal, const Visit& visit) const {
  const double limit = 0.5 * joint_.L_b + joint_.c_a;
  const Eigen::Vector3d axis_j = journal.R_bj.row(2);  // the bearing's z in {j}
  const std::size_t of_one_face = points_.size() / 2;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const double side = k < of_one_face ? 1.0 : -1.0;
    visit(k, side, side * (journal.p_bj.z() + axis_j.dot(points_[k])) - limit);
  }
}

Penetration AxialFaces::calc_penetration(const JournalMotion& journal, std::size_t point, double side, double delta) const {
  return {delta, side * journal.calc_velocity(journal.R_bj * points_[point]).z()};
}

void AxialFaces::calc(const JournalMotion& journal, ContactLoad& load) const {
  for_each_point(journal, [&](std::size_t k, double side, double delta) {
    if (!(delta > 0.0)) return;
    const double rate = calc_penetration(journal, k, side, delta).rate;
    const double onset = latches_[k].onset_rate(rate, joint_.minimum_onset_rate);
    const NormalForce normal = calc_normal_force(point_stiffness_ * delta, rate, onset, joint_.chi);
    load.add_force(journal.R_bj * points_[k], {0.0, 0.0, -side * normal.total});
    load.elastic_energy += 0.5 * normal.elastic * delta;
    load.impact_power += normal.calc_loss_power(rate);
  });
}

bool AxialFaces::advance(const JournalMotion& start, const JournalMotion& end, double dt) {
  bool changed = false;
  const Eigen::Vector3d axis_start = start.R_bj.row(2);
  const double limit = 0.5 * joint_.L_b + joint_.c_a;
  for_each_point(end, [&](std::size_t k, double side, double delta) {
    if (!latches_[k].in_contact() && delta <= 0.0) return;
    const double delta_start = side * (start.p_bj.z() + axis_start.dot(points_[k])) - limit;
    changed |= latches_[k].advance(calc_penetration(start, k, side, delta_start), calc_penetration(end, k, side, delta), dt,
                                   joint_.minimum_onset_rate);
  });
  return changed;
}

}  // namespace engine
