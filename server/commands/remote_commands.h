// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/commands/remote_service.h"

namespace server::commands {

// The commands that speak to a service that runs. Each returns an exit code; they throw what RemoteService
// throws.

struct SubmitOptions {
  RemoteOptions remote;
  std::string file;            ///< request; "-": standard input
  std::string kind = "sweep";  ///< word of a Kind
  bool job = false;            ///< the request is of a job
  bool watch = false;          ///< wait for the end
};

/// Submits a request and prints the id of what came of it on a line of standard output.
int submit(const SubmitOptions& options);

struct MeasureOptions {
  RemoteOptions remote;
  std::string file;                   ///< CSV, or .npz or .json; "-": CSV of standard input
  std::string name;                   ///< of the measurement; empty: that of the file
  std::string time;                   ///< column of the time; empty: the service chooses
  std::vector<std::string> channels;  ///< COLUMN=CHANNEL; empty: every column
  std::string sensors{};              ///< JSON object by channel; empty: none has a correction
  std::string parameters{};           ///< JSON object: what is known of the run
};

/// Stores a file of measured signals and prints the id of the measurement.
int measure(const MeasureOptions& options);

/// The same without printing. @param key  Idempotency-Key; empty: none @returns the id
[[nodiscard]] std::string store_measurement(RemoteService& service, const MeasureOptions& options,
                                            const std::string& key);

struct StatusOptions {
  RemoteOptions remote;
  std::string id;              ///< empty: the newest sweeps
  bool json = false;           ///< the resource as the service gives it
  std::string kind = "sweep";  ///< of a list, the word of a Kind
  std::string state{};         ///< of a list; empty: any
  std::string limit{};         ///< of a list; empty: that of the service
  std::string ids_for{};       ///< command whose ids are listed instead; empty: none
};

/// Prints how far sweeps, jobs and studies are. kJobFailed if the one that was asked for has failed.
int status(const StatusOptions& options);

struct WatchOptions {
  RemoteOptions remote;
  std::string id;
};

/// Shows on standard error how far a sweep, a job or a study is, until it has ended: a bar and the running
/// jobs on a terminal, lines elsewhere. A service that is busy, or does not answer for a while (it is started
/// again, say), is asked again.
/// @returns kJobFailed unless every job has succeeded; kInterrupted if the user ended the watching, not the
/// sweep
int watch(const WatchOptions& options);

/// The same of a resource. @returns it as it ended; empty if the user ended the watching
std::optional<RemoteService::Json> follow(RemoteService& service, Kind kind, const std::string& id);

/// A part of a resource that has ended, as RemoteService::get_part(), asked for with the same patience.
std::string fetch_part(RemoteService& service, Kind kind, const std::string& id, std::string_view part,
                       const std::string& media_type);

struct ResultsOptions {
  RemoteOptions remote;
  std::string id;
  std::string format{};            ///< empty: that of the output's suffix
  std::string output = "-";        ///< file; "-": standard output
  std::string fields{};            ///< columns, with commas between; empty: all
  std::vector<std::string> where;  ///< conditions, "clearance_mm>0.1"
  std::string order_by{};          ///< columns, with commas between
  std::string limit{};             ///< rows; empty: all
  std::string metric{};            ///< of the statistics of replicates
};

/// Writes the table of results of a sweep or a study, as far as it has come.
int results(const ResultsOptions& options);

struct TrajectoryOptions {
  RemoteOptions remote;
  std::string id;
  std::string format{};      ///< empty: that of the output's suffix
  std::string output = "-";  ///< file; "-": standard output
  std::string channels{};    ///< with commas between; empty: all
  std::string from{}, to{};  ///< [s]
  std::string points{};      ///< most samples; empty: all
  std::string run{};         ///< of a measurement
};

/// Writes the channels of a job or a measurement over time, or those of all jobs of a sweep.
int trajectory(const TrajectoryOptions& options);

struct ReportOptions {
  RemoteOptions remote;
  std::string id;
  std::string metric{};      ///< empty: that of the service
  std::string x{};           ///< axis along the charts; empty: that of the service
  bool rows = false;         ///< list all jobs in an appendix
  std::string output = "-";  ///< file; "-": standard output
};

/// Writes the report of a sweep, an HTML page.
int save_report(const ReportOptions& options);

struct ChangeOptions {
  RemoteOptions remote;
  std::vector<std::string> ids;
  std::string executor{};  ///< of move
};

// Each changes one after the other, and prints what became of each.
int cancel(const ChangeOptions& options);
int retry(const ChangeOptions& options);
int move(const ChangeOptions& options);
int erase(const ChangeOptions& options);
/// Prints the links of pages of the dashboard.
int open(const ChangeOptions& options);

struct ExtendOptions {
  RemoteOptions remote;
  std::string id;
  std::string file;    ///< extension; "-": standard input
  bool watch = false;  ///< wait for the end
};

/// Adds values or cases to a sweep.
int extend(const ExtendOptions& options);

}  // namespace server::commands
