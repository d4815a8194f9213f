// SPDX-License-Identifier: Apache-2.0
#include "server/commands/optimise.h"

#include <unistd.h>

#include <chrono>
#include <iostream>

#include "jobs/base/errors.h"
#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/signals.h"

namespace server::commands {

namespace {

using jobs::StudyKind;
using nlohmann::json;

constexpr StudyKind kKind = StudyKind::kOptimisation;

/// Waits for the end of a study and shows the progress of its sweep. False if the user ended it first.
bool follow_study(jobs::Service& service, const json& study, const EndSignals& signals) {
  ProgressView view(std::cerr,
                    isatty(STDERR_FILENO) != 0 ? ProgressView::Form::kBar : ProgressView::Form::kLines);
  bool ended = false;
  bool interrupted = false;
  while (!ended && !interrupted) {
    ended = service.wait_for_study(kKind, study.at("id"), std::chrono::milliseconds(200));
    view.show(*service.find_sweep(study.at("sweep_id")));
    interrupted = !ended && signals.arrived();
  }
  view.finish();
  return ended;
}

void cancel_optimisation(jobs::Service& service, const std::string& id) {
  try {
    service.cancel_study(kKind, id);
  } catch (const jobs::WrongState&) {
    // It has ended since the last look: nothing is left to cancel.
  }
  service.stop();
}

std::string list_values(const json& values) {
  std::string text;
  for (const auto& [name, value] : values.items())
    text += (text.empty() ? "" : ", ") + name + " = " + value.dump();
  return text;
}

/// One line a candidate of the front, and how far it is to be trusted.
void print_front(const json& study) {
  const json& front = study.at("front");
  if (front.empty()) std::cerr << "no candidate is feasible\n";
  for (const json& candidate : front) {
    std::cerr << list_values(candidate.at("metrics")) << " at " << list_values(candidate.at("values"))
              << '\n';
  }
  if (study.at("best_repeats").is_null()) return;
  std::cerr << study.at("best_repeats") << " of " << study.at("starts").size()
            << " starts end within 1 % of the best value\n";
}

}  // namespace

int optimise(const SweepOptions& options) {
  if (options.results != "-") check_output_file("--results", options.results);
  const auto request = read_json(options.file);
  const EndSignals signals;
  jobs::Service service(service_options_of(options));
  const json begun = service.submit_study(kKind, request);
  const std::string id = begun.at("id");
  std::cerr << "optimisation " << id << " in " << options.store << '\n';
  if (!follow_study(service, begun, signals)) {
    cancel_optimisation(service, id);
    std::cerr << "rpsup: interrupted; the same command computes only what is missing\n";
    return kInterrupted;
  }
  write_text(options.results, to_text(*service.find_study_table(kKind, id), format_of_file(options.results)));
  const json ended = *service.find_study(kKind, id);
  print_front(ended);
  return ended.at("state") == "succeeded" && !ended.at("front").empty() ? kDone : kJobFailed;
}

}  // namespace server::commands
