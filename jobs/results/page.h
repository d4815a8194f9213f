// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/states.h"
#include "jobs/results/page_query.h"

namespace jobs {

/// A query of a listing that has been checked.
class PageChecker {
 public:
  /// @param id_prefix  of what is listed
  /// @param keys       that its items may have
  /// @param states     that they may be in
  /// @throws InvalidRequest with every fault
  PageChecker(const PageQuery& query, std::string_view id_prefix, std::span<const std::string> keys,
      std::span<const std::string_view> states = kJobStates);

  /// The keys that are wanted; empty: all.
  [[nodiscard]] const std::vector<std::string>& wanted() const { return wanted_; }

  /// Leaves the keys that are wanted.
  void take_fields(nlohmann::json& item) const;

 private:
  std::vector<std::string> wanted_;  ///< empty: all
};

/// {"items": [...], "next_cursor": ...}.
/// @param rows  one more than the page takes, if there are as many
template <typename Row, typename ToJson>
nlohmann::json make_page(const std::vector<Row>& rows, std::size_t limit, const PageChecker& checker,
                         const ToJson& to_json) {
  nlohmann::json items = nlohmann::json::array();
  for (std::size_t i = 0; i < std::min(limit, rows.size()); ++i) {
    items.push_back(to_json(rows[i]));
    checker.take_fields(items.back());
  }
  return {{"items", std::move(items)}, {"next_cursor", rows.size() > limit ? rows[limit - 1].id : ""}};
}

}  // namespace jobs
