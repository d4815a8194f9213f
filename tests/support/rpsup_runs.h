#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/simulate_rpsup.h"

namespace support {

/// A metric of a finished run by its key.
inline double metric(const engine::RunResult& run, std::string_view key) {
  const auto table = engine::metric_table();
  for (std::size_t i = 0; i < table.size(); ++i)
    if (table[i].key == key) return run.metrics.at(i);
  throw std::out_of_range(std::string(key));
}

/// A channel of a run by its key.
inline const std::vector<double>& column(const engine::RunResult& run, std::string_view key) {
  for (std::size_t i = 0; i < run.trajectory.channels.size(); ++i)
    if (run.trajectory.channels[i].key == key) return run.trajectory.columns[i];
  throw std::out_of_range(std::string(key));
}

}  // namespace support
