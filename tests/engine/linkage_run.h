// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/simulate_linkage.h"

namespace engine {

[[nodiscard]] inline RunOptions accurate(double duration) {
  return {.duration = duration, .output_rate = 100.0, .integrator = Integrator::kDopri5, .relative_tolerance = 1e-10, .absolute_tolerance = 1e-10};
}

/// A run with its numbers by their names.
class LinkageRun {
 public:
  LinkageRun(const Linkage& linkage, const RunOptions& options) : tables_(linkage_tables(linkage)), result_(simulate_linkage(linkage, options, 0.0, {})) {
    EXPECT_EQ(result_.status, RunStatus::kSucceeded) << result_.detail;
  }

  [[nodiscard]] const std::vector<double>& column(const std::string& key) const {
    const auto& channels = result_.trajectory.channels;
    for (std::size_t k = 0; k < channels.size(); ++k)
      if (channels[k].key == key) return result_.trajectory.columns[k];
    throw std::out_of_range("no channel " + key);
  }
  [[nodiscard]] double last(const std::string& key) const { return column(key).back(); }
  [[nodiscard]] double metric(const std::string& key) const {
    for (std::size_t k = 0; k < tables_.metrics.size(); ++k)
      if (tables_.metrics[k].key == key) return result_.metrics.at(k);
    throw std::out_of_range("no metric " + key);
  }

 private:
  LinkageTables tables_;
  RunResult result_;
};

}  // namespace engine
