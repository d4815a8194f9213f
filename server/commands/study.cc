// SPDX-License-Identifier: Apache-2.0
#include "server/commands/study.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/base/content_id.h"
#include "jobs/base/errors.h"
#include "jobs/measurements/read_measurement_csv.h"
#include "jobs/measurements/read_measurement_json.h"
#include "jobs/measurements/read_measurement_npz.h"
#include "server/commands/command.h"
#include "server/commands/output_format.h"
#include "server/commands/progress.h"
#include "server/commands/remote_commands.h"
#include "server/commands/signals.h"
#include "server/commands/study_answer.h"
#include "server/messages/terminal_text.h"
#include "server/routes/tables.h"

namespace server::commands {

namespace {

using jobs::StudyKind;
using nlohmann::json;
using nlohmann::ordered_json;

StudyKind study_kind_of(Kind kind) {
  switch (kind) {
    case Kind::kSearch:
      return StudyKind::kSearch;
    case Kind::kWearStudy: return StudyKind::kWear;
    case Kind::kOptimisation: return StudyKind::kOptimisation;
    default: return StudyKind::kFit;
  }
}

/// Waits for the end of a study and shows the progress of its sweep. False if the user ended it first.
bool follow_study(jobs::Service& service, StudyKind kind, const json& study, const EndSignals& signals) {
  ProgressView view = ProgressView::on_standard_error();
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
  write_text(options.results, to_text(*service.find_study_table(kind, id), check_results(options)));
  return service.find_study(kind, id);
}

constexpr std::array<const char*, 3> kFileKeys{"columns", "sensors", "parameters"};

/// The columns of a measured file that an entry chooses; none: all. @throws BadInput
std::vector<std::string> columns_of(const ordered_json& entry) {
  const ordered_json columns = entry.value("columns", ordered_json::array());
  if (!columns.is_array() ||
      !std::ranges::all_of(columns, [](const ordered_json& column) { return column.is_string(); }))
    throw BadInput("columns of a file in measurements must be a list of texts, \"COLUMN:CHANNEL\"");
  return columns.get<std::vector<std::string>>();
}

jobs::Measurement read_measurement_file(const std::string& path, const ordered_json& entry) {
  jobs::ColumnQuery query{.name = std::filesystem::path(path).filename().string(),
                          .channels = columns_of(entry)};
  query.sensors = entry.value("sensors", ordered_json::object());
  query.parameters = entry.value("parameters", ordered_json::object());
  if (suffix_of(path) == "json") {
    for (const char* const key : kFileKeys)
      if (entry.contains(key))
        throw BadInput(std::string(key) + " of " + path + " is for CSV and NPZ; JSON holds it itself");
    return jobs::read_measurement_json(read_json(path));
  }
  const std::string text = read_text(path);
  return suffix_of(path) == "npz" ? jobs::read_measurement_npz(text, query)
                                  : jobs::read_measurement_csv(text, query);
}

/// File of measured signals that an entry of a request names.
struct MeasuredFile {
  std::string path;
  std::string key;  ///< the same for the same entry and the same content
};

/// Stores the files that the request names, and puts the ids of their measurements in their places.
/// @param store  a file, whose entry it is given, too; returns the id
void store_files(const std::string& request_file, ordered_json& request,
                 const std::function<std::string(const MeasuredFile&, const ordered_json&)>& store) {
  if (!request.is_object() || !request.contains("measurements") || !request["measurements"].is_array())
    return;
  for (ordered_json& entry : request["measurements"]) {
    if (!entry.is_object() || !entry.contains("file") || !entry["file"].is_string()) continue;
    const auto path = std::filesystem::path(request_file).parent_path() / entry["file"].get<std::string>();
    const std::string key = jobs::sha256_hex(entry.dump() + read_text(path.string()));
    const std::string id = store({path.string(), key}, entry);
    entry.erase("file");
    for (const char* const key_of_file : kFileKeys) entry.erase(key_of_file);
    entry["id"] = id;
  }
}

/// Id of a stored file; one that was stored before has its id, unless it has been deleted since.
std::string store_here(jobs::Service& service, const MeasuredFile& file, const ordered_json& entry) {
  json stored = service.submit_measurement(read_measurement_file(file.path, entry), file.key);
  if (!service.find_measurement(stored.at("id")))
    stored = service.submit_measurement(read_measurement_file(file.path, entry), "");
  return stored.at("id");
}

/// Options with which rpsup measure stores such a file.
MeasureOptions make_measure_options(const RemoteOptions& remote, const std::string& path,
                                    const ordered_json& entry) {
  MeasureOptions options{.remote = remote, .file = path, .name = {}, .time = {}, .channels = {}};
  for (std::string& column : columns_of(entry)) {
    if (const auto colon = column.rfind(':'); colon != std::string::npos) column[colon] = '=';
    options.channels.push_back(std::move(column));
  }
  if (entry.contains("sensors")) options.sensors = entry.at("sensors").dump();
  if (entry.contains("parameters")) options.parameters = entry.at("parameters").dump();
  return options;
}

/// The same in a running service.
std::string store_there(RemoteService& service, const RemoteOptions& remote, const MeasuredFile& file,
                        const ordered_json& entry) {
  const MeasureOptions options = make_measure_options(remote, file.path, entry);
  const auto id = store_measurement(service, options, file.key);
  try {
    static_cast<void>(service.find(Kind::kMeasurement, id));
    return id;
  } catch (const BadInput&) {
    return store_measurement(service, options, "");
  }
}

std::optional<json> compute_in_store(Kind kind, ordered_json request, const SweepOptions& options) {
  if (kind == Kind::kSweep) return sweep_in_store(request, options);
  jobs::Service service(service_options_of(options));
  store_files(options.file, request, [&](const MeasuredFile& file, const ordered_json& entry) {
    return store_here(service, file, entry);
  });
  return run_study(service, study_kind_of(kind), request, options);
}

/// Submits a request with its files. @returns the id
std::string submit_to(RemoteService& service, Kind kind, ordered_json& request, const SweepOptions& options) {
  try {
    store_files(options.file, request, [&](const MeasuredFile& file, const ordered_json& entry) {
      return store_there(service, options.remote, file, entry);
    });
    return service.submit(kind, request).at("id");
  } catch (const Unreachable& error) {
    throw Unreachable(std::string(error.what()) + " With --db FILE the command needs no service");
  }
}

std::optional<json> compute_by_service(Kind kind, ordered_json request, const SweepOptions& options) {
  RemoteService service(options.remote);
  const std::string id = submit_to(service, kind, request, options);
  std::cerr << info_of(kind).noun << ' ' << terminal_text(id) << " at " << options.remote.url << '\n';
  const auto ended = follow(service, kind, id);
  if (!ended) return std::nullopt;
  const std::string media_type(info_of(check_results(options)).media_type);
  write_text(options.results, fetch_part(service, kind, id, "results", media_type));
  return json(*ended);
}

}  // namespace

int compute(Kind kind, const SweepOptions& options) {
  static_cast<void>(check_results(options));
  auto request = read_json(options.file);
  const auto ended = options.store.empty() ? compute_by_service(kind, std::move(request), options)
                                           : compute_in_store(kind, std::move(request), options);
  if (!ended) return kInterrupted;
  std::cerr << terminal_text(answer_text(kind, *ended), LineEnds::kKept);
  return has_answer(kind, *ended) ? kDone : kJobFailed;
}

}  // namespace server::commands
