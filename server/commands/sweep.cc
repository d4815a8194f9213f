// SPDX-License-Identifier: Apache-2.0
#include "server/commands/sweep.h"

#include <chrono>
#include <iostream>
#include <string>

#include "jobs/base/errors.h"
#include "jobs/service.h"
#include "server/commands/command.h"
#include "server/commands/output_format.h"
#include "server/commands/progress.h"
#include "server/commands/signals.h"
#include "server/messages/terminal_text.h"
#include "server/routes/tables.h"

namespace server::commands {

namespace {

/// Waits for the end of a sweep and shows its progress. False if the user ended it first.
bool follow_sweep(jobs::Service& service, const std::string& id, const EndSignals& signals) {
  ProgressView view = ProgressView::on_standard_error();
  bool ended = false;
  bool interrupted = false;
  while (!ended && !interrupted) {
    ended = service.wait_for_sweep(id, std::chrono::milliseconds(200));
    view.show(*service.find_sweep(id));
    interrupted = !ended && signals.arrived();
  }
  view.finish();
  return ended;
}

void interrupt(jobs::Service& service, const std::string& id) {
  try {
    // Jobs that are left would start again with the store, beside the sweep that the same command submits
    // next time.
    service.cancel_sweep(id);
  } catch (const jobs::WrongState&) {
    // It has ended since the last look: nothing is left to cancel.
  }
  service.stop();
  std::cerr << "rpsup: interrupted; the same command computes only what is missing\n";
}

}  // namespace

jobs::ServiceOptions service_options_of(const SweepOptions& options) {
  jobs::ServiceOptions service_options;
  service_options.store = options.store;
  service_options.threads = options.threads;
  service_options.log = [](const std::string& message) {
    std::cerr << "rpsup: " << terminal_text(message) << '\n';
  };
  return service_options;
}

TableFormat check_results(const SweepOptions& options) {
  return check_output({"--results", options.results}, options.format, DataShape::kRows);
}

std::optional<nlohmann::json> sweep_in_store(const nlohmann::ordered_json& request,
                                             const SweepOptions& options) {
  const EndSignals signals;
  jobs::Service service(service_options_of(options));
  const auto id = service.submit_sweep(request).at("id").get<std::string>();
  std::cerr << "sweep " << id << " in " << options.store << '\n';
  if (!follow_sweep(service, id, signals)) {
    interrupt(service, id);
    return std::nullopt;
  }
  write_text(options.results, to_text(*service.find_results(id), check_results(options)));
  return service.find_sweep(id);
}

}  // namespace server::commands
