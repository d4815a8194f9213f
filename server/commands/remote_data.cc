// SPDX-License-Identifier: Apache-2.0
// Commands that fetch what a service has computed.
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "server/commands/command.h"
#include "server/commands/output_format.h"
#include "server/commands/remote_commands.h"
#include "server/commands/written_file.h"

namespace server::commands {

namespace {

std::string trimmed_blanks(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Filter of a query, {"clearance_mm_ge", "0.1"}, of a condition, "clearance_mm >= 0.1". @throws BadInput
std::pair<std::string, std::string> parse_condition(const std::string& condition) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kComparisons{
      {{"<=", "_le"}, {">=", "_ge"}, {"==", ""}, {"<", "_lt"}, {">", "_gt"}, {"=", ""}}};
  const auto at = condition.find_first_of("<>=!");
  const std::string column = trimmed_blanks(condition.substr(0, at));
  const std::string rest = at == std::string::npos ? "" : condition.substr(at);
  for (const auto& [sign, suffix] : kComparisons) {
    if (!rest.starts_with(sign)) continue;
    const std::string value = trimmed_blanks(rest.substr(sign.size()));
    if (column.empty() || value.empty() || value.find_first_of("<>=!") == 0) break;
    return {column + std::string(suffix), value};
  }
  throw BadInput("--where " + condition + ": must be a column, one of = < > <= >= and a value");
}

void add_if_given(QueryItems& query, const char* key, const std::string& value) {
  if (!value.empty()) query.emplace_back(key, value);
}

/// Writes a part of a resource in a format. @param id  checked
int write_part(const RemoteOptions& remote, std::pair<Kind, const std::string&> resource,
               std::string_view part, const OutputFile& output, TableFormat format, const QueryItems& query) {
  const std::string media_type(info_of(format).media_type);
  const auto& [kind, id] = resource;
  write_text(output.path, RemoteService(remote).get_part(kind, id, part, media_type, query));
  return kDone;
}

/// Format of the trajectories of a sweep. @throws BadInput
TableFormat check_sweep_file(const TrajectoryOptions& options, const OutputFile& output) {
  const TableFormat format = check_output(output, options.format, DataShape::kTrajectories);
  if (!options.points.empty() || !options.run.empty())
    throw BadInput("--points and --run are for a job or a measurement; a file of a sweep has every sample");
  if (output.path == "-" && isatty(STDOUT_FILENO) != 0)
    throw BadInput("a file of trajectories is no text: give its name with --output");
  return format;
}

/// Writes the trajectories of all jobs of a sweep, as they come.
int save_trajectories(const TrajectoryOptions& options, const OutputFile& output, const QueryItems& query) {
  const TableFormat format = check_sweep_file(options, output);
  RemoteService service(options.remote);
  constexpr std::chrono::minutes kFilePatience{10};  // the service makes the file before it sends any of it
  service.set_patience(kFilePatience);
  WrittenFile file(output.path);
  bool is_written = true;
  try {
    service.save_part(Kind::kSweep, options.id, "trajectories", std::string(info_of(format).media_type),
                      query, [&](std::string_view piece) { return is_written = file.append(piece); });
  } catch (const Unreachable&) {
    if (is_written) throw;  // else the file ended the transfer
  }
  file.keep();
  return kDone;
}

}  // namespace

int results(const ResultsOptions& options) {
  const Kind kind = checked_kind("results", options.id);
  const OutputFile output{"--output", options.output};
  const TableFormat format = check_output(output, options.format, DataShape::kRows);
  QueryItems query;
  add_if_given(query, "fields", options.fields);
  add_if_given(query, "order_by", options.order_by);
  add_if_given(query, "limit", options.limit);
  add_if_given(query, "metric", options.metric);
  for (const std::string& condition : options.where) query.push_back(parse_condition(condition));
  return write_part(options.remote, {kind, options.id}, "results", output, format, query);
}

int trajectory(const TrajectoryOptions& options) {
  const Kind kind = checked_kind("trajectory", options.id);
  const OutputFile output{"--output", options.output};
  QueryItems query;
  add_if_given(query, "channels", options.channels);
  add_if_given(query, "from", options.from);
  add_if_given(query, "to", options.to);
  if (kind == Kind::kSweep) return save_trajectories(options, output, query);
  const TableFormat format = check_output(output, options.format, DataShape::kColumns);
  add_if_given(query, "points", options.points);
  add_if_given(query, "run", options.run);
  const char* const part = kind == Kind::kJob ? "trajectory" : "data";
  return write_part(options.remote, {kind, options.id}, part, output, format, query);
}

int save_report(const ReportOptions& options) {
  const Kind kind = checked_kind("report", options.id);
  const OutputFile output{"--output", options.output};
  check_suffix(output, ".html");
  if (options.output != "-") check_output_file(output.option, output.path);
  QueryItems query;
  if (!options.metric.empty()) query.emplace_back("metric", options.metric);
  if (!options.x.empty()) query.emplace_back("x", options.x);
  if (options.rows) query.emplace_back("rows", "true");
  write_text(output.path,
             RemoteService(options.remote).get_part(kind, options.id, "report", "text/html", query));
  return kDone;
}

}  // namespace server::commands
