// SPDX-License-Identifier: Apache-2.0
#include "server/commands/export.h"

#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

#include "jobs/exports/write_trajectories.h"
#include "jobs/service.h"
#include "jobs/store/store.h"
#include "server/commands/command.h"
#include "server/commands/output_format.h"
#include "server/commands/signals.h"

namespace server::commands {

namespace {

jobs::TrajectoryExport read_wanted(const ExportOptions& options) {
  const TableFormat format = check_output({"FILE", options.file}, options.format, DataShape::kTrajectories);
  jobs::TrajectoryExport wanted;
  if (format == TableFormat::kMat) wanted.format = jobs::TrajectoryFileFormat::kMat;
  if (format == TableFormat::kNpz) wanted.format = jobs::TrajectoryFileFormat::kNpz;
  std::istringstream channels(options.channels);
  for (std::string channel; std::getline(channels, channel, ',');) wanted.query.channels.push_back(channel);
  wanted.query.from = options.from;
  wanted.query.to = options.to;
  return wanted;
}

int export_trajectories(const ExportOptions& options) {
  const jobs::TrajectoryExport wanted = read_wanted(options);
  const std::string part = options.file + ".part";
  const EndSignals signals;
  jobs::ServiceOptions service_options;
  service_options.store = options.store;
  service_options.start = jobs::Start::kWhenTold;
  const jobs::Service service(std::move(service_options));
  try {
    if (!service.write_trajectories(options.sweep, wanted, part, [&] { return signals.arrived(); }))
      throw BadInput("--trajectories " + options.sweep + ": there is no such sweep in " + options.store);
    std::filesystem::rename(part, options.file);
  } catch (const jobs::Stopped&) {
    std::filesystem::remove(part);
    return kInterrupted;
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
  return kDone;
}

}  // namespace

int export_store(const ExportOptions& options) {
  if (!std::filesystem::is_regular_file(options.store))
    throw BadInput("--db " + options.store + ": there is no such store");
  if (std::filesystem::exists(options.file))
    throw BadInput(options.file + " exists already; a copy replaces nothing");
  if (!options.sweep.empty()) return export_trajectories(options);
  jobs::check_can_be_copied(options.store);
  const EndSignals signals;
  return jobs::copy_store(options.store, options.file, [&] { return signals.arrived(); }) ? kDone
                                                                                          : kInterrupted;
}

}  // namespace server::commands
