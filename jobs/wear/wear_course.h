// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace jobs {

/// A number for each sector of each ring.
using WearGrid = std::vector<std::vector<double>>;

[[nodiscard]] double largest_of(const WearGrid& grid);

/// How a bore is worn step by step, and until when. One of `hours` and `deepest_um` is given, or both: what comes first ends it.
struct WearRule {
  double depth_step_um = 1.0;    ///< what a step wears off at most, anywhere, > 0
  double rate_change = 0.5;      ///< a step after which the rate differs by more than this part of the largest rate is halved, up to three times
  std::optional<double> hours;
  std::optional<double> deepest_um;
  std::size_t cycles = 100;      ///< at most
};

/// What the job with a worn bore has shown.
struct WearEvaluation {
  enum class State { kPending, kLost, kDone };
  State state = State::kPending;
  std::size_t job = 0;   ///< which of the study's
  WearGrid rate_um_h{};  ///< kDone
};

/// A state of the bore that a step has led to.
struct WearCycle {
  std::size_t job = 0;
  double hours = 0.0;                 ///< since the bore was round
  double step_hours = 0.0;            ///< to the next cycle; 0 if there is none yet
  std::optional<double> rate_change;  ///< against the cycle before, over its largest rate
  WearGrid depth_um{};
  WearGrid rate_um_h{};
};

enum class WearVerdict {
  kOpen,              ///< there is more to compute
  kHoursReached,
  kClearanceReached,
  kNoWear,            ///< nothing slides
  kCycleLimit,
  kLost,              ///< a job without a result is in the way
};
inline constexpr std::array<std::string_view, 6> kWearVerdicts{"open", "hours_reached", "clearance_reached", "no_wear", "cycle_limit", "lost"};

struct WearCourse {
  WearVerdict verdict = WearVerdict::kOpen;
  std::vector<WearCycle> cycles;
  std::size_t rejected = 0;      ///< steps that were too long
  std::optional<WearGrid> next;  ///< the bore to compute next; empty while one is under way
};

/// The evaluation of a bore, if it has been asked for.
using FindWear = std::function<std::optional<WearEvaluation>(const WearGrid& depth_um)>;

/// Follows a bore from an initial depth on, as far as evaluations go: in each step it wears as the cycle before it does (Euler's method, of
/// order 1 in the step). The bore after a step is evaluated before the step counts.
class WearFollower {
 public:
  WearFollower(const WearRule& rule, WearGrid depth_um) : rule_(rule), depth_um_(std::move(depth_um)) {}

  /// Goes on from where the evaluations ended before, which are not asked for again.
  void go_on(const FindWear& find);
  [[nodiscard]] const WearCourse& course() const { return course_; }

 private:
  /// Takes the evaluation of the bore that was reached: as a cycle, or as a reason to step less far from the last one.
  void take(WearEvaluation evaluation);
  void step_from(WearCycle& from, double hours);

  WearRule rule_;
  WearGrid depth_um_;   ///< the bore to evaluate next
  double hours_ = 0.0;  ///< when it is like that
  double part_ = 1.0;   ///< of a whole step
  WearCourse course_;
};

/// All of a course at once.
[[nodiscard]] WearCourse follow_wear(const WearRule& rule, WearGrid depth_um, const FindWear& find);

}  // namespace jobs
