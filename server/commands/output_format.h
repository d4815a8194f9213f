// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/messages/formats.h"

namespace CLI {
class App;
}

namespace server::commands {

/// File that a command writes, and option that names it.
struct OutputFile {
  std::string option;  ///< "--results"
  std::string path;    ///< "-": standard output
};

/// Suffix of a file's name in lower case, without its dot.
[[nodiscard]] std::string suffix_of(const std::string& path);

/// Adds --format, whose help lists the formats of the shape. All formats pass: the environment and the
/// configuration file may give one to any command.
void add_format_option(CLI::App& command, std::string& format, DataShape shape);

/// Format of an output: that of its suffix, else that of --format, else CSV, or HDF5 of trajectories.
/// @param format  word of --format; empty: left out
/// @throws BadInput if a suffix or --format names no format for data of that shape, or if they differ
[[nodiscard]] TableFormat find_output_format(const OutputFile& file, const std::string& format,
                                             DataShape shape);

/// The same before the work, and check_output_file().
[[nodiscard]] TableFormat check_output(const OutputFile& file, const std::string& format, DataShape shape);

/// Refuses a name that has another suffix. @param suffix  ".html"
/// @throws BadInput
void check_suffix(const OutputFile& file, const std::string& suffix);

}  // namespace server::commands
