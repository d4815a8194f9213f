#pragma once

#include <optional>
#include <vector>

#include "engine/analysis/step_quadratic.h"
#include "engine/analysis/stepped_peak.h"
#include "engine/dynamics/evaluation.h"
#include "engine/integrate/run_end.h"
#include "engine/model/rpsup.h"

namespace engine {

/// Peaks, losses and balances of one run, gathered at every step; peaks are those inside the steps. The order of calc() is that of metric_table().
class RpsupMetrics {
 public:
  RpsupMetrics(const RpsupParameters& parameters, const RpsupLayout& layout) : parameters_(parameters), layout_(layout) {}

  void take_step(const Evaluation& start, const Evaluation& end);
  /// Whether the last step may hold a larger load than its ends show: its middle should be taken.
  [[nodiscard]] bool wants_middle() const { return wants_middle_; }
  void take_middle(const Evaluation& middle);
  void take_onsets(int count) { onsets_ += count; }

  /// Work of the drives and losses, counted without sign: what an energy residual is measured against, [J].
  [[nodiscard]] double work_turned_over() const { return turned_over_; }

  /// @param end    of the run whose steps were taken
  /// @param ideal  the ideal linkage's peak in the steady window, if there is one
  /// @param sliding_work  of the whole run, [J]
  [[nodiscard]] std::vector<double> calc(const RunEnd& end, const std::optional<Peak>& ideal, double sliding_work) const;

 private:
  void take_acceleration(const Evaluation& start, const Evaluation& end);
  void take_loads(const Evaluation& start, const Evaluation& end);
  void take_energy(const EnergyAccount& start, const EnergyAccount& end);

  const RpsupParameters& parameters_;
  RpsupLayout layout_;
  Peak steady_, whole_run_;
  double square_integral_ = 0.0;   ///< of the acceleration in the steady window
  double steady_time_ = 0.0;
  SteppedPeak contact_force_, penetration_, torque_, rod_force_, reaction_;
  bool wants_middle_ = false;
  long onsets_ = 0;
  double contact_time_ = 0.0;
  double first_balance_ = 0.0;
  double largest_imbalance_ = 0.0;
  double turned_over_ = 0.0;
  EnergyAccount last_energy_;
  bool started_ = false;
};

}  // namespace engine
