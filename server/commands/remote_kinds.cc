// SPDX-License-Identifier: Apache-2.0
#include "server/commands/remote_kinds.h"

#include <algorithm>

#include "server/commands/command.h"
#include "server/messages/identifiers.h"

namespace server::commands {

std::span<const Kind> kinds_of_command(std::string_view name) {
  const auto* const found = std::ranges::find(kIdCommands, name, &IdCommand::name);
  return found == kIdCommands.end() ? std::span<const Kind>() : found->kinds;
}

Kind kind_of_word(std::string_view word) {
  return static_cast<Kind>(std::ranges::find(kKinds, word, &KindInfo::word) - kKinds.begin());
}

std::vector<std::string> words_of(std::span<const Kind> kinds) {
  std::vector<std::string> words;
  for (const Kind kind : kinds) words.emplace_back(info_of(kind).word);
  return words;
}

std::string list_kinds(std::span<const Kind> kinds) {
  std::string text;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    text.append(i == 0 ? "" : i + 1 == kinds.size() ? " or " : ", ").append(info_of(kinds[i]).noun);
  return text;
}

Kind checked_kind(std::string_view command, const std::string& id) {
  const auto kinds = kinds_of_command(command);
  const auto kind = std::ranges::find_if(
      kinds, [&](Kind each) { return is_id(id) && id.starts_with(info_of(each).id_prefix); });
  if (kind != kinds.end()) return *kind;
  throw BadInput(std::string(command) + " " + id + ": is no id of a " + list_kinds(kinds));
}

}  // namespace server::commands
