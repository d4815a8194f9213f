// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/sweep_description.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/sweep_request.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 3> kChangeKeys{"name", "notes", "tags"};

std::optional<std::string> read_text(const json& request, const std::string& key, std::size_t longest,
                                     std::vector<Fault>& faults) {
  if (!request.contains(key)) return std::nullopt;
  const json& text = request.at(key);
  if (text.is_string() && text.get_ref<const std::string&>().size() <= longest) return text;
  faults.push_back({"/" + key, "must be a string of at most " + std::to_string(longest) + " bytes"});
  return std::nullopt;
}

/// Adds a tag that is not in the list already.
void add_tag(const json& given, const std::string& pointer, std::vector<std::string>& tags,
             std::vector<Fault>& faults) {
  const auto* const tag = given.get_ptr<const std::string*>();
  if (tag == nullptr || tag->empty() || tag->size() > kLongestTag) {
    faults.push_back({pointer, "must be a string of 1 to " + std::to_string(kLongestTag) + " bytes"});
  } else if (std::ranges::find(tags, *tag) == tags.end()) {
    tags.push_back(*tag);
  }
}

/// Tags, each once, in their order.
std::optional<std::vector<std::string>> read_tags(const json& request, std::vector<Fault>& faults) {
  if (!request.contains("tags")) return std::nullopt;
  const json& given = request.at("tags");
  if (!given.is_array() || given.size() > kMostTags) {
    faults.push_back({"/tags", "must be a list of at most " + std::to_string(kMostTags) + " strings"});
    return std::nullopt;
  }
  std::vector<std::string> tags;
  for (std::size_t i = 0; i < given.size(); ++i)
    add_tag(given[i], "/tags/" + std::to_string(i), tags, faults);
  return tags;
}

}  // namespace

SweepDescription parse_sweep_description(const json& request) {
  if (!request.is_object() || request.empty())
    throw InvalidRequest(
        std::vector<Fault>{{"", "must be an object with one of \"name\", \"notes\" and \"tags\""}});
  std::vector<Fault> faults;
  for (const auto& [key, value] : request.items()) {
    if (std::ranges::find(kChangeKeys, key) == kChangeKeys.end())
      faults.push_back({pointer_token(key), describe_unknown_key(key, kChangeKeys)});
  }
  SweepDescription changes{.name = read_text(request, "name", kLongestName, faults),
                           .notes = read_text(request, "notes", kLongestNotes, faults),
                           .tags = read_tags(request, faults)};
  if (!faults.empty()) throw InvalidRequest(std::move(faults));
  return changes;
}

}  // namespace jobs
