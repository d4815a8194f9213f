// SPDX-License-Identifier: Apache-2.0
#include "engine/model/signal.h"

#include <limits>

namespace engine {

namespace {

SignalPoint calc(const Constant& signal, double) { return {signal.value, 0.0}; }

SignalPoint calc(const Harmonic& signal, double t) {
  const DrivenMotion motion = calc_driven_motion(signal, t);
  return {motion.q, motion.qd};
}

SignalPoint calc(const TableCurve& signal, double at) {
  const TableCurve::Point point = signal.calc(at);
  return {point.value, point.slope};
}

}  // namespace

SignalPoint calc_signal(const Signal& signal, double at) {
  return std::visit([at](const auto& kind) { return calc(kind, at); }, signal);
}

double find_next_point(const Signal& signal, double at) {
  const auto* const table = std::get_if<TableCurve>(&signal);
  return table ? table->next_point(at) : std::numeric_limits<double>::infinity();
}

}  // namespace engine
