#include "jobs/sensitivity/row_groups.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "jobs/errors.h"
#include "jobs/parameter_value.h"

namespace jobs {

std::size_t find_column(const ResultTable& table, const std::string& name, const std::string& pointer) {
  const auto found = std::ranges::find(table.columns, name);
  if (found != table.columns.end()) return static_cast<std::size_t>(found - table.columns.begin());
  const std::vector<std::string_view> known(table.columns.begin(), table.columns.end());
  throw InvalidRequest(std::vector<Fault>{{pointer, "\"" + name + "\": " + describe_unknown_key(name, known)}});
}

std::vector<RowGroup> group_rows(const ResultTable& table, const std::vector<std::size_t>& columns) {
  std::vector<RowGroup> groups;
  std::map<nlohmann::json, std::size_t> places;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    nlohmann::json values = nlohmann::json::array();
    for (const std::size_t column : columns) values.push_back(table.rows[r][column]);
    const auto [place, is_new] = places.try_emplace(values, groups.size());
    if (is_new) groups.push_back({.values = values.get<std::vector<nlohmann::json>>(), .rows = {}});
    groups[place->second].rows.push_back(r);
  }
  return groups;
}

std::size_t find_metric(const ResultTable& table, const std::string& metric) {
  std::vector<std::string_view> known;
  for (const engine::QuantityInfo& info : engine::metric_table()) known.push_back(info.key);
  if (std::ranges::find(known, metric) != known.end()) return find_column(table, metric, "/metric");
  throw InvalidRequest(std::vector<Fault>{{"/metric", "\"" + metric + "\": " + describe_unknown_key(metric, known)}});
}

std::optional<double> number_in(const nlohmann::json& cell) { return cell.is_number() ? std::optional(cell.get<double>()) : std::nullopt; }

}  // namespace jobs
