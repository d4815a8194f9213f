// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace server::commands {

/// Exit status of the program, for scripts.
enum ExitCode : int {
  kDone = 0,
  kJobFailed = 1,
  kBadInput = 2,
  kMachineFailed = 3,   ///< disk, port, store in use
  kInterrupted = 130,   ///< as a shell says it of Ctrl-C
};

/// The user's input cannot be used; one sentence says why.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file could not be written.
class CannotWrite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs a command and turns what it throws into words on standard error and an exit code.
int run_guarded(const std::function<int()>& command);

/// Reads a whole file, "-" for standard input. @throws BadInput if it cannot be read
[[nodiscard]] std::string read_text(const std::string& path);

/// Reads a JSON file, "-" for standard input.
/// @throws BadInput if it cannot be read or is no JSON
[[nodiscard]] nlohmann::ordered_json read_json(const std::string& path);

/// Refuses before the work a file that could not be written after it.
/// @param option  that names the file, for the message
/// @throws BadInput if it is a folder or is to be in one that is not there, CannotWrite if it may not be
/// written
void check_output_file(const std::string& option, const std::string& path);

/// Checks that what has been written to standard output got there. @throws CannotWrite
void check_standard_output();

/// Writes a whole file, "-" for standard output: beside the file of that name, and renamed, so that a reader
/// or a full disk finds the old file or the new one. A terminal gets its control characters as text; see
/// terminal_text().
/// @throws CannotWrite if not every byte reached it
void write_text(const std::string& path, const std::string& text);

}  // namespace server::commands
