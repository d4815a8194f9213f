// SPDX-License-Identifier: Apache-2.0
#include "server/commands/sweep.h"

#include <unistd.h>

#include <chrono>
#include <iostream>

#include "jobs/base/errors.h"
#include "jobs/service.h"
#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/signals.h"
#include "server/messages/terminal_text.h"
#include "server/routes/tables.h"

namespace server::commands {

namespace {

/// Waits for the end of a sweep and shows its progress. False if the user ended it first.
bool follow(jobs::Service& service, const std::string& id, const EndSignals& signals) {
  ProgressView view(std::cerr,
                    isatty(STDERR_FILENO) != 0 ? ProgressView::Form::kBar : ProgressView::Form::kLines);
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

int interrupt(jobs::Service& service, const std::string& id) {
  try {
    // What is left would start again with the store, beside the sweep that the same command submits next
    // time.
    service.cancel_sweep(id);
  } catch (const jobs::WrongState&) {
    // It has ended since the last look: nothing is left to cancel.
  }
  service.stop();
  std::cerr << "rpsup: interrupted; the same command computes only what is missing\n";
  return kInterrupted;
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

TableFormat format_of_file(const std::string& path) {
  if (path.ends_with(".json")) return TableFormat::kJson;
  return path.ends_with(".ndjson") ? TableFormat::kNdjson : TableFormat::kCsv;
}

int sweep(const SweepOptions& options) {
  if (options.results != "-") check_output_file("--results", options.results);
  const auto request = read_json(options.file);
  const EndSignals signals;
  jobs::Service service(service_options_of(options));
  const auto id = service.submit_sweep(request).at("id").get<std::string>();
  std::cerr << "sweep " << id << " in " << options.store << '\n';
  if (!follow(service, id, signals)) return interrupt(service, id);
  write_text(options.results, to_text(*service.find_results(id), format_of_file(options.results)));
  return service.find_sweep(id)->at("state") == "succeeded" ? kDone : kJobFailed;
}

}  // namespace server::commands
