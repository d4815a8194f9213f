// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace jobs_tests {

/// Parameters of a job with one of the example linkages.
inline nlohmann::json example(const std::string& name) {
  return nlohmann::json::parse(std::ifstream(std::string(LINKAGE_FOLDER) + "/" + name + ".json"));
}

}  // namespace jobs_tests
