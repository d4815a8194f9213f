// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_commands.h"

#include "server/commands/command.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

int submit(const SubmitOptions& options) {
  const auto request = read_json(options.file);
  RemoteService service(options.remote);
  const auto resource =
      service.submit(options.job ? RemoteService::Kind::kJob : RemoteService::Kind::kSweep, request);
  const auto id = resource.at("id").get<std::string>();
  write_text("-", terminal_text(id) + "\n");
  return options.watch ? watch({.remote = options.remote, .id = id}) : kDone;
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
