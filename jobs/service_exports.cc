// SPDX-License-Identifier: Apache-2.0
// Files that the service writes of its store.

#include <cstdint>
#include <string>

#include "jobs/base/program_info.h"
#include "jobs/exports/write_trajectories.h"
#include "jobs/service.h"
#include "jobs/store/store.h"

namespace jobs {

bool Service::copy_store_to(const std::filesystem::path& file) const {
  return copy_store(options_.store, file, [this] { return changes_.is_closed(); });
}

bool Service::write_trajectories(const std::string& sweep_id, const TrajectoryExport& wanted,
                                 const std::filesystem::path& file, const std::function<bool()>& stop) const {
  const auto results = store_->reader.find_results(sweep_id);
  if (!results) return false;
  const std::string program = "rpsup " + std::string(kProgramVersionText);
  const auto is_stopped = [&] { return changes_.is_closed() || (stop && stop()); };
  const std::int64_t reserve = options_.store_quota.reserve_bytes;
  if (jobs::write_trajectories(store_->reader, *results, wanted, program, file, reserve, is_stopped))
    return true;
  throw Stopped("the service is shutting down");
}

}  // namespace jobs
