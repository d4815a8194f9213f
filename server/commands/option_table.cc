// SPDX-License-Identifier: Apache-2.0
#include "server/commands/option_table.h"

#include <CLI/CLI.hpp>

namespace server::commands {

namespace {

/// Takes the parser's text about a value apart: "INT:INT in [1 - 256]" or "TEXT:{csv,json}".
void read_type_name(const std::string& text, OptionEntry& entry) {
  const auto colon = text.find(':');
  entry.value = text.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string rule = text.substr(colon + 1);
  if (rule.starts_with('{') && rule.ends_with('}')) {
    entry.choices = CLI::detail::split(rule.substr(1, rule.size() - 2), ',');
  } else {
    const auto range = rule.find('[');
    entry.allowed = range == std::string::npos ? rule : rule.substr(range);
  }
}

OptionEntry describe_option(const CLI::Option& option) {
  OptionEntry entry;
  entry.name = option.get_name();
  entry.argument = !entry.name.starts_with('-');
  if (option.get_items_expected_max() > 0) read_type_name(option.get_type_name(), entry);
  entry.help = option.get_description();
  entry.default_text = option.get_default_str();
  entry.environment = option.get_envname();
  entry.required = option.get_required();
  entry.optional_value = !entry.value.empty() && option.get_items_expected_min() == 0;
  entry.many = option.get_items_expected_max() >= CLI::detail::expected_max_vector_size;
  return entry;
}

CommandEntry describe_command(const CLI::App& command) {
  CommandEntry entry{.name = command.get_name(),
                     .help = command.get_description(),
                     .footer = command.get_footer(),
                     .options = {}};
  for (const CLI::Option* const option : command.get_options())
    entry.options.push_back(describe_option(*option));
  return entry;
}

}  // namespace

std::vector<CommandEntry> describe_commands(const CLI::App& app) {
  std::vector<CommandEntry> commands{describe_command(app)};
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(describe_command(*command));
  }
  return commands;
}

std::string synopsis(const std::string& program, const CommandEntry& command) {
  std::string text = program + " " + command.name + " [OPTIONS]";
  for (const OptionEntry& option : command.options) {
    if (!option.argument) continue;
    const std::string name = option.name + (option.many ? "..." : "");
    text += option.required ? " " + name : " [" + name + "]";
  }
  return text;
}

}  // namespace server::commands
