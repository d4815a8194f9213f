// SPDX-License-Identifier: Apache-2.0
#include "server/commands/completion.h"

namespace server::commands {

namespace {

constexpr const char* kFile = "FILE";  // the type name of options whose value is the name of a file

std::string spaced(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Between single quotes for any of the three shells.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// With a backslash before each of the signs.
std::string escaped(const std::string& text, std::string_view signs) {
  std::string result;
  for (const char c : text) {
    if (signs.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

std::vector<std::string> names_of_options(const CommandEntry& command) {
  std::vector<std::string> names;
  for (const OptionEntry& option : command.options) {
    if (!option.argument) names.push_back(option.name);
  }
  return names;
}

/// What bash is to offer as an option's value.
std::string bash_values(const OptionEntry& option) {
  if (!option.choices.empty())
    return "mapfile -t COMPREPLY < <(compgen -W " + quoted(spaced(option.choices)) + " -- \"$current\")";
  return option.value == kFile ? "_rpsup_files" : "COMPREPLY=()";
}

std::string zsh_action(const OptionEntry& option) {
  if (!option.choices.empty()) return "(" + spaced(option.choices) + ")";
  return option.value == kFile ? "_files" : " ";
}

/// '--port[Port to listen on]:INT: ', '1:file:_files'
std::string zsh_specification(const OptionEntry& option) {
  const std::string value =
      ":" + escaped(option.argument ? option.name : option.value, ":") + ":" + zsh_action(option);
  if (option.argument) return quoted((option.many ? "*" : "1") + value);
  const std::string name = option.name + "[" + escaped(option.help, "[]:\\") + "]";
  if (option.value.empty()) return quoted(name);
  return quoted(name + (option.optional_value ? ":" : "") + value);
}

std::string fish_values(const OptionEntry& option) {
  if (!option.choices.empty()) return " -x -a " + quoted(spaced(option.choices));
  if (option.value.empty()) return "";
  if (option.optional_value) return " -F";
  return option.value == kFile ? " -r -F" : " -x";
}

}  // namespace

std::string make_bash_completion(const std::vector<CommandEntry>& commands) {
  std::string values;
  std::string words;
  std::vector<std::string> first = names_of_options(commands.front());
  for (const CommandEntry& command : commands) {
    const bool program = &command == &commands.front();
    if (!program) first.push_back(command.name);
    for (const OptionEntry& option : command.options) {
      if (option.value.empty() || option.optional_value) continue;
      const std::string place = option.argument ? quoted(command.name + " argument")
                                                : (program ? "*" + quoted(" " + option.name)
                                                           : quoted(command.name + " " + option.name));
      if (option.argument && option.choices.empty()) continue;
      values += "    " + place + ") " + bash_values(option) + "; return ;;\n";
    }
    if (!program)
      words += "    " + command.name + ") words=" + quoted(spaced(names_of_options(command))) + " ;;\n";
  }
  return R"(# bash completion of rpsup: source <(rpsup completion bash)
_rpsup_files() {
  compopt -o filenames 2>/dev/null || true
  mapfile -t COMPREPLY < <(compgen -f -- "$current")
}

_rpsup() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command='' words place i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "${COMP_WORDS[i]}" in
      --config) ((++i)) ;;
      -*) ;;
      *) command=${COMP_WORDS[i]}; break ;;
    esac
  done
  place="$command $previous"
  [[ $previous == -* || $current == -* ]] || place="$command argument"
  case "$place" in
)" + values + R"(  esac
  case "$command" in
    '') words=)" + quoted(spaced(first)) + R"( ;;
)" + words + R"(  esac
  if [[ -z $command || $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  else
    _rpsup_files
  fi
}
complete -F _rpsup rpsup
)";
}

std::string make_zsh_completion(const std::vector<CommandEntry>& commands) {
  std::string names;
  std::string cases;
  std::string general;
  for (const OptionEntry& option : commands.front().options) general += " " + zsh_specification(option);
  for (auto command = commands.begin() + 1; command != commands.end(); ++command) {
    names += "        " + quoted(escaped(command->name, ":") + ":" + command->help) + "\n";
    cases += "        " + command->name + ") _arguments";
    for (const OptionEntry& option : command->options) cases += " \\\n          " + zsh_specification(option);
    cases += " ;;\n";
  }
  return R"(#compdef rpsup
# zsh completion of rpsup: as a file _rpsup in a folder of $fpath, or source <(rpsup completion zsh)
_rpsup() {
  local context state state_descr line
  typeset -A opt_args
  _arguments -C)" + general + R"( '1:command:->command' '*::argument:->argument'
  case $state in
    command)
      local -a commands
      commands=(
)" + names + R"(      )
      _describe -t commands command commands ;;
    argument)
      case $line[1] in
)" + cases + R"(      esac ;;
  esac
}
if [ "$funcstack[1]" = _rpsup ]; then _rpsup "$@"; else compdef _rpsup rpsup; fi
)";
}

std::string make_fish_completion(const std::vector<CommandEntry>& commands) {
  std::string text = "# fish completion of rpsup: rpsup completion fish | source\ncomplete -c rpsup -f\n";
  for (const CommandEntry& command : commands) {
    const bool program = &command == &commands.front();
    const std::string here = program ? "" : " -n " + quoted("__fish_seen_subcommand_from " + command.name);
    if (!program)
      text += "complete -c rpsup -n __fish_use_subcommand -a " + command.name + " -d " +
              quoted(command.help) + "\n";
    for (const OptionEntry& option : command.options) {
      if (!option.argument) {
        text += "complete -c rpsup" + here + " -l " + option.name.substr(2) + fish_values(option) + " -d " +
                quoted(option.help) + "\n";
      } else if (!option.choices.empty()) {
        text += "complete -c rpsup" + here + " -a " + quoted(spaced(option.choices)) + "\n";
      } else if (option.value == kFile) {
        text += "complete -c rpsup" + here + " -F\n";
      }
    }
  }
  return text;
}

}  // namespace server::commands
