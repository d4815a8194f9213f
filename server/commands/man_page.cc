// SPDX-License-Identifier: Apache-2.0
#include "server/commands/man_page.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace server::commands {

namespace {

/// Text that roff prints as it stands: its own signs are taken from it.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') result += "\\e";
    else if (c == '-') result += "\\-";
    else result += c;
  }
  const bool looks_like_request = result.starts_with('.') || result.starts_with('\'');
  return looks_like_request ? "\\&" + result : result;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// Text about an option: its help, its allowed values, its default, its variable.
std::string describe(const OptionEntry& option) {
  std::string text = escaped(option.help) + ".";
  if (option.required) text += " Required.";
  if (!option.choices.empty()) text += " One of " + escaped(joined(option.choices)) + ".";
  if (!option.allowed.empty()) text += " In " + escaped(option.allowed) + ".";
  if (!option.default_text.empty()) text += " Default: " + escaped(option.default_text) + ".";
  if (!option.environment.empty()) text += " Environment: " + bold(option.environment) + ".";
  return text;
}

std::string heading(const OptionEntry& option) {
  if (option.argument) return italic(option.name) + (option.many ? " ..." : "");
  if (option.value.empty()) return bold(option.name);
  const std::string value = italic(option.value) + (option.many ? " ..." : "");
  return bold(option.name) + (option.optional_value ? " [" + value + "]" : " " + value);
}

void append_options_to(std::string& page, const CommandEntry& command) {
  for (const OptionEntry& option : command.options)
    page += ".TP\n" + heading(option) + "\n" + describe(option) + "\n";
}

void append_lines_to(std::string& page, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) page += escaped(line) + "\n.br\n";
}

void append_command_to(std::string& page, const CommandEntry& program, CommandEntry command) {
  page += ".SS " + escaped(synopsis(program.name, command)) + "\n" + escaped(command.help) + ".\n";
  std::erase_if(command.options, [](const OptionEntry& option) { return option.name == "--help"; });
  append_options_to(page, command);
  // The parser hands the program's down to commands that have none.
  if (command.footer != program.footer) append_lines_to(page += ".PP\n", command.footer);
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

}  // namespace

std::string make_man_page(const std::vector<CommandEntry>& commands, const std::string& version) {
  const CommandEntry& program = commands.front();
  std::string page = ".TH " + upper(program.name) + " 1 \"\" \"" + escaped(program.name + " " + version) +
                     "\" \"User Commands\"\n";
  page += ".SH NAME\n" + escaped(program.name) + " \\- " + escaped(program.help) + "\n";
  page += ".SH SYNOPSIS\n" + bold(program.name) + " [OPTIONS] " + italic("command") + " ...\n";
  page += ".SH OPTIONS\nOf every command, beside its own.\n";
  append_options_to(page, program);
  page += ".SH COMMANDS\n";
  for (auto command = commands.begin() + 1; command != commands.end(); ++command)
    append_command_to(page, program, *command);
  append_lines_to(page += ".SH NOTES\n", program.footer);
  return page;
}

}  // namespace server::commands
