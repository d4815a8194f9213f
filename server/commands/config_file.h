// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace server::commands {

/// Reads the file with options: a [section] a command, a line name=value an option. The environment goes
/// before the file.
class ConfigFile : public CLI::ConfigTOML {
 public:
  /// @param app     whose options they are; outlives this
  /// @param remote  commands that speak to a running service: what stands above the first section, where the
  /// service is, is theirs
  ConfigFile(const CLI::App& app, std::vector<std::string> remote) : app_(app), remote_(std::move(remote)) {}

  [[nodiscard]] std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

 private:
  [[nodiscard]] bool is_in_environment(const CLI::ConfigItem& item) const;

  const CLI::App& app_;
  std::vector<std::string> remote_;
};

/// Fault of the configuration file, empty if there is none: a FIFO, which may never end; a token that others
/// than its owner can read; the address of a service that others can change. A missing file has no fault.
[[nodiscard]] std::string describe_config_file_fault(const std::string& path);

/// The file that is read if none is named: rpsup/config.ini in $XDG_CONFIG_HOME, which is ~/.config by
/// default. Empty if there is no such file.
[[nodiscard]] std::string find_user_config();

}  // namespace server::commands
