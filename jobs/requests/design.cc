// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/design.h"

#include <algorithm>
#include <string_view>

#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/design_kinds.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

const DesignKind* find_kind(const ordered_json& design) {
  if (!design.is_object() || !design.contains("type") || !design.at("type").is_string()) return nullptr;
  const auto kinds = design_kinds();
  const auto found = std::ranges::find(
      kinds, std::string_view(design.at("type").get_ref<const std::string&>()), &DesignKind::type);
  return found == kinds.end() ? nullptr : &*found;
}

std::string describe_kinds() {
  std::string text = "must be one of ";
  for (const DesignKind& kind : design_kinds())
    text += (text.ends_with("of ") ? "\"" : ", \"") + std::string(kind.type) + "\"";
  return text;
}

void check_keys(const ordered_json& design, const DesignKind& kind, std::vector<Fault>& faults) {
  std::vector<std::string_view> keys{"type", "over"};
  keys.insert(keys.end(), kind.keys.begin(), kind.keys.end());
  for (const auto& [key, value] : design.items()) {
    if (std::ranges::find(keys, key) == keys.end()) {
      faults.push_back({"/design" + pointer_token(key),
                        describe_unknown_key(key, keys) + " (of " + std::string(kind.type) + ")"});
    }
  }
}

/// Adds the faults of what it is over, save those of the values. Returns whether there are none.
bool check_paths(const ordered_json& design, std::vector<Fault>& faults) {
  if (!design.contains("over") || !design.at("over").is_object() || design.at("over").empty()) {
    faults.push_back({"/design/over", "must be an object of one parameter or more"});
    return false;
  }
  const std::size_t before = faults.size();
  for (const auto& [path, values] : design.at("over").items())
    (void)is_known_path(path, "/design/over" + pointer_token(path), faults);
  return faults.size() == before;
}

}  // namespace

std::uint64_t count_design_points(const ordered_json& design, const json& parameters,
                                  std::vector<Fault>& faults) {
  const DesignKind* kind = find_kind(design);
  if (kind == nullptr) {
    faults.push_back(design.is_object()
                         ? Fault{"/design/type", describe_kinds()}
                         : Fault{"/design", "must be an object of type, over and what the type needs"});
    return 0;
  }
  const std::size_t before = faults.size();
  check_keys(design, *kind, faults);
  if (!check_paths(design, faults)) return 0;
  const std::uint64_t count = kind->count(design, parameters, faults);
  return faults.size() == before ? count : 0;
}

Design make_design(const ordered_json& design, const json& parameters, std::vector<Fault>& faults) {
  Design made{.paths = {}, .points = {}};
  for (const auto& [path, values] : design.at("over").items()) made.paths.push_back(path);
  made.points = find_kind(design)->make(design, parameters, faults);
  return made;
}

}  // namespace jobs
