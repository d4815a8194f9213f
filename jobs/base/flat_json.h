// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

namespace jobs {

/// Reads a JSON object or list whose values are neither, one value after the other: the texts of a result, of
/// which a table has thousands. It knows what nlohmann::json writes without indentation, no escapes in
/// strings, and gives what that would read; whoever meets anything else reads the text with nlohmann::json
/// instead.
class FlatJson {
 public:
  explicit FlatJson(std::string_view text) : rest_(text) {}

  /// Takes '{' or '['. False if something else stands there.
  [[nodiscard]] bool open(char bracket) { return take(bracket); }

  /// Takes the next key, with what separates it. False at the end of the object, and if there is something
  /// else.
  [[nodiscard]] bool next_key(std::string_view& key);
  /// Takes the value of a key.
  [[nodiscard]] std::optional<nlohmann::json> value();
  /// Takes the next value of a list, with what separates it. False at the end of the list, and if there is
  /// something else.
  [[nodiscard]] bool next_value(nlohmann::json& value);

  /// Takes '}' or ']'. True if that is the end of the text: then everything that was read was right.
  [[nodiscard]] bool close(char bracket) { return take(bracket) && rest_.empty(); }

 private:
  bool take(char c);
  bool take_word(std::string_view word);
  bool take_separator();
  std::optional<std::string_view> string();
  std::optional<nlohmann::json> number();

  std::string_view rest_;
  bool first_ = true;
};

}  // namespace jobs
