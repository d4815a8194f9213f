// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/fits/observation.h"
#include "jobs/measurements/measurement.h"
#include "jobs/requests/request_parser.h"

namespace jobs {

/// Keys of an entry of "measurements", and of one of its channels.
inline constexpr std::array<std::string_view, 7> kFittedMeasurementKeys{
    "id", "runs", "held_back_runs", "channels", "fitted", "held_back", "time_shift_s"};
inline constexpr std::array<std::string_view, 2> kFittedChannelKeys{"weight", "noise"};

inline constexpr std::size_t kMostFittedMeasurements = 20;

/// Finds a measurement by its id; empty if there is none.
using FindMeasurement = std::function<std::optional<Measurement>(const std::string&)>;

/// Entry of "measurements": the runs of a stored measurement that a fit takes, and the windows compared.
struct FittedMeasurement {
  std::string pointer;  ///< of the entry in the request
  std::string id;
  Measurement measurement;
  std::vector<std::size_t> runs;
  std::set<std::size_t> held_back_runs;
  std::vector<TimeWindow> fitted, held_back;
  double time_shift_s = 0.0;
  std::map<std::string, nlohmann::json> channels;  ///< options by name; empty: all that the jobs have, too
};

/// Base of the fits' parser: reads "measurements".
class FittedMeasurementsParser : protected RequestParser {
 protected:
  FittedMeasurementsParser(const nlohmann::ordered_json& request, const FindMeasurement& find_measurement)
      : RequestParser(request), find_measurement_(find_measurement) {}

  void read_measurements();

  std::vector<FittedMeasurement> measurements_;

 private:
  void read_measurement(const nlohmann::json& given, const std::string& pointer);
  /// Reads the runs and windows that are compared, and the shift of the time.
  void read_selection(const nlohmann::json& given, FittedMeasurement& one);
  [[nodiscard]] std::vector<std::size_t> read_runs(const nlohmann::json& given, const std::string& pointer,
                                                   const char* key, std::size_t count, bool all);
  [[nodiscard]] std::vector<std::size_t> read_run_list(const nlohmann::json& list, const std::string& pointer,
                                                       std::size_t count);
  [[nodiscard]] std::vector<TimeWindow> read_windows(const nlohmann::json& given, const std::string& pointer,
                                                     const char* key);
  void read_channels(const nlohmann::json& given, FittedMeasurement& one);
  void read_channel(const std::string& name, const nlohmann::json& options, FittedMeasurement& one);

  const FindMeasurement& find_measurement_;
};

}  // namespace jobs
