// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/analysis/quantities.h"
#include "jobs/results/result_table.h"
#include "validation/engine_names.h"

namespace jobs {}

/// Comparisons of whole sweeps. Names of the jobs stand here as they do inside jobs/.
namespace validation::studies {

using namespace jobs;

/// The metric that is compared.
inline constexpr const char* kPeak = "peak_slider_acceleration_m_s2";

/// One case of the paper's study.
struct StudyCase {
  double clearance_mm = 0.0;
  double crank_velocity_rad_s = 0.0;
  std::string coupler;  ///< "rigid" or "flexible"
};
[[nodiscard]] std::string describe(const StudyCase& c);

/// Results of a sweep, looked up by case.
class StudyTable {
 public:
  explicit StudyTable(ResultTable results) : results_(std::move(results)) {}

  /// Rows of a case, replicate 0 first. @param more  another column that must have this value; empty: none
  [[nodiscard]] std::vector<std::size_t> find(const StudyCase& c, const std::string& more = "",
                                              double value = 0.0) const;
  [[nodiscard]] const ResultTable& results() const { return results_; }
  /// @throws std::out_of_range for a column or a value that is not there
  [[nodiscard]] double number(std::size_t row, const std::string& column) const;
  [[nodiscard]] std::string text(std::size_t row, const std::string& column) const;
  [[nodiscard]] std::vector<double> numbers(const std::vector<std::size_t>& rows,
                                            const std::string& column) const;

 private:
  [[nodiscard]] const nlohmann::json& cell(std::size_t row, const std::string& column) const;

  ResultTable results_;
};

inline constexpr double kClearances[] = {0.25, 0.5};              ///< [mm]
inline constexpr double kCrankVelocities[] = {5.0, 10.0, 12.0, 15.0};  ///< [rad/s]
inline constexpr const char* kCouplers[] = {"rigid", "flexible"};

/// The cases with clearance whose peak is a property of the case: those below 15 rad/s, where some impacts
/// decide between two peaks.
[[nodiscard]] std::vector<StudyCase> converging_cases();
[[nodiscard]] bool converges(const StudyCase& c);

/// Largest change of numbers on another machine (Table::reproducible_to): of cases that converge and of those
/// that are samples.
inline constexpr double kConvergedReproducibleTo = 1e-3;
inline constexpr double kSampledReproducibleTo = 100.0;

/// The sweeps of the validation: the ideal joint; the joint with clearance, each case replicated; converging
/// cases with tighter tolerances.
[[nodiscard]] std::vector<nlohmann::ordered_json> study_requests();

/// Reads channels of a job's trajectory from a time on.
using TrajectoryReader = std::function<engine::Trajectory(
    const std::string& job_id, const std::vector<std::string>& channels, double from)>;

struct Study {
  StudyTable ideal;
  StudyTable clearance;
  StudyTable tighter;
  TrajectoryReader read_trajectory;
};

/// @param results  one for each of study_requests()
[[nodiscard]] Study make_study(std::vector<ResultTable> results, TrajectoryReader read_trajectory);

}  // namespace validation::studies
