// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace jobs {
namespace {

constexpr double kLeastPart = 0.125;   // of a whole step: below, a rate that still changes is one that scatters
constexpr double kNearlyOne = 1.0 - 1e-9;

/// Calls back with the two numbers of each cell.
template <typename Visit>
void for_each_cell(const WearGrid& a, const WearGrid& b, const Visit& visit) {
  for (std::size_t r = 0; r < a.size(); ++r)
    for (std::size_t s = 0; s < a[r].size(); ++s) visit(a[r][s], b[r][s]);
}

WearGrid wear_on(const WearCycle& from, double hours) {
  WearGrid depth = from.depth_um;
  for (std::size_t r = 0; r < depth.size(); ++r)
    for (std::size_t s = 0; s < depth[r].size(); ++s) depth[r][s] += hours * from.rate_um_h[r][s];
  return depth;
}

double calc_rate_change(const WearCycle& from, const WearGrid& rate) {
  double change = 0.0;
  for_each_cell(from.rate_um_h, rate, [&](double before, double now) { change = std::max(change, std::abs(now - before)); });
  return change / largest_of(from.rate_um_h);
}

/// How long until the study ends if it wears on as it does.
double calc_hours_left(const WearRule& rule, const WearCycle& from) {
  double left = rule.hours ? *rule.hours - from.hours : std::numeric_limits<double>::infinity();
  if (rule.deepest_um) {
    for_each_cell(from.depth_um, from.rate_um_h, [&](double depth, double rate) {
      if (rate > 0.0) left = std::min(left, (*rule.deepest_um - depth) / rate);
    });
  }
  return left;
}

WearVerdict judge(const WearRule& rule, const WearCourse& course) {
  const WearCycle& last = course.cycles.back();
  if (rule.deepest_um && largest_of(last.depth_um) >= kNearlyOne * *rule.deepest_um) return WearVerdict::kClearanceReached;
  if (rule.hours && last.hours >= kNearlyOne * *rule.hours) return WearVerdict::kHoursReached;
  if (!(largest_of(last.rate_um_h) > 0.0)) return WearVerdict::kNoWear;
  return course.cycles.size() >= rule.cycles ? WearVerdict::kCycleLimit : WearVerdict::kOpen;
}

}  // namespace

double largest_of(const WearGrid& grid) {
  double largest = 0.0;
  for (const auto& ring : grid)
    for (const double value : ring) largest = std::max(largest, value);
  return largest;
}

void WearFollower::go_on(const FindWear& find) {
  course_.next.reset();
  while (course_.verdict == WearVerdict::kOpen) {
    auto evaluation = find(depth_um_);
    if (!evaluation) course_.next = depth_um_;
    if (!evaluation || evaluation->state == WearEvaluation::State::kPending) return;
    if (evaluation->state == WearEvaluation::State::kLost) {
      course_.verdict = WearVerdict::kLost;
    } else {
      take(std::move(*evaluation));
    }
  }
}

void WearFollower::take(WearEvaluation evaluation) {
  std::optional<double> change;
  if (!course_.cycles.empty()) {
    WearCycle& from = course_.cycles.back();
    change = calc_rate_change(from, evaluation.rate_um_h);
    if (*change > rule_.rate_change && part_ > kLeastPart) {
      ++course_.rejected;
      part_ *= 0.5;
      step_from(from, 0.5 * from.step_hours);
      return;
    }
    part_ = std::min(1.0, 2.0 * part_);
  }
  course_.cycles.push_back({.job = evaluation.job, .hours = hours_, .rate_change = change, .depth_um = std::move(depth_um_),
                            .rate_um_h = std::move(evaluation.rate_um_h)});
  course_.verdict = judge(rule_, course_);
  if (course_.verdict != WearVerdict::kOpen) return;
  WearCycle& from = course_.cycles.back();
  step_from(from, std::min(part_ * rule_.depth_step_um / largest_of(from.rate_um_h), calc_hours_left(rule_, from)));
}

void WearFollower::step_from(WearCycle& from, double hours) {
  from.step_hours = hours;
  hours_ = from.hours + hours;
  depth_um_ = wear_on(from, hours);
}

WearCourse follow_wear(const WearRule& rule, WearGrid depth_um, const FindWear& find) {
  WearFollower follower(rule, std::move(depth_um));
  follower.go_on(find);
  return follower.course();
}

}  // namespace jobs
