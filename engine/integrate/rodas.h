// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Core>
// Odeint's resizing of Eigen vectors must be known before its steppers.
#include <boost/numeric/odeint/external/eigen/eigen_resize.hpp>
#include <boost/numeric/odeint/algebra/default_operations.hpp>
#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>
#include <boost/numeric/odeint/stepper/stepper_categories.hpp>
#include <boost/numeric/odeint/util/resizer.hpp>
#include <boost/numeric/odeint/util/state_wrapper.hpp>
#include <boost/numeric/odeint/util/unwrap_reference.hpp>

#include "engine/integrate/rodas_coefficients.h"

namespace engine {

/// RODAS5(4) by G. A. Di Marzo: an L-stable, stiffly accurate Rosenbrock method of order 5 with an error
/// estimate of order 4, as an Odeint error stepper on Eigen vectors. A step takes one Jacobian, one
/// factorisation, a solution for each of its eight stages and, with f at its start given, seven evaluations
/// of f.
///
/// The systems are Odeint's with the linear algebra of a linearly implicit method:
///
///     system(y, dydt, t)              dydt <- f(t, y)
///     system.linearise(y, t)          the following three calls are about J = df/dy and df/dt at (t, y)
///     system.time_derivative()        df/dt there
///     system.factor(shift)            factors shift 1 - J; false if the matrix is singular
///     system.solve_in_place(x)        x <- (shift 1 - J)^-1 x
///
/// linearise() is called at each step's start. A system that knows the step to be a repeated one, from the
/// same (t, y), need do nothing. Where the matrix is singular, the result and its error are not numbers.
///
/// Source of the form: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.7.
class Rodas5Stepper {
 public:
  using K = Rodas5Coefficients;
  using state_type = Eigen::VectorXd;
  using deriv_type = Eigen::VectorXd;
  using value_type = double;
  using time_type = double;
  using order_type = unsigned short;
  using algebra_type = boost::numeric::odeint::vector_space_algebra;
  using operations_type = boost::numeric::odeint::default_operations;
  using resizer_type = boost::numeric::odeint::always_resizer;
  using wrapped_state_type = boost::numeric::odeint::state_wrapper<state_type>;
  using wrapped_deriv_type = boost::numeric::odeint::state_wrapper<deriv_type>;
  using stepper_category = boost::numeric::odeint::error_stepper_tag;

  static constexpr order_type order_value = K::kOrder;
  static constexpr order_type stepper_order_value = K::kOrder;
  static constexpr order_type error_order_value = K::kOrder - 1;

  [[nodiscard]] order_type order() const { return order_value; }
  [[nodiscard]] order_type stepper_order() const { return stepper_order_value; }
  [[nodiscard]] order_type error_order() const { return error_order_value; }

  [[nodiscard]] algebra_type& algebra() { return algebra_; }

  /// Room for states like y. Equal sizes allocate nothing.
  void adjust_size(const state_type& y) {
    for (state_type& U : U_) U.resize(y.size());
    start_f_.resize(y.size());
    stage_.resize(y.size());
    error_.resize(y.size());
  }

  template <class System>
  void do_step(System system, state_type& y, time_type t, time_type dt) {
    do_step(system, y, t, dt, error_);
  }

  template <class System>
  void do_step(System system, state_type& y, time_type t, time_type dt, state_type& error) {
    do_step(system, y, t, y, dt, error);
  }

  template <class System>
  void do_step(System system, const state_type& y, time_type t, state_type& end, time_type dt) {
    do_step(system, y, t, end, dt, error_);
  }

  template <class System>
  void do_step(System system, const state_type& y, time_type t, state_type& end, time_type dt,
               state_type& error) {
    typename boost::numeric::odeint::unwrap_reference<System>::type& f = system;
    adjust_size(y);
    f(y, start_f_, t);
    do_step(system, y, start_f_, t, end, dt, error);
  }

  /// @param dydt   f(t, y)
  /// @param end    the state at t + dt; may be y itself
  /// @param error  the result's difference from the embedded one
  template <class System>
  void do_step(System system, const state_type& y, const deriv_type& dydt, time_type t, state_type& end,
               time_type dt, state_type& error) {
    typename boost::numeric::odeint::unwrap_reference<System>::type& f = system;
    adjust_size(y);
    f.linearise(y, t);
    if (!f.factor(1.0 / (K::gamma * dt))) {
      constexpr double kFailed = std::numeric_limits<double>::quiet_NaN();
      error.setConstant(y.size(), kFailed);
      end.setConstant(y.size(), kFailed);
      return;
    }
    calc_stages(f, y, dydt, t, dt, std::make_index_sequence<K::kStages>{});
    error = U_[K::kStages - 1];
    end = stage_ + error;
  }

 private:
  template <class System, std::size_t... i>
  void calc_stages(System& f, const state_type& y, const deriv_type& dydt, time_type t, time_type dt,
                   std::index_sequence<i...>) {
    (calc_stage<i>(f, y, dydt, t, dt), ...);
  }

  template <std::size_t i, class System>
  void calc_stage(System& f, const state_type& y, const deriv_type& dydt, time_type t, time_type dt) {
    if constexpr (i == 0) {
      U_[0] = dydt;
    } else {
      if constexpr (i >= K::kFirstExtended)
        stage_ += U_[i - 1];  // as the other terms of its sum are the stage before's
      else
        add_stages(K::a[i], 1.0, y.data(), stage_.data(), std::make_index_sequence<i>{});
      f(stage_, U_[i], t + K::c[i] * dt);
    }
    if constexpr (K::d[i] != 0.0) U_[i] += K::d[i] * dt * f.time_derivative();
    if constexpr (i > 0)
      add_stages(K::C[i], 1.0 / dt, U_[i].data(), U_[i].data(), std::make_index_sequence<i>{});
    f.solve_in_place(U_[i]);
  }

  /// sum = from + scale (c_1 U_1 + c_2 U_2 + ...) in one pass. @param from  may be the sum itself
  template <std::size_t... j>
  void add_stages(const K::Row& c, double scale, const double* from, double* sum,
                  std::index_sequence<j...>) const {
    const std::array<double, sizeof...(j)> factors{c[j] * scale...};
    const std::array<const double*, sizeof...(j)> stages{U_[j].data()...};
    const Eigen::Index size = stage_.size();
#pragma GCC ivdep
    for (Eigen::Index k = 0; k < size; ++k) sum[k] = (from[k] + ... + (factors[j] * stages[j][k]));
  }

  algebra_type algebra_;  ///< measures errors for Odeint
  std::array<state_type, K::kStages> U_;
  state_type stage_;            ///< argument of the stage at hand
  state_type start_f_, error_;  ///< for callers that do without
};

}  // namespace engine
