// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iomanip>
#include <sstream>

#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/remote_commands.h"
#include "server/messages/json_text.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

using Json = nlohmann::ordered_json;

/// Text of the service, which may be a user's.
std::string text_of(const Json& value) { return terminal_text(value.get<std::string>()); }

std::string text_or(const Json& value, const std::string& otherwise) {
  return value.is_string() ? text_of(value) : otherwise;
}

std::string percent(const Json& sweep) {
  return std::to_string(std::lround(std::floor(100.0 * sweep.at("progress").get<double>()))) + " %";
}

std::string time_left(const Json& sweep) {
  const Json& eta = sweep.at("eta_s");
  return eta.is_number() && sweep.at("progress").get<double>() < 1.0 ? format_duration(eta.get<double>())
                                                                     : "-";
}

/// "3 succeeded, 1 failed", without what there is none of.
std::string describe_counts(const Json& counts) {
  std::string text;
  for (const auto& [state, count] : counts.items()) {
    if (state == "total" || count == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(count.get<long>()) + " " + terminal_text(state);
  }
  return text;
}

void add_line_to(std::ostream& out, const std::string& key, const std::string& text) {
  out << std::left << std::setw(10) << key << text << '\n';
}

std::string describe_times(const Json& resource) {
  return text_or(resource.at("created_at"), "-") + ", started " + text_or(resource.at("started_at"), "-") +
         ", ended " + text_or(resource.at("ended_at"), "-");
}

std::string describe_sweep(const Json& sweep) {
  std::ostringstream out;
  add_line_to(out, "sweep", text_of(sweep.at("id")) + "  " + text_of(sweep.at("name")));
  add_line_to(out, "state", text_of(sweep.at("state")));
  add_line_to(out, "progress", percent(sweep) + ", time left " + time_left(sweep));
  add_line_to(out, "jobs",
              std::to_string(sweep.at("counts").at("total").get<long>()) + ": " +
                  describe_counts(sweep.at("counts")));
  add_line_to(out, "created", describe_times(sweep));
  return out.str();
}

std::string describe_job(const Json& job) {
  std::ostringstream out;
  add_line_to(out, "job", text_of(job.at("id")));
  add_line_to(out, "sweep", text_or(job.at("sweep_id"), "-"));
  add_line_to(out, "state", text_of(job.at("state")));
  const Json& error = job.at("error");
  if (error.is_object())
    add_line_to(out, "error", text_of(error.at("reason")) + ": " + text_or(error.at("detail"), ""));
  add_line_to(out, "created", describe_times(job));
  add_line_to(out, "attempts", std::to_string(job.at("attempts").get<long>()));
  return out.str();
}

/// A line a sweep, newest first; what takes any length comes last.
std::string describe_list(const Json& items) {
  std::ostringstream out;
  const auto add_row = [&](const std::string& id, const std::string& state, const std::string& progress,
                           const std::string& left, const std::string& jobs, const std::string& name) {
    out << std::left << std::setw(32) << id << std::setw(11) << state << std::right << std::setw(8)
        << progress << std::setw(16) << left << std::setw(7) << jobs << "  " << name << '\n';
  };
  add_row("ID", "STATE", "PROGRESS", "TIME LEFT", "JOBS", "NAME");
  for (const Json& sweep : items) {
    add_row(text_of(sweep.at("id")), text_of(sweep.at("state")), percent(sweep),
            time_left(sweep), std::to_string(sweep.at("counts").at("total").get<long>()),
            text_of(sweep.at("name")));
  }
  return out.str();
}

}  // namespace

int status(const StatusOptions& options) {
  RemoteService service(options.remote);
  if (options.id.empty()) {
    const Json page = service.list_sweeps();
    write_text("-", options.json ? to_text(page, 2) + "\n" : describe_list(page.at("items")));
    return kDone;
  }
  const auto [kind, resource] = service.find(options.id);
  const std::string text =
      kind == RemoteService::Kind::kSweep ? describe_sweep(resource) : describe_job(resource);
  write_text("-", options.json ? to_text(resource, 2) + "\n" : text);
  return resource.at("state") == "failed" ? kJobFailed : kDone;
}

}  // namespace server::commands
