// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_commands.h"

#include <filesystem>
#include <functional>
#include <string_view>

#include "server/commands/command.h"
#include "server/commands/output_format.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

std::string media_type_of(const std::string& file) {
  const std::string suffix = suffix_of(file);
  if (suffix == "json") return kJsonType;
  return suffix == "npz" ? "application/x-npz" : "text/csv";
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

/// Refuses the options of CSV and NPZ beside JSON, which says the same itself. @throws BadInput
void refuse_column_options(const MeasureOptions& options) {
  if (options.name.empty() && options.time.empty() && options.channels.empty() && options.sensors.empty() &&
      options.parameters.empty())
    return;
  throw BadInput(
      "--name, --time, --channel, --sensors and --parameters are for CSV and NPZ; JSON holds them itself");
}

/// "a:channel_1,b:channel_2". @throws BadInput
std::string join_channels(const std::vector<std::string>& options) {
  std::string channels;
  for (const std::string& option : options)
    channels += (channels.empty() ? "" : ",") + column_and_channel(option);
  return channels;
}

/// Query of a measurement. @throws BadInput
QueryItems measurement_query(const MeasureOptions& options, const std::string& media_type) {
  if (media_type == kJsonType) {
    refuse_column_options(options);
    return {};
  }
  QueryItems query;
  const std::string file = options.file == "-" ? "" : std::filesystem::path(options.file).filename().string();
  query.emplace_back("name", options.name.empty() ? file : options.name);
  if (!options.time.empty()) query.emplace_back("time", options.time);
  const std::string channels = join_channels(options.channels);
  if (!channels.empty()) query.emplace_back("channels", channels);
  if (!options.sensors.empty()) query.emplace_back("sensors", options.sensors);
  if (!options.parameters.empty()) query.emplace_back("parameters", options.parameters);
  return query;
}

/// Does something with each id, and prints a line for each. Ids are checked before the first one is touched.
/// @param change  of a kind and an id, returns the line
int for_each_id(std::string_view command, const ChangeOptions& options,
                const std::function<std::string(Kind, const std::string&)>& change) {
  for (const std::string& id : options.ids) static_cast<void>(checked_kind(command, id));
  for (const std::string& id : options.ids) write_text("-", change(checked_kind(command, id), id) + "\n");
  return kDone;
}

int change_each(std::string_view action, const ChangeOptions& options, const RemoteService::Json& body) {
  RemoteService service(options.remote);
  return for_each_id(action, options, [&](Kind kind, const std::string& id) {
    const auto resource = service.change(kind, id, action, body);
    return id + " " + terminal_text(resource.at("state").get<std::string>());
  });
}

}  // namespace

int submit(const SubmitOptions& options) {
  const auto request = read_json(options.file);
  const Kind kind = options.job ? Kind::kJob : kind_of_word(options.kind);
  const auto id = RemoteService(options.remote).submit(kind, request).at("id").get<std::string>();
  write_text("-", terminal_text(id) + "\n");
  return options.watch ? watch({.remote = options.remote, .id = id}) : kDone;
}

std::string store_measurement(RemoteService& service, const MeasureOptions& options, const std::string& key) {
  const std::string media_type = media_type_of(options.file);
  const auto query = measurement_query(options, media_type);
  return service.submit_measurement(read_text(options.file), media_type, query, key).at("id");
}

int measure(const MeasureOptions& options) {
  RemoteService service(options.remote);
  write_text("-", terminal_text(store_measurement(service, options, "")) + "\n");
  return kDone;
}

int cancel(const ChangeOptions& options) { return change_each("cancel", options, nullptr); }
int retry(const ChangeOptions& options) { return change_each("retry", options, nullptr); }

int move(const ChangeOptions& options) {
  return change_each("move", options, {{"executor", options.executor}});
}

int erase(const ChangeOptions& options) {
  RemoteService service(options.remote);
  return for_each_id("delete", options, [&](Kind kind, const std::string& id) {
    service.erase(kind, id);
    return id + " deleted";
  });
}

int open(const ChangeOptions& options) {
  RemoteService service(options.remote);
  return for_each_id("open", options, [&](Kind kind, const std::string& id) {
    static_cast<void>(service.find(kind, id));
    return service.page_of(kind, id);
  });
}

int extend(const ExtendOptions& options) {
  const Kind kind = checked_kind("extend", options.id);
  const auto extension = read_json(options.file);
  const auto sweep = RemoteService(options.remote).change(kind, options.id, "extend", extension);
  write_text("-", options.id + " " + terminal_text(sweep.at("state").get<std::string>()) + "\n");
  return options.watch ? watch({.remote = options.remote, .id = options.id}) : kDone;
}

}  // namespace server::commands
