// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "jobs/requests/expand.h"
#include "jobs/store/store.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {

inline constexpr std::size_t kMaxQueuedInStore = 1000;

inline jobs::SweepPlan stored_plan_of(const char* request) {
  return jobs::plan_sweep(request_of(request), 10'000);
}

inline std::string add_sweep(jobs::Store& store, const char* request) {
  return store.queue.add_sweep(stored_plan_of(request), request, kMaxQueuedInStore);
}

}  // namespace jobs_tests
