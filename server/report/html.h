// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace server::report {

/// A text as HTML shows it.
[[nodiscard]] std::string escape(const std::string& text);

/// A cell as people read it: numbers in five significant digits, null as a dash.
[[nodiscard]] std::string cell_text(const nlohmann::json& cell);

/// A table with a heading for each column; without headings, if there are none. Ids of jobs are links.
[[nodiscard]] std::string make_table(const std::vector<std::string>& headings,
                                     const std::vector<std::vector<nlohmann::json>>& rows);

/// A whole page with its one style, and without anything that runs or is fetched.
[[nodiscard]] std::string make_page(const std::string& title, const std::string& body);

/// The policy under which a page of make_page() shows as it is, and nothing else: its style is named by its
/// hash.
[[nodiscard]] std::string page_policy();

}  // namespace server::report
