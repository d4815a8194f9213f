// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"

namespace jobs_tests {

/// The faults that a call throws; none if it does not throw.
template <typename Call>
std::vector<jobs::Fault> faults_of(const Call& call) {
  try {
    call();
  } catch (const jobs::InvalidRequest& invalid) {
    return invalid.faults();
  }
  return {};
}

inline std::vector<std::string> pointers_of(const std::vector<jobs::Fault>& faults) {
  std::vector<std::string> pointers;
  for (const jobs::Fault& fault : faults) pointers.push_back(fault.pointer);
  std::sort(pointers.begin(), pointers.end());
  return pointers;
}

inline nlohmann::json json_of(const std::string& text) { return nlohmann::json::parse(text); }
inline nlohmann::ordered_json request_of(const std::string& text) {
  return nlohmann::ordered_json::parse(text);
}

}  // namespace jobs_tests
