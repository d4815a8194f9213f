// SPDX-License-Identifier: Apache-2.0
#include "server/commands/simulate.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <utility>

#include "jobs/requests/parameters.h"
#include "jobs/results/csv.h"
#include "jobs/results/table_json.h"
#include "jobs/run_job.h"
#include "jobs/service.h"
#include "jobs/trajectories/npz.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "server/commands/command.h"
#include "server/commands/output_format.h"
#include "server/commands/plot.h"
#include "server/commands/terminal.h"
#include "server/messages/json_text.h"

namespace server::commands {

namespace {

/// Format of the trajectory; empty if there is none. @throws BadInput
std::optional<TableFormat> check_trajectory(const SimulateOptions& options) {
  if (options.trajectory.empty()) return std::nullopt;
  if (options.trajectory == "-")
    throw BadInput("--trajectory -: standard output has the job; must be the name of a file");
  return check_output({"--trajectory", options.trajectory}, options.format, DataShape::kColumns);
}

void check_plot_file(const std::string& plot) {
  if (plot.empty() || plot == "-") return;
  check_suffix({"--plot", plot}, ".svg");
  check_output_file("--plot", plot);
}

/// Characters that the user's locale can show.
Characters terminal_characters() {
  for (const char* const name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* const value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string locale = value;
    const bool utf8 = locale.find("UTF-8") != std::string::npos || locale.find("utf8") != std::string::npos;
    return utf8 ? Characters::kBraille : Characters::kAscii;
  }
  return Characters::kAscii;
}

void plot_to_file(const std::string& file, const engine::Trajectory& trajectory) {
  write_text(file, draw_svg(calc_acceleration_band(trajectory, kSvgColumns)));
}

void plot_on_terminal(const engine::Trajectory& trajectory) {
  const TerminalSize size = terminal_size();
  std::cerr << draw_for_terminal(calc_acceleration_band(trajectory, plot_columns(size)), size,
                                 terminal_characters());
}

void check_channels(const SimulateOptions& options, const jobs::JobSpec& spec) {
  if (options.channels.empty()) return;
  if (options.trajectory.empty()) throw BadInput("--channels needs --trajectory");
  std::string known;
  std::vector<jobs::Fault> faults;
  const auto channels = jobs::channel_table(spec);
  for (const auto& channel : channels) known += (known.empty() ? "" : ", ") + channel.key;
  for (const std::string& wanted : options.channels) {
    const bool found =
        std::any_of(channels.begin(), channels.end(), [&](const auto& c) { return c.key == wanted; });
    if (!found) faults.push_back({"--channels", "there is no channel " + wanted + "; there are: " + known});
  }
  if (!faults.empty()) throw jobs::InvalidRequest(std::move(faults));
}

std::string trajectory_text(TableFormat format, const engine::Trajectory& trajectory) {
  if (format == TableFormat::kNpz) return jobs::to_npz(trajectory);
  return format == TableFormat::kCsv ? jobs::to_csv(trajectory) : jobs::to_json_columns(trajectory);
}

/// The channels that were asked for, in the order of the table, time first.
engine::Trajectory select(engine::Trajectory all, const std::vector<std::string>& wanted) {
  if (wanted.empty()) return all;
  engine::Trajectory some;
  for (std::size_t c = 0; c < all.channels.size(); ++c) {
    const std::string& key = all.channels[c].key;
    if (c == 0 || std::find(wanted.begin(), wanted.end(), key) != wanted.end()) {
      some.channels.push_back(std::move(all.channels[c]));
      some.columns.push_back(std::move(all.columns[c]));
    }
  }
  return some;
}

/// Writes what the service would give: values as they are stored, of the channels that were asked for.
void write_trajectory(const SimulateOptions& options, TableFormat format, const engine::Trajectory& all) {
  const auto trajectory = select(jobs::rounded_to_stored(all), options.channels);
  write_text(options.trajectory, trajectory_text(format, trajectory));
}

}  // namespace

int simulate(const SimulateOptions& options) {
  const auto format = check_trajectory(options);
  check_plot_file(options.plot);
  const nlohmann::json parameters = read_json(options.file);
  check_channels(options, jobs::to_job_spec(jobs::complete_parameters(parameters, "")));
  const jobs::Outcome outcome = jobs::run_job(parameters, [](double) { return false; });
  if (format) write_trajectory(options, *format, outcome.trajectory);
  const bool on_terminal = options.plot == "-";
  if (!options.plot.empty() && !on_terminal) plot_to_file(options.plot, outcome.trajectory);
  write_text("-", to_text(outcome.job, 2) + "\n");
  // Last, since the job takes more lines than a terminal has.
  if (on_terminal) plot_on_terminal(outcome.trajectory);
  return outcome.job.at("state") == "succeeded" ? kDone : kJobFailed;
}

}  // namespace server::commands
