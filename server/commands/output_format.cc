// SPDX-License-Identifier: Apache-2.0
#include "server/commands/output_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "server/commands/command.h"

namespace server::commands {

namespace {

/// "{json,csv,ndjson}", as the parser's help lists choices.
std::string list_choices(DataShape shape) {
  std::string text;
  for (const std::string_view word : format_words(shape)) text.append(text.empty() ? "{" : ",").append(word);
  return text + "}";
}

/// "json, csv or ndjson", each after the sign.
std::string list_formats(DataShape shape, std::string_view sign) {
  const auto words = format_words(shape);
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text.append(i == 0 ? "" : i + 1 == words.size() ? " or " : ", ").append(sign).append(words[i]);
  return text;
}

constexpr std::array<const char*, 3> kShapeNames{"a table", "a trajectory", "a file of trajectories"};

const char* describe(DataShape shape) { return kShapeNames[static_cast<std::size_t>(shape)]; }

/// Format of a file whose name has no suffix.
TableFormat default_format(DataShape shape) {
  return info_of(TableFormat::kCsv).holds(shape) ? TableFormat::kCsv : formats_of(shape).front().format;
}

std::optional<TableFormat> find_format_of(std::string_view word, DataShape shape) {
  const auto format = find_format(word);
  return format && info_of(*format).holds(shape) ? format : std::nullopt;
}

}  // namespace

std::string suffix_of(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  if (!suffix.empty()) suffix.erase(0, 1);
  std::ranges::transform(suffix, suffix.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

void add_format_option(CLI::App& command, std::string& format, DataShape shape) {
  std::vector<std::string> words;
  for (const FormatInfo& info : kFormats) words.emplace_back(info.word);
  command
      .add_option("--format", format,
                  "Format of " + std::string(describe(shape)) + ": " + list_formats(shape, "") +
                      "; if left out, that of the file's suffix, else " +
                      std::string(info_of(default_format(shape)).word))
      ->check(CLI::IsMember(words).description(list_choices(shape)))
      ->envname("RPSUP_FORMAT");
}

TableFormat find_output_format(const OutputFile& file, const std::string& format, DataShape shape) {
  const auto asked = find_format_of(format, shape);
  if (!format.empty() && !asked)
    throw BadInput("--format " + format + ": " + describe(shape) + " is " + list_formats(shape, ""));
  const std::string suffix = file.path == "-" ? "" : suffix_of(file.path);
  if (suffix.empty()) return asked.value_or(default_format(shape));
  const auto named = find_format_of(suffix, shape);
  if (!named) {
    throw BadInput(file.option + " " + file.path + ": the name of " + describe(shape) + " must end in " +
                   list_formats(shape, "."));
  }
  if (asked && *asked != *named)
    throw BadInput(file.option + " " + file.path + ": ends in ." + suffix + ", but --format is " + format);
  return *named;
}

TableFormat check_output(const OutputFile& file, const std::string& format, DataShape shape) {
  const TableFormat found = find_output_format(file, format, shape);
  if (file.path != "-") check_output_file(file.option, file.path);
  return found;
}

void check_suffix(const OutputFile& file, const std::string& suffix) {
  if (file.path == "-" || "." + suffix_of(file.path) == suffix) return;
  throw BadInput(file.option + " " + file.path + ": the name must end in " + suffix);
}

}  // namespace server::commands
