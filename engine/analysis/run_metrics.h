// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/analysis/readings.h"
#include "engine/analysis/step_quadratic.h"
#include "engine/analysis/stepped_peak.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Quantities of a run that RunMetrics measures.
struct Measured {
  std::vector<FrameIndex> accelerations;  ///< coordinates whose acceleration is
  std::vector<FrameIndex> velocities;     ///< coordinates whose velocity is, in the steady window
  std::vector<Reading> loads;             ///< of which the largest magnitude counts
  /// Contact of a journal with its bore, or of its faces with the shoulders.
  struct Contact {
    std::size_t joint;                    ///< cut joint with clearance
    bool of_faces = false;
  };
  std::vector<Contact> contacts;  ///< of which the times count
  double steady_from = 0.0;       ///< start of the steady window, [s]
  Preparation prepare = {};
};

/// Peaks, losses and balances of one run, gathered at every step; peaks are those inside the steps.
class RunMetrics {
 public:
  explicit RunMetrics(Measured measured);

  void take_step(const Evaluation& start, const Evaluation& end);
  /// @returns whether the last step may hold a larger load than its ends show: its middle should be taken
  [[nodiscard]] bool wants_middle() const { return wants_middle_; }
  void take_middle(const Evaluation& middle);
  void take_onsets(int rings, int faces) {
    onsets_ += rings;
    face_onsets_ += faces;
  }

  /// One of Measured::accelerations.
  struct Acceleration {
    Peak steady, whole_run;
    double square_integral = 0.0;  ///< over the steady window
  };
  [[nodiscard]] const Acceleration& acceleration(std::size_t k) const { return accelerations_[k]; }
  /// One of Measured::velocities, over the steady window.
  struct Velocity {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    double way = 0.0;  ///< integral of the velocity
  };
  /// Not a number without a steady window.
  [[nodiscard]] double calc_mean_velocity(std::size_t k) const;
  /// Coefficient of fluctuation of speed: the difference of largest and least velocity by the mean one. Not a
  /// number without a steady window, or if the mean is 0.
  [[nodiscard]] double calc_speed_fluctuation(std::size_t k) const;
  /// Length of the steady window, as far as the run came; 0: it did not come there.
  [[nodiscard]] double steady_time() const { return steady_time_; }
  /// Root mean square over the steady window; not a number if there is none.
  [[nodiscard]] double calc_rms(std::size_t k) const;
  /// Measured::loads, with their values in the last step.
  [[nodiscard]] std::span<const SteppedPeak> loads() const { return loads_; }
  /// Largest magnitude of one of Measured::loads.
  [[nodiscard]] const Peak& load_peak(std::size_t k) const { return loads_[k].peak(); }
  /// Time in which one of Measured::contacts touched, [s]
  [[nodiscard]] double contact_time(std::size_t k) const { return contact_times_[k]; }
  /// Onsets of radial contact, of each ring.
  [[nodiscard]] long onsets() const { return onsets_; }
  [[nodiscard]] long face_onsets() const { return face_onsets_; }
  [[nodiscard]] const EnergyAccount& last_energy() const { return last_energy_; }
  /// Largest |E - E(0) - work of the drives + losses|, [J]
  [[nodiscard]] double largest_imbalance() const { return largest_imbalance_; }
  /// Scale of the energy residual: work of the drives and losses, counted without sign, or the largest
  /// kinetic energy or change of potential energy, whichever is larger, [J].
  [[nodiscard]] double energy_scale() const { return std::max(turned_over_, largest_in_motion_); }
  /// The one over the other; not a number if nothing moves.
  [[nodiscard]] double calc_energy_residual() const;

 private:
  void begin(const EnergyAccount& start);
  void take_acceleration(FrameIndex coordinate, const Evaluation& start, const Evaluation& end,
                         Acceleration& taken) const;
  void take_velocity(FrameIndex coordinate, const Evaluation& start, const Evaluation& end,
                     Velocity& taken) const;
  void take_loads(const Evaluation& start, const Evaluation& end);
  void take_energy(const EnergyAccount& start, const EnergyAccount& end);
  void take_contacts(const Evaluation& start, double dt);

  Measured measured_;
  std::vector<Acceleration> accelerations_;
  std::vector<Velocity> velocities_;
  std::vector<SteppedPeak> loads_;
  std::vector<double> start_loads_;
  std::vector<double> contact_times_;
  double steady_time_ = 0.0;
  bool wants_middle_ = false;
  long onsets_ = 0, face_onsets_ = 0;
  double first_balance_ = 0.0;
  double largest_imbalance_ = 0.0;
  double turned_over_ = 0.0;
  double first_potential_ = 0.0;
  double largest_in_motion_ = 0.0;  ///< kinetic energy, or change of potential energy, [J]
  EnergyAccount last_energy_;
  bool started_ = false;
};

}  // namespace engine
