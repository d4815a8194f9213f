// SPDX-License-Identifier: Apache-2.0
#include "server/commands/config_file.h"

#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <istream>
#include <string_view>

#include "server/commands/service_token.h"

namespace server::commands {

namespace {

std::filesystem::path config_home() {
  const char* const home = std::getenv("XDG_CONFIG_HOME");
  // A path that is not absolute is to be ignored, says the specification of that variable.
  if (home != nullptr && std::filesystem::path(home).is_absolute()) return home;
  const char* const user = std::getenv("HOME");
  return user == nullptr ? std::filesystem::path() : std::filesystem::path(user) / ".config";
}

/// Some editors begin a file with the byte order mark of UTF-8, which would be part of the first name.
void skip_byte_order_mark(std::istream& input) {
  const auto start = input.tellg();
  char mark[3] = {};
  if (input.read(mark, sizeof mark) && std::string_view(mark, sizeof mark) == "\xef\xbb\xbf") return;
  input.clear();
  input.seekg(start);
}

/// "++" and "--" are the parser's marks of where a section begins and ends.
bool is_mark(const CLI::ConfigItem& item) { return item.name == "++" || item.name == "--"; }

/// Adds what stands above the sections to those of some commands.
void add_to_sections(const std::vector<CLI::ConfigItem>& shared, const std::vector<std::string>& commands,
                     std::vector<CLI::ConfigItem>& items) {
  for (const CLI::ConfigItem& item : shared) {
    for (const std::string& command : commands) {
      items.push_back(item);
      items.back().parents = {command};
    }
  }
}

}  // namespace

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
  std::vector<CLI::ConfigItem> given;
  std::vector<CLI::ConfigItem> shared;
  skip_byte_order_mark(input);
  for (CLI::ConfigItem& item : CLI::ConfigTOML::from_config(input)) {
    // The parser would take an option without a value for one that is left out.
    if (item.name == "token-file" && item.inputs.empty()) item.inputs = {""};
    const bool of_program = app_.get_option_no_throw("--" + item.name) != nullptr;
    (item.parents.empty() && !is_mark(item) && !of_program ? shared : given).push_back(std::move(item));
  }
  add_to_sections(shared, remote_, given);  // after the sections, since the first value counts
  std::erase_if(given, [&](const CLI::ConfigItem& item) { return is_in_environment(item); });
  return given;
}

bool ConfigFile::is_in_environment(const CLI::ConfigItem& item) const {
  const CLI::App* command = &app_;
  for (const std::string& name : item.parents) {
    const auto found = command->get_subcommands([&](const CLI::App* sub) { return sub->get_name() == name; });
    if (found.empty()) return false;  // the parser tells the user
    command = found.front();
  }
  const CLI::Option* const option = command->get_option_no_throw("--" + item.name);
  return option != nullptr && !option->get_envname().empty() &&
         std::getenv(option->get_envname().c_str()) != nullptr;
}

std::string describe_config_file_fault(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || S_ISDIR(status.st_mode)) return "";  // the parser tells the user
  if (S_ISCHR(status.st_mode)) return "";                                        // /dev/null
  if (!S_ISREG(status.st_mode)) return path + " is no regular file";
  std::ifstream input(path);
  skip_byte_order_mark(input);
  std::string fault;
  for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(input)) {
    if (item.name == "token") fault = describe_secret_fault(status);
    // A token of the environment goes to whatever service the file names.
    if (item.name == "url" && fault.empty()) fault = describe_owner_fault(status);
  }
  return fault.empty() ? "" : path + ": " + fault;
}

std::string find_user_config() {
  const std::filesystem::path home = config_home();
  if (home.empty()) return "";
  const auto file = home / "rpsup" / "config.ini";
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) ? file.string() : "";
}

}  // namespace server::commands
