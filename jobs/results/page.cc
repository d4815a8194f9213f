// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/page.h"

#include <algorithm>
#include <utility>

#include "jobs/base/ids.h"
#include "jobs/results/name_list.h"

namespace jobs {
namespace {

std::string describe_states(std::span<const std::string_view> states) {
  std::string names;
  for (const std::string_view state : states) names += (names.empty() ? "" : ", ") + std::string(state);
  return "must be one of " + names;
}

}  // namespace

PageChecker::PageChecker(const PageQuery& query, std::string_view id_prefix,
                         std::span<const std::string> keys, std::span<const std::string_view> states) {
  std::vector<Fault> faults;
  if (query.limit < 1 || query.limit > PageQuery::kLargestLimit)
    faults.push_back(
        {"/limit", "must be an integer in [1, " + std::to_string(PageQuery::kLargestLimit) + "]"});
  if (!query.cursor.empty() && !is_id(query.cursor, id_prefix))
    faults.push_back({"/cursor", "must be the next_cursor of another page"});
  if (!query.state.empty() && std::ranges::find(states, query.state) == states.end())
    faults.push_back({"/state", describe_states(states)});
  if (!query.fields.empty()) {
    for (const std::size_t index : find_names(split_names(query.fields, keys), keys, {}, "/fields", faults))
      wanted_.push_back(keys[index]);
  }
  if (!faults.empty()) throw InvalidRequest(std::move(faults));
}

void PageChecker::take_fields(nlohmann::json& item) const {
  if (wanted_.empty()) return;
  nlohmann::json taken = nlohmann::json::object();
  for (const std::string& key : wanted_) {
    const auto found = item.find(key);
    taken[key] = found == item.end() ? nlohmann::json() : std::move(*found);
  }
  item = std::move(taken);
}

}  // namespace jobs
