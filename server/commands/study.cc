// SPDX-License-Identifier: Apache-2.0
#include "server/commands/study.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string>

#include "jobs/base/content_id.h"
#include "jobs/base/errors.h"
#include "jobs/measurements/read_measurement_csv.h"
#include "jobs/measurements/read_measurement_json.h"
#include "jobs/measurements/read_measurement_npz.h"
#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/signals.h"

namespace server::commands {

namespace {

using jobs::StudyKind;
using nlohmann::json;
using nlohmann::ordered_json;

/// Waits for the end of a study and shows the progress of its sweep. False if the user ended it first.
bool follow_study(jobs::Service& service, StudyKind kind, const json& study, const EndSignals& signals) {
  ProgressView view(std::cerr,
                    isatty(STDERR_FILENO) != 0 ? ProgressView::Form::kBar : ProgressView::Form::kLines);
  bool ended = false;
  bool interrupted = false;
  while (!ended && !interrupted) {
    ended = service.wait_for_study(kind, study.at("id"), std::chrono::milliseconds(200));
    view.show(*service.find_sweep(study.at("sweep_id")));
    interrupted = !ended && signals.arrived();
  }
  view.finish();
  return ended;
}

void end_study(jobs::Service& service, StudyKind kind, const std::string& id) {
  try {
    service.cancel_study(kind, id);
  } catch (const jobs::WrongState&) {
    // It has ended since the last look: nothing is left to cancel.
  }
  service.stop();
}

/// Runs a study to its end and writes its table. @returns its resource; empty: the user ended it first
std::optional<json> run_study(jobs::Service& service, StudyKind kind, const ordered_json& request,
                              const SweepOptions& options) {
  const EndSignals signals;
  const json begun = service.submit_study(kind, request);
  const std::string id = begun.at("id");
  std::cerr << kind_info(kind).name << ' ' << id << " in " << options.store << '\n';
  if (!follow_study(service, kind, begun, signals)) {
    end_study(service, kind, id);
    std::cerr << "rpsup: interrupted; the same command computes only what is missing\n";
    return std::nullopt;
  }
  write_text(options.results, to_text(*service.find_study_table(kind, id), format_of_file(options.results)));
  return service.find_study(kind, id);
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

std::string short_number(const json& value, const char* otherwise) {
  if (!value.is_number()) return otherwise;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value.get<double>());
  return text;
}

/// One line a parameter: value, and how sure it is.
void print_values(const json& study) {
  for (const json& parameter : study.at("parameters")) {
    const bool has_range = !parameter.at("range").is_null();
    const bool has_profile = !parameter.at("profile").is_null();
    const json& interval = parameter.at(has_range ? "range" : has_profile ? "profile" : "linearised");
    std::cerr << parameter.at("path").get<std::string>() << " = " << short_number(parameter.at("value"), "?");
    if (!interval.is_null()) {
      std::cerr << (has_range ? ", range " : ", 95 % interval ") << short_number(interval.at("low"), "none")
                << " to " << short_number(interval.at("high"), "none");
    }
    std::cerr << '\n';
  }
  for (const json& signal : study.at("signals")) {
    for (const char* const use : {"fitted", "held_back"}) {
      const json& error = signal.at(use);
      if (error.is_null()) continue;
      std::cerr << signal.at("channel").get<std::string>() << " of run " << signal.at("run") << ", "
                << (use == std::string("fitted") ? "fitted" : "held back") << ": RMS "
                << short_number(error.at("rms"), "?") << ", peak "
                << short_number(error.at("predicted_peak"), "?") << " (measured "
                << short_number(error.at("measured_peak"), "?") << ")\n";
    }
  }
  for (const json& remark : study.at("remarks")) std::cerr << remark.get<std::string>() << '\n';
}

jobs::Measurement read_measurement_file(const std::string& path, const ordered_json& entry) {
  jobs::ColumnQuery query{.name = std::filesystem::path(path).filename().string()};
  if (entry.contains("columns")) query.channels = entry.at("columns").get<std::vector<std::string>>();
  if (path.ends_with(".json")) return jobs::read_measurement_json(read_json(path));
  const std::string text = read_text(path);
  return path.ends_with(".npz") ? jobs::read_measurement_npz(text, query)
                                : jobs::read_measurement_csv(text, query);
}

/// Stores the files that the request names, and puts the ids of their measurements in their places. A file
/// that was stored before has its id.
void store_files(jobs::Service& service, const SweepOptions& options, ordered_json& request) {
  if (!request.is_object() || !request.contains("measurements") || !request["measurements"].is_array())
    return;
  for (ordered_json& entry : request["measurements"]) {
    if (!entry.is_object() || !entry.contains("file") || !entry["file"].is_string()) continue;
    const auto path = std::filesystem::path(options.file).parent_path() / entry["file"].get<std::string>();
    const std::string key = jobs::sha256_hex(entry.dump() + read_text(path.string()));
    json stored = service.submit_measurement(read_measurement_file(path.string(), entry), key);
    if (!service.find_measurement(stored.at("id")))  // it has been deleted since
      stored = service.submit_measurement(read_measurement_file(path.string(), entry), "");
    entry.erase("file");
    entry.erase("columns");
    entry["id"] = stored.at("id");
  }
}

}  // namespace

int optimise(const SweepOptions& options) {
  if (options.results != "-") check_output_file("--results", options.results);
  const auto request = read_json(options.file);
  jobs::Service service(service_options_of(options));
  const auto ended = run_study(service, StudyKind::kOptimisation, request, options);
  if (!ended) return kInterrupted;
  print_front(*ended);
  return ended->at("state") == "succeeded" && !ended->at("front").empty() ? kDone : kJobFailed;
}

int fit(const SweepOptions& options) {
  if (options.results != "-") check_output_file("--results", options.results);
  auto request = read_json(options.file);
  jobs::Service service(service_options_of(options));
  store_files(service, options, request);
  const auto ended = run_study(service, StudyKind::kFit, request, options);
  if (!ended) return kInterrupted;
  print_values(*ended);
  return ended->at("state") == "succeeded" ? kDone : kJobFailed;
}

}  // namespace server::commands
