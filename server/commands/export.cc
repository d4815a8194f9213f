// SPDX-License-Identifier: Apache-2.0
#include "server/commands/export.h"

#include <filesystem>

#include "jobs/store/store.h"
#include "server/commands/command.h"
#include "server/commands/signals.h"

namespace server::commands {

int export_store(const ExportOptions& options) {
  if (!std::filesystem::is_regular_file(options.store))
    throw BadInput("--db " + options.store + ": there is no such store");
  if (std::filesystem::exists(options.file))
    throw BadInput(options.file + " exists already; a copy replaces nothing");
  jobs::check_can_be_copied(options.store);
  const EndSignals signals;
  return jobs::copy_store(options.store, options.file, [&] { return signals.arrived(); }) ? kDone
                                                                                          : kInterrupted;
}

}  // namespace server::commands
