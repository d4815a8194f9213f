// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace jobs {
namespace {

constexpr double kLeastPart = 0.125;   // of a whole step: the rate of shorter steps changes by its scatter
constexpr double kNearlyOne = 1.0 - 1e-9;

/// Calls visit() with both grids' numbers of each cell.
template <typename Visit>
void for_each_cell(const WearGrid& a, const WearGrid& b, const Visit& visit) {
  for (std::size_t r = 0; r < a.size(); ++r)
    for (std::size_t s = 0; s < a[r].size(); ++s) visit(a[r][s], b[r][s]);
}

WearGrid depth_after(const WearCycle& from, double hours) {
  WearGrid depth = from.depth_um;
  for (std::size_t r = 0; r < depth.size(); ++r)
    for (std::size_t s = 0; s < depth[r].size(); ++s) depth[r][s] += hours * from.rate_um_h[r][s];
  return depth;
}

double calc_rate_change(const WearCycle& from, const WearGrid& rate) {
  double change = 0.0;
  for_each_cell(from.rate_um_h, rate,
                [&](double before, double now) { change = std::max(change, std::abs(now - before)); });
  return change / largest_of(from.rate_um_h);
}

/// Time until the study ends at the present rate.
double calc_hours_left(const WearRule& rule, const WearCycle& from) {
  double left = rule.hours ? *rule.hours - from.hours : std::numeric_limits<double>::infinity();
  if (rule.deepest_um) {
    for_each_cell(from.depth_um, from.rate_um_h, [&](double depth, double rate) {
      if (rate > 0.0) left = std::min(left, (*rule.deepest_um - depth) / rate);
    });
  }
  return left;
}

WearVerdict judge(const WearRule& rule, const WearHistory& history) {
  const WearCycle& last = history.cycles.back();
  if (rule.deepest_um && largest_of(last.depth_um) >= kNearlyOne * *rule.deepest_um) {
    return WearVerdict::kClearanceReached;
  }
  if (rule.hours && last.hours >= kNearlyOne * *rule.hours) return WearVerdict::kHoursReached;
  if (!(largest_of(last.rate_um_h) > 0.0)) return WearVerdict::kNoWear;
  return history.cycles.size() >= rule.cycles ? WearVerdict::kCycleLimit : WearVerdict::kOpen;
}

}  // namespace

double largest_of(const WearGrid& grid) {
  double largest = 0.0;
  for (const auto& ring : grid)
    for (const double value : ring) largest = std::max(largest, value);
  return largest;
}

void WearIntegrator::advance(const FindWear& find) {
  history_.next.reset();
  while (history_.verdict == WearVerdict::kOpen) {
    auto evaluation = find(depth_um_);
    if (!evaluation) history_.next = depth_um_;
    if (!evaluation || evaluation->state == WearEvaluation::State::kPending) return;
    if (evaluation->state == WearEvaluation::State::kLost) {
      history_.verdict = WearVerdict::kLost;
    } else {
      end_step(std::move(*evaluation));
    }
  }
}

void WearIntegrator::end_step(WearEvaluation evaluation) {
  std::optional<double> change;
  if (!history_.cycles.empty()) {
    change = calc_rate_change(history_.cycles.back(), evaluation.rate_um_h);
    if (*change > rule_.rate_change && part_ > kLeastPart) return reject_step();
    part_ = std::min(1.0, 2.0 * part_);
  }
  history_.cycles.push_back({.job = evaluation.job,
                             .hours = hours_,
                             .rate_change = change,
                             .depth_um = std::move(depth_um_),
                             .rate_um_h = std::move(evaluation.rate_um_h)});
  history_.verdict = judge(rule_, history_);
  if (history_.verdict == WearVerdict::kOpen) begin_next_step();
}

void WearIntegrator::reject_step() {
  ++history_.rejected;
  part_ *= 0.5;
  WearCycle& from = history_.cycles.back();
  begin_step(from, 0.5 * from.step_hours);
}

void WearIntegrator::begin_next_step() {
  WearCycle& from = history_.cycles.back();
  begin_step(
      from, std::min(part_ * rule_.depth_step_um / largest_of(from.rate_um_h), calc_hours_left(rule_, from)));
}

void WearIntegrator::begin_step(WearCycle& from, double hours) {
  from.step_hours = hours;
  hours_ = from.hours + hours;
  depth_um_ = depth_after(from, hours);
}

}  // namespace jobs
