// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "server/commands/remote_service.h"

namespace server::commands {

// The commands that speak to a service that runs. Each returns an exit code; they throw what RemoteService
// throws.

struct SubmitOptions {
  RemoteOptions remote;
  std::string file;    ///< request; "-": standard input
  bool job = false;    ///< the request is one parameter set, not a sweep
  bool watch = false;  ///< wait for the end
};

/// Submits a request and prints the id of what came of it on a line of standard output.
int submit(const SubmitOptions& options);

struct MeasureOptions {
  RemoteOptions remote;
  std::string file;                   ///< CSV, or .npz or .json; "-": CSV of standard input
  std::string name;                   ///< of the measurement; empty: that of the file
  std::string time;                   ///< column of the time; empty: the service chooses
  std::vector<std::string> channels;  ///< COLUMN=CHANNEL; empty: every column
};

/// Stores a file of measured signals and prints the id of the measurement.
int measure(const MeasureOptions& options);

struct StatusOptions {
  RemoteOptions remote;
  std::string id;     ///< of a sweep or a job; empty: the newest sweeps
  bool json = false;  ///< the resource as the service gives it
};

/// Prints how far sweeps or jobs are. kJobFailed if the sweep or job that was asked for has failed.
int status(const StatusOptions& options);

struct WatchOptions {
  RemoteOptions remote;
  std::string id;
};

/// Shows on standard error how far a sweep or a job is, until it has ended: a bar on a terminal, lines
/// elsewhere. A service that does not answer for a while (it is started again, say) is asked again.
/// @returns kJobFailed unless every job has succeeded; kInterrupted if the user ended the watching, not the
/// sweep
int watch(const WatchOptions& options);

struct ResultsOptions {
  RemoteOptions remote;
  std::string sweep;
  std::string format = "csv";  ///< "csv", "json" or "ndjson"
  std::string output = "-";    ///< file; "-": standard output
};

/// Writes the table of results of a sweep, as far as it has come.
int results(const ResultsOptions& options);

struct CancelOptions {
  RemoteOptions remote;
  std::vector<std::string> ids;  ///< of sweeps or jobs
};

/// Cancels what has not ended, one after the other, and prints what became of each.
int cancel(const CancelOptions& options);

}  // namespace server::commands
