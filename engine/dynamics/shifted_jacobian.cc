#include "engine/dynamics/shifted_jacobian.h"

#include <cmath>
#include <cstddef>

namespace engine {

ShiftedJacobian::ShiftedJacobian(int free_coordinates, int bristles, int drives)
    : free_(free_coordinates), bristles_(bristles), rates_of_work_(drives + 3) {
  const int outputs = free_ + bristles_ + rates_of_work_;
  by_q_.setZero(outputs, free_);
  by_v_.setZero(outputs, free_);
  by_bristle_.setZero(outputs, bristles_);
  by_t_.setZero(outputs);
  acting_.resize(static_cast<std::size_t>(bristles_));
  derivatives_ = {outputs, 0, acting_.data(), by_q_.data(), by_v_.data(), by_t_.data(), by_bristle_.data()};
  reduced_.setIdentity(free_, free_);
  lu_.compute(reduced_);
  bristle_response_.setZero(bristles_, free_);
  bristle_inverse_.resize(static_cast<std::size_t>(bristles_ / 2));
  rate_.setZero(free_);
  bristle_.setZero(bristles_);
}

void ShiftedJacobian::calc_time_derivative(Eigen::VectorXd& by_t) const {
  const int acting = derivatives_.bristle_count;
  by_t.setZero(2 * free_ + bristles_ + rates_of_work_);
  by_t.segment(free_, free_) = by_t_.head(free_);
  for (int b = 0; b < acting; ++b) by_t[2 * free_ + acting_[static_cast<std::size_t>(b)]] = by_t_[free_ + b];
  by_t.tail(rates_of_work_) = by_t_.segment(free_ + acting, rates_of_work_);
}

bool ShiftedJacobian::factor(double shift) {
  const int acting = derivatives_.bristle_count;
  inverse_shift_ = 1.0 / shift;
  reduced_.noalias() = -by_v_.topRows(free_) - inverse_shift_ * by_q_.topRows(free_);
  reduced_.diagonal().array() += shift;
  for (int b = 0; b < acting; b += 2) {
    const Eigen::Matrix2d own = shift * Eigen::Matrix2d::Identity() - by_bristle_.block<2, 2>(free_ + b, b);
    Eigen::Matrix2d& inverse = bristle_inverse_[static_cast<std::size_t>(b / 2)];
    inverse = own.inverse();
    bristle_response_.middleRows<2>(b).noalias() =
        inverse * (by_v_.middleRows<2>(free_ + b) + inverse_shift_ * by_q_.middleRows<2>(free_ + b));
  }
  if (acting > 0) reduced_.noalias() -= by_bristle_.topLeftCorner(free_, acting).lazyProduct(bristle_response_.topRows(acting));
  lu_.compute(reduced_);
  return std::isfinite(lu_.matrixLU().diagonal().sum()) && lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0;
}

void ShiftedJacobian::solve_in_place(Eigen::VectorXd& x) {
  const int acting = derivatives_.bristle_count;
  auto q = x.head(free_);
  auto v = x.segment(free_, free_);
  auto z = x.segment(2 * free_, bristles_);
  auto work = x.tail(rates_of_work_);
  q *= inverse_shift_;
  rate_.noalias() = v + by_q_.topRows(free_).lazyProduct(q);
  for (int b = 0; b < acting; b += 2) {
    const int first = acting_[static_cast<std::size_t>(b)];
    const Eigen::Vector2d known = z.segment<2>(first) + by_q_.middleRows<2>(free_ + b).lazyProduct(q);
    bristle_.segment<2>(b).noalias() = bristle_inverse_[static_cast<std::size_t>(b / 2)] * known;
  }
  if (acting > 0) rate_.noalias() += by_bristle_.topLeftCorner(free_, acting).lazyProduct(bristle_.head(acting));
  v = lu_.solve(rate_);
  q += inverse_shift_ * v;
  if (acting > 0) bristle_.head(acting).noalias() += bristle_response_.topRows(acting).lazyProduct(v);
  z *= inverse_shift_;
  for (int b = 0; b < acting; ++b) z[acting_[static_cast<std::size_t>(b)]] = bristle_[b];
  const int first = free_ + acting;
  work.noalias() += by_q_.middleRows(first, rates_of_work_).lazyProduct(q) + by_v_.middleRows(first, rates_of_work_).lazyProduct(v);
  if (acting > 0) work.noalias() += by_bristle_.block(first, 0, rates_of_work_, acting).lazyProduct(bristle_.head(acting));
  work *= inverse_shift_;
}

}  // namespace engine
