#include "engine/dynamics/state_jacobian.h"

#include <cstddef>

namespace engine {

namespace {

void make_room(std::vector<double>& room, int rows, int columns, double*& at) {
  room.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  at = room.data();
}

}  // namespace

StateJacobian::StateJacobian(int free_coordinates, int bristles, int drives)
    : free_(free_coordinates), bristles_(bristles), acting_(static_cast<std::size_t>(bristles)) {
  derivatives_.outputs = free_ + drives + 3;
  derivatives_.stride = calc_pair_stride(bristles_);
  derivatives_.bristles = acting_.data();
  make_room(by_t_, derivatives_.outputs, 1, derivatives_.by_t);
  make_room(rates_by_t_, 2, derivatives_.stride, derivatives_.rates_by_t);
}

void StateJacobian::make_matrices() {
  const int stride = derivatives_.stride;
  make_room(by_q_, derivatives_.outputs, free_, derivatives_.by_q);
  make_room(by_v_, derivatives_.outputs, free_, derivatives_.by_v);
  make_room(by_bristle_, derivatives_.outputs, 2 * stride, derivatives_.by_bristle);
  make_room(rates_by_q_, free_, 2 * stride, derivatives_.rates_by_q);
  make_room(rates_by_v_, free_, 2 * stride, derivatives_.rates_by_v);
  make_room(rates_by_own_, 4, stride, derivatives_.rates_by_own);
}

void StateJacobian::calc_time_derivative(Eigen::VectorXd& by_t) const {
  const Linearisation& d = derivatives_;
  const int rates_of_work = d.outputs - free_;
  by_t.setZero(2 * free_ + bristles_ + rates_of_work);
  double* to = by_t.data() + free_;
  for (int i = 0; i < free_; ++i) to[i] = d.by_t[i];
  for (int i = 0; i < rates_of_work; ++i) to[free_ + bristles_ + i] = d.by_t[free_ + i];
  for (int pair = 0; pair < d.pairs; ++pair)
    for (int k = 0; k < 2; ++k) to[free_ + d.bristles[2 * pair + k]] = d.rates_by_t[k * d.stride + pair];
}

}  // namespace engine
