// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/remote_commands.h"
#include "server/commands/study_answer.h"
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
  if (!sweep.contains("progress")) return "-";
  return std::to_string(std::lround(std::floor(100.0 * sweep.at("progress").get<double>()))) + " %";
}

std::string time_left(const Json& sweep) {
  const Json eta = sweep.value("eta_s", Json());
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
  out << std::left << std::setw(13) << key << text << '\n';
}

/// Text at a key that not every kind of resource has.
std::string text_at_or(const Json& resource, const char* key, const std::string& otherwise) {
  return resource.contains(key) ? text_or(resource.at(key), otherwise) : otherwise;
}

std::string describe_times(const Json& resource) {
  return text_at_or(resource, "created_at", "-") + ", started " + text_at_or(resource, "started_at", "-") +
         ", ended " + text_at_or(resource, "ended_at", "-");
}

/// A sweep or a study, which has its answer at the end.
std::string describe_set(Kind kind, const Json& set) {
  std::ostringstream out;
  add_line_to(out, std::string(info_of(kind).noun), text_of(set.at("id")) + "  " + text_of(set.at("name")));
  if (set.contains("sweep_id")) add_line_to(out, "sweep", text_of(set.at("sweep_id")));
  add_line_to(out, "state", text_of(set.at("state")));
  add_line_to(out, "progress", percent(set) + ", time left " + time_left(set));
  add_line_to(out, "jobs",
              std::to_string(set.at("counts").at("total").get<long>()) + ": " +
                  describe_counts(set.at("counts")));
  if (text_at_or(set, "error", "") != "") add_line_to(out, "error", text_of(set.at("error")));
  add_line_to(out, "created", describe_times(set));
  if (set.at("state") == "succeeded")
    out << terminal_text(answer_text(kind, nlohmann::json(set)), LineEnds::kKept);
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

std::string describe_measurement(const Json& measurement) {
  std::ostringstream out;
  add_line_to(out, "measurement", text_of(measurement.at("id")) + "  " + text_of(measurement.at("name")));
  add_line_to(out, "samples", std::to_string(measurement.at("samples").get<long>()));
  for (const Json& channel : measurement.at("channels"))
    add_line_to(out, "channel", text_of(channel.at("name")) + ", " + text_or(channel.at("unit"), "-"));
  add_line_to(out, "created", text_at_or(measurement, "created_at", "-"));
  return out.str();
}

std::string describe(Kind kind, const Json& resource) {
  if (kind == Kind::kJob) return describe_job(resource);
  return kind == Kind::kMeasurement ? describe_measurement(resource) : describe_set(kind, resource);
}

/// Ids that a command takes, a line each, the newest of each kind first. Quick, for the completion of shells.
std::string list_ids(const RemoteOptions& remote, const std::string& command) {
  constexpr std::chrono::milliseconds kPatience{1000};
  RemoteService service(remote);
  service.set_patience(kPatience);
  std::string text;
  for (const Kind kind : kinds_of_command(command)) {
    const Json page = service.list(kind, {{"limit", "50"}, {"fields", "id"}});
    for (const Json& item : page.at("items")) text += text_of(item.at("id")) + "\n";
  }
  return text;
}

/// A line for each, newest first; what takes any length comes last. "-" stands for what a kind does not list.
std::string describe_list(const Json& items) {
  std::ostringstream out;
  const auto add_row = [&](const std::string& id, const std::string& state, const std::string& progress,
                           const std::string& left, const std::string& jobs, const std::string& name) {
    out << std::left << std::setw(32) << id << std::setw(11) << state << std::right << std::setw(8)
        << progress << std::setw(16) << left << std::setw(7) << jobs << "  " << name << '\n';
  };
  add_row("ID", "STATE", "PROGRESS", "TIME LEFT", "JOBS", "NAME");
  for (const Json& item : items) {
    const bool has_counts = item.contains("counts");
    add_row(text_of(item.at("id")), text_at_or(item, "state", "-"), percent(item), time_left(item),
            has_counts ? std::to_string(item.at("counts").at("total").get<long>()) : "-",
            text_at_or(item, "name", "-"));
  }
  return out.str();
}

void print_list(RemoteService& service, const StatusOptions& options) {
  QueryItems query;
  if (!options.state.empty()) query.emplace_back("state", options.state);
  if (!options.limit.empty()) query.emplace_back("limit", options.limit);
  const Json page = service.list(kind_of_word(options.kind), query);
  write_text("-", options.json ? to_text(page, 2) + "\n" : describe_list(page.at("items")));
}

}  // namespace

int status(const StatusOptions& options) {
  if (!options.ids_for.empty()) {
    write_text("-", list_ids(options.remote, options.ids_for));
    return kDone;
  }
  RemoteService service(options.remote);
  if (options.id.empty()) {
    print_list(service, options);
    return kDone;
  }
  const Kind kind = checked_kind("status", options.id);
  const Json resource = service.find(kind, options.id);
  write_text("-", options.json ? to_text(resource, 2) + "\n" : describe(kind, resource));
  return resource.value("state", "") == "failed" ? kJobFailed : kDone;
}

}  // namespace server::commands
