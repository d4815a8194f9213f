// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_commands.h"

#include <filesystem>
#include <utility>

#include "server/commands/command.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

constexpr const char* kJsonType = "application/json";

std::string media_type_of(const std::string& file) {
  if (file.ends_with(".json")) return kJsonType;
  return file.ends_with(".npz") ? "application/x-npz" : "text/csv";
}

/// "acc:slider_acceleration_m_s2" of "acc=slider_acceleration_m_s2". @throws BadInput
std::string column_and_channel(const std::string& option) {
  const auto equals = option.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == option.size())
    throw BadInput("--channel " + option + ": must be COLUMN=CHANNEL");
  if (option.find(',') != std::string::npos)
    throw BadInput("--channel " + option + ": a column that is chosen may have no comma in its name");
  return option.substr(0, equals) + ":" + option.substr(equals + 1);
}

/// Query of a measurement. JSON says the same itself. @throws BadInput
std::vector<std::pair<std::string, std::string>> measurement_query(const MeasureOptions& options,
                                                                   const std::string& media_type) {
  if (media_type == kJsonType) {
    if (options.name.empty() && options.time.empty() && options.channels.empty()) return {};
    throw BadInput("--name, --time and --channel are for CSV and NPZ; JSON holds them itself");
  }
  std::vector<std::pair<std::string, std::string>> query;
  const std::string file = options.file == "-" ? "" : std::filesystem::path(options.file).filename().string();
  query.emplace_back("name", options.name.empty() ? file : options.name);
  if (!options.time.empty()) query.emplace_back("time", options.time);
  std::string channels;
  for (const std::string& channel : options.channels)
    channels += (channels.empty() ? "" : ",") + column_and_channel(channel);
  if (!channels.empty()) query.emplace_back("channels", channels);
  return query;
}

}  // namespace

int submit(const SubmitOptions& options) {
  const auto request = read_json(options.file);
  RemoteService service(options.remote);
  const auto resource =
      service.submit(options.job ? RemoteService::Kind::kJob : RemoteService::Kind::kSweep, request);
  const auto id = resource.at("id").get<std::string>();
  write_text("-", terminal_text(id) + "\n");
  return options.watch ? watch({.remote = options.remote, .id = id}) : kDone;
}

int measure(const MeasureOptions& options) {
  const std::string media_type = media_type_of(options.file);
  const auto query = measurement_query(options, media_type);
  const auto resource =
      RemoteService(options.remote).submit_measurement(read_text(options.file), media_type, query);
  write_text("-", terminal_text(resource.at("id").get<std::string>()) + "\n");
  return kDone;
}

int results(const ResultsOptions& options) {
  if (options.output != "-") check_output_file("--output", options.output);
  const std::string media_type = options.format == "csv"      ? "text/csv"
                                 : options.format == "ndjson" ? "application/x-ndjson"
                                                              : "application/json";
  write_text(options.output, RemoteService(options.remote).results(options.sweep, media_type));
  return kDone;
}

int cancel(const CancelOptions& options) {
  RemoteService service(options.remote);
  for (const std::string& id : options.ids) {
    const auto resource = service.cancel(id).json;
    write_text("-", id + " " + terminal_text(resource.at("state").get<std::string>()) + "\n");
  }
  return kDone;
}

}  // namespace server::commands
