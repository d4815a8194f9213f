#include "engine/dynamics/state_jacobian.h"

#include <cstddef>

namespace engine {

namespace {

std::size_t area(int rows, int columns) { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }

}  // namespace

StateJacobian::StateJacobian(int free_coordinates, int bristles, int drives)
    : free_(free_coordinates), bristles_(bristles), rates_of_work_(drives + 3) {
  const int outputs = free_ + bristles_ + rates_of_work_;
  by_t_.resize(area(outputs, 1));
  acting_.resize(area(bristles_, 1));
  derivatives_.outputs = outputs;
  derivatives_.bristles = acting_.data();
  derivatives_.by_t = by_t_.data();
}

void StateJacobian::make_matrices() {
  const int outputs = free_ + bristles_ + rates_of_work_;
  by_q_.resize(area(outputs, free_));
  by_v_.resize(area(outputs, free_));
  by_bristle_.resize(area(outputs, bristles_));
  derivatives_.by_q = by_q_.data();
  derivatives_.by_v = by_v_.data();
  derivatives_.by_bristle = by_bristle_.data();
}

void StateJacobian::calc_time_derivative(Eigen::VectorXd& by_t) const {
  const int acting = derivatives_.bristle_count;
  by_t.setZero(2 * free_ + bristles_ + rates_of_work_);
  double* to = by_t.data() + free_;
  const double* from = by_t_.data();
  for (int i = 0; i < free_; ++i) to[i] = from[i];
  for (int b = 0; b < acting; ++b) to[free_ + acting_.data()[b]] = from[free_ + b];
  for (int i = 0; i < rates_of_work_; ++i) to[free_ + bristles_ + i] = from[free_ + acting + i];
}

}  // namespace engine
