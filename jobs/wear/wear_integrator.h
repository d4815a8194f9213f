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

/// Number of each sector of each ring.
using WearGrid = std::vector<std::vector<double>>;

[[nodiscard]] double largest_of(const WearGrid& grid);

/// Step control and end of a wear study. At least one of `hours` and `deepest_um` is given; the first one
/// reached ends the study.
struct WearRule {
  double depth_step_um = 1.0;    ///< largest depth worn in a step, anywhere, > 0
  double rate_change =
      0.5;  ///< largest change of the rate in a step over the largest rate; else the step is halved
  std::optional<double> hours;
  std::optional<double> deepest_um;
  std::size_t cycles = 100;      ///< at most
};

/// Result of the job with a worn bore.
struct WearEvaluation {
  enum class State { kPending, kLost, kDone };
  State state = State::kPending;
  std::size_t job = 0;   ///< index in the study
  WearGrid rate_um_h{};  ///< kDone
};

/// State of the bore after an accepted step.
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
  kLost,              ///< a job that the next step needs has no result
};
inline constexpr std::array<std::string_view, 6> kWearVerdicts{
    "open", "hours_reached", "clearance_reached", "no_wear", "cycle_limit", "lost"};

struct WearHistory {
  WearVerdict verdict = WearVerdict::kOpen;
  std::vector<WearCycle> cycles;
  std::size_t rejected = 0;      ///< steps that were too long
  std::optional<WearGrid> next;  ///< the bore to compute next; empty while one is being computed
};

/// Evaluation of a bore, if it has been asked for.
using FindWear = std::function<std::optional<WearEvaluation>(const WearGrid& depth_um)>;

/// Integrator of the depth of a bore over the hours: Euler's explicit method, of order 1, with step control
/// by the change of the rate. A step is accepted once the bore after it has been evaluated.
class WearIntegrator {
 public:
  WearIntegrator(const WearRule& rule, WearGrid depth_um) : rule_(rule), depth_um_(std::move(depth_um)) {}

  /// Takes steps as far as evaluations go. Calls `find` only for bores whose evaluation it does not have.
  void advance(const FindWear& find);
  [[nodiscard]] const WearHistory& history() const { return history_; }

 private:
  /// Accepts the step to the evaluated bore, or rejects it and halves it.
  void end_step(WearEvaluation evaluation);
  /// Goes back to the last accepted bore, and half as far from there.
  void reject_step();
  void begin_next_step();
  void begin_step(WearCycle& from, double hours);

  WearRule rule_;
  WearGrid depth_um_;   ///< the bore to evaluate next
  double hours_ = 0.0;  ///< time of depth_um_
  double part_ = 1.0;   ///< of a whole step
  WearHistory history_;
};

}  // namespace jobs
