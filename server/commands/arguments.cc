// SPDX-License-Identifier: Apache-2.0
#include "server/commands/arguments.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "jobs/parameters/nearest_name.h"
#include "server/commands/command.h"

namespace server::commands {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

bool is_option(const std::string& word) { return word.size() > 1 && word.starts_with('-'); }

/// @returns whether the word after an option is its value, in any command that has the option
bool takes_next_word(const CLI::App& app, const std::string& word) {
  const auto takes = [&](const CLI::App* command) {
    const CLI::Option* const option = command->get_option_no_throw(word);
    return option != nullptr && option->get_items_expected_min() > 0;
  };
  return word.find('=') == std::string::npos && (takes(&app) || std::ranges::any_of(commands_of(app), takes));
}

/// The parser would take any word after --plot for its value, such as the file with the parameters.
void join_plot(std::vector<std::string>& words) {
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (*word != "--plot") continue;
    const auto next = word + 1;
    const bool named = next != words.end() && (*next == "-" || next->ends_with(".svg"));
    *word = "--plot=" + (named ? *next : "-");
    if (named) words.erase(next);
  }
}

/// "did you mean status?", or how to see what there is.
std::string suggest(const std::string& name, const std::vector<std::string>& known, const std::string& help) {
  const std::vector<std::string_view> names(known.begin(), known.end());
  const auto nearest = jobs::find_nearest_name(name, names);
  return nearest ? "did you mean " + std::string(*nearest) + "?" : help + " lists all";
}

void check_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* const command : commands_of(app)) names.push_back(command->get_name());
  if (std::ranges::find(names, name) != names.end()) return;
  throw BadInput("there is no command " + name + "; " + suggest(name, names, "rpsup --help"));
}

/// Empty if the option takes the value.
std::string describe_value_fault(CLI::Option& option, const std::string& value) {
  try {
    for (int k = 0;; ++k)
      if (std::string fault = (*option.get_validator(k))(value); !fault.empty()) return fault;
  } catch (const CLI::OptionNotFound&) {
    return "";  // of a check after the last
  }
}

/// Options with their values that stand before the command, by whose they are.
struct LeadingOptions {
  std::vector<std::string> of_program;
  std::vector<std::string> of_command;

  [[nodiscard]] std::ptrdiff_t count() const {
    return static_cast<std::ptrdiff_t>(of_program.size() + of_command.size());
  }
};

LeadingOptions find_leading_options(const CLI::App& app, const std::vector<std::string>& words) {
  LeadingOptions found;
  auto word = words.begin();
  while (word != words.end() && is_option(*word)) {
    const std::string name = word->substr(0, word->find('='));
    auto& to = app.get_option_no_throw(name) != nullptr ? found.of_program : found.of_command;
    const bool has_value = takes_next_word(app, *word) && std::next(word) != words.end();
    to.push_back(*word++);
    if (has_value) to.push_back(*word++);
  }
  return found;
}

void add_option_names(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* const option : command.get_options())
    if (is_option(option->get_name())) names.push_back(option->get_name());
}

}  // namespace

std::vector<std::string> arrange_arguments(const CLI::App& app, std::vector<std::string> words) {
  join_plot(words);
  LeadingOptions leading = find_leading_options(app, words);
  const auto command = words.begin() + leading.count();
  if (command == words.end()) return words;  // the parser tells that a command is missing
  check_command(app, *command);
  const auto end = std::find(command, words.end(), "--");
  std::vector<std::string> arranged = std::move(leading.of_program);
  arranged.insert(arranged.end(), command, end);
  arranged.insert(arranged.end(), leading.of_command.begin(), leading.of_command.end());
  arranged.insert(arranged.end(), end, words.end());
  return arranged;
}

std::string describe_unknown_option(const CLI::App& app, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string> known;
  std::string place = app.get_name();
  std::string help = place;
  add_option_names(app, known);
  for (const CLI::App* const command : app.get_subcommands()) {
    add_option_names(*command, known);
    place = command->get_name();
    help += " " + place;
  }
  return "there is no option " + name + " of " + place + "; " +
         suggest(name, known, help + " --help");
}

void check_environment(CLI::App& app) {
  for (CLI::Option* const option : app.get_options()) {
    const std::string variable = option->get_envname();
    const char* const value = variable.empty() ? nullptr : std::getenv(variable.c_str());
    if (value == nullptr || *value == '\0' || option->count() > 0) continue;
    if (const std::string fault = describe_value_fault(*option, value); !fault.empty())
      throw BadInput(option->get_name() + " (" + variable + "): " + fault);
  }
  for (CLI::App* const command : app.get_subcommands()) check_environment(*command);
}

bool is_given(const std::vector<std::string>& words, const std::string& option) {
  return std::ranges::any_of(
      words, [&](const std::string& word) { return word == option || word.starts_with(option + "="); });
}

}  // namespace server::commands
