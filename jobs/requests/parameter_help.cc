// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/parameter_help.h"

#include <algorithm>

#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/parameters/link_parameters.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/parameters.h"

namespace jobs {
namespace {

std::string words_of(const ParameterInfo& info) {
  std::string text;
  for (const std::string_view word : info.choices) text.append(text.empty() ? "" : "|").append(word);
  return text;
}

std::string line_of(std::string key, const std::string& value, std::string_view unit,
                    const std::string& allowed, std::string_view help) {
  constexpr std::size_t kKeyWidth = 30;
  key.resize(std::max(key.size() + 1, kKeyWidth), ' ');
  return "  " + key + value + (unit.empty() ? "" : " " + std::string(unit)) + ", " + allowed + ": " +
         std::string(help) + "\n";
}

std::string parameter_line(const ParameterInfo& info) {
  const nlohmann::json value = default_value(info);
  const bool choice = info.kind == ParameterKind::kChoice;
  return line_of(std::string(info.key),
                 choice ? value.get<std::string>() : number_text(value.get<double>()), info.unit,
                 choice ? words_of(info) : info.range.text(), info.help);
}

std::string link_line(const std::string& path, const nlohmann::json& defaults) {
  const bool mass = path.ends_with(kMassKey);
  return line_of(path, value_at_path(defaults, path).dump(), mass ? "kg" : "kg m^2",
                 (mass ? kMassRange : kInertiaRange).text(),
                 mass ? "Mass of the link" : "Moments about the link's frame origin");
}

}  // namespace

std::string parameter_help() {
  std::string text;
  for (const ParameterInfo& info : parameter_table()) text += parameter_line(info);
  text += line_of(std::string(kLinkageKey), std::string(kRpsupName), "", "or an object",
                  "The linkage; an object describes another one");
  text += line_of(std::string(kWearKey), "none", "", "lists", kWearHelp);
  text += line_of(std::string(kKeepKey), std::string(kKeepAll), "", "all or metrics", std::string(kKeepHelp));
  for (const RpsupDrive& drive : rpsup_drives())
    text += line_of(std::string(drive.key), "none", "", "an object", drive.help);
  const nlohmann::json defaults = complete_parameters(nlohmann::json::object(), "");
  for (const std::string& path : known_paths()) {
    if (path.starts_with("links.")) text += link_line(path, defaults);
  }
  return text;
}

}  // namespace jobs
