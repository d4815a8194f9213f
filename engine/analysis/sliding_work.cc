#include "engine/analysis/sliding_work.h"

#include <cmath>
#include <cstddef>

namespace engine {

namespace {

/// Where a ring of the journal touches, or would.
struct RingTouch {
  double delta = 0.0;         ///< [m]
  double n_x = 0.0, n_y = 0.0;
  double speed = 0.0;         ///< of sliding, [m/s]
};

RingTouch calc_touch(const RpsupParameters& parameters, const WornBore* worn, const JournalMotion& journal, int ring) {
  const int rings = parameters.radial_levels;
  const double position = rings == 1 ? 0.0 : parameters.bearing_length * (static_cast<double>(ring) / (rings - 1) - 0.5);
  const Eigen::Vector3d axial = position * journal.R_bj.col(2);
  const Eigen::Vector2d offset = (journal.p_bj + axial).head<2>();
  const double distance = offset.norm();
  if (distance <= parameters.c_r) return {};
  const double delta = distance - parameters.c_r - (worn ? worn->calc_reach(ring, std::atan2(offset[1], offset[0])).value : 0.0);
  if (delta <= 0.0) return {};
  const Eigen::Vector3d normal(offset[0] / distance, offset[1] / distance, 0.0);
  const Eigen::Vector3d velocity = journal.calc_velocity(axial + (parameters.bearing_radius - parameters.c_r) * normal);
  return {delta, normal[0], normal[1], (velocity - velocity.dot(normal) * normal).norm()};
}

}  // namespace

SlidingWork::SlidingWork(const RpsupParameters& parameters)
    : parameters_(parameters),
      worn_(parameters.wear_depth.empty() ? nullptr : std::make_shared<const WornBore>(parameters.c_r, parameters.wear_depth)),
      before_(static_cast<std::size_t>(parameters.radial_levels)), after_(before_), shares_(before_.size()) {}

void SlidingWork::add(const JointState& joint, double time) {
  if (!(joint.load.radial_normal_sum > 0.0)) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < shares_.size(); ++i)
    sum += shares_[i] = std::pow(calc_touch(parameters_, worn_.get(), joint.journal, static_cast<int>(i)).delta, 1.5);
  if (!(sum > 0.0)) return;  // the faces alone touch
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    if (shares_[i] == 0.0) continue;
    const RingTouch touch = calc_touch(parameters_, worn_.get(), joint.journal, static_cast<int>(i));
    const double work = joint.load.radial_normal_sum * (shares_[i] / sum) * touch.speed * time;
    after_[i].work += work;
    after_[i].work_x += work * touch.n_x;
    after_[i].work_y += work * touch.n_y;
    after_[i].work_delta += work * touch.delta;
  }
}

void SlidingWork::take_step(const Evaluation& start, const Evaluation& end) {
  before_ = after_;
  start_ = start.t;
  end_ = end.t;
  for (const Evaluation* at : {&start, &end}) add(at->joints[0], 0.5 * (end.t - start.t));
}

SlidingWork::Ring SlidingWork::at(std::size_t ring, double part) const {
  const Ring& a = before_[ring];
  const Ring& b = after_[ring];
  return {std::lerp(a.work, b.work, part), std::lerp(a.work_x, b.work_x, part), std::lerp(a.work_y, b.work_y, part),
          std::lerp(a.work_delta, b.work_delta, part)};
}

double SlidingWork::total() const {
  double sum = 0.0;
  for (const Ring& ring : after_) sum += ring.work;
  return sum;
}

}  // namespace engine
