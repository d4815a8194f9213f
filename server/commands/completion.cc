// SPDX-License-Identifier: Apache-2.0
#include "server/commands/completion.h"

#include <set>
#include <string_view>

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

/// Command of a shell that lists the ids that a command takes; quiet if the service cannot be reached.
std::string list_ids(const std::string& program, const std::string& command) {
  return program + " status --ids " + command + " 2>/dev/null";
}

bool is_value_of_option(const OptionEntry& option) {
  return !option.argument && !option.value.empty() && !option.optional_value;
}

/// "--config|--url", the options that take the next word, of all commands.
std::string options_with_values(const std::vector<CommandEntry>& commands) {
  std::set<std::string> names;
  for (const CommandEntry& command : commands)
    for (const OptionEntry& option : command.options)
      if (is_value_of_option(option)) names.insert(option.name);
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : "|") + name;
  return text;
}

/// Code by which bash offers an option's values.
std::string bash_values(const OptionEntry& option, const std::string& command) {
  if (option.value == kIdType) {
    return "mapfile -t COMPREPLY < <(compgen -W \"$(" +
           list_ids("\"${words[0]}\" \"${remote[@]}\"", command) + ")\" -- \"$current\")";
  }
  if (!option.choices.empty())
    return "mapfile -t COMPREPLY < <(compgen -W " + quoted(spaced(option.choices)) + " -- \"$current\")";
  return option.value == kFile ? "_rpsup_files" : "COMPREPLY=()";
}

std::string zsh_action(const OptionEntry& option, const std::string& command) {
  if (option.value == kIdType) return "{compadd -- ${(f)\"$(" + list_ids("rpsup", command) + ")\"}}";
  if (!option.choices.empty()) return "(" + spaced(option.choices) + ")";
  return option.value == kFile ? "_files" : " ";
}

/// '--port[Port to listen on]:INT: ', ':file:_files'
std::string zsh_specification(const OptionEntry& option, const std::string& command) {
  const std::string value =
      ":" + escaped(option.argument ? option.name : option.value, ":") + ":" + zsh_action(option, command);
  if (option.argument) return quoted((option.many ? "*" : "") + value);
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

/// Line by which fish offers an option after a command, or the known values of an argument.
/// @param here  condition that the command stands in the line
std::string fish_line(const OptionEntry& option, const std::string& command, const std::string& here) {
  const std::string begin = "complete -c rpsup" + here;
  if (!option.argument)
    return begin + " -l " + option.name.substr(2) + fish_values(option) + " -d " + quoted(option.help) + "\n";
  if (!option.choices.empty()) return begin + " -a " + quoted(spaced(option.choices)) + "\n";
  if (option.value == kIdType) return begin + " -a " + quoted("(" + list_ids("rpsup", command) + ")") + "\n";
  return option.value == kFile ? begin + " -F\n" : "";
}

}  // namespace

std::string make_bash_completion(const std::vector<CommandEntry>& commands) {
  std::string values;
  std::string words;
  std::vector<std::string> first = names_of_options(commands.front());
  for (const CommandEntry& command : commands) {
    const bool program = &command == &commands.front();
    if (!program) first.push_back(command.name);
    int argument = 0;
    for (const OptionEntry& option : command.options) {
      if (option.value.empty() || option.optional_value) continue;
      const std::string number = option.argument && !option.many ? std::to_string(argument++) : "";
      const std::string place = option.argument
                                    ? quoted(command.name + " argument " + number) + (option.many ? "*" : "")
                                                : (program ? "*" + quoted(" " + option.name)
                                                           : quoted(command.name + " " + option.name));
      if (option.argument && option.choices.empty() && option.value != kIdType) continue;
      values += "    " + place + ") " + bash_values(option, command.name) + "; return ;;\n";
    }
    if (!program)
      words += "    " + command.name + ") choices=" + quoted(spaced(names_of_options(command))) + " ;;\n";
  }
  return R"(# bash completion of rpsup: source <(rpsup completion bash)
_rpsup_files() {
  compopt -o filenames 2>/dev/null || true
  mapfile -t COMPREPLY < <(compgen -f -- "$current")
}

_rpsup() {
  local current previous command='' argument=0 choices place i words remote=()
  read -ra words <<<"${COMP_LINE:0:COMP_POINT}"  # bash itself would cut URLs at their colons
  [[ ${COMP_LINE:0:COMP_POINT} != *[[:space:]] ]] || words+=('')
  current=${words[-1]} previous=${words[-2]}
  for ((i = 1; i < ${#words[@]} - 1; ++i)); do
    case "${words[i]}" in
      --url | --token-file | --config) remote+=("${words[i]}" "${words[++i]}") ;;
      --url=* | --token-file=* | --config=*) remote+=("${words[i]}") ;;
      )" + options_with_values(commands) + R"() ((++i)) ;;
      -*) ;;
      *) if [[ $command ]]; then ((++argument)); else command=${words[i]}; fi ;;
    esac
  done
  case "$previous" in
    )" + options_with_values(commands) + R"() place="$command $previous" ;;
    *) place="$command argument $argument" ;;
  esac
  [[ $current != -* ]] || place=''
  case "$place" in
)" + values + R"(  esac
  case "$command" in
    '') choices=)" + quoted(spaced(first)) + R"( ;;
)" + words + R"(  esac
  if [[ -z $command || $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
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
  for (const OptionEntry& option : commands.front().options) general += " " + zsh_specification(option, "");
  for (auto command = commands.begin() + 1; command != commands.end(); ++command) {
    names += "        " + quoted(escaped(command->name, ":") + ":" + command->help) + "\n";
    cases += "        " + command->name + ") _arguments";
    for (const OptionEntry& option : command->options)
      cases += " \\\n          " + zsh_specification(option, command->name);
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
    for (const OptionEntry& option : command.options) text += fish_line(option, command.name, here);
  }
  return text;
}

}  // namespace server::commands
