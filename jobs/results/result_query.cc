// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/result_query.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/results/name_list.h"
#include "jobs/store/rows.h"

namespace jobs {
namespace {

using nlohmann::json;

enum class Comparison { kEqual, kGreater, kLess, kGreaterOrEqual, kLessOrEqual };

constexpr std::array<std::pair<std::string_view, Comparison>, 4> kSuffixes{
    {{"_gt", Comparison::kGreater}, {"_lt", Comparison::kLess}, {"_ge", Comparison::kGreaterOrEqual},
     {"_le", Comparison::kLessOrEqual}}};

/// A filter's key without its suffix, and what the suffix says. A column whose own name ends so is meant
/// itself.
std::pair<std::string, Comparison> split_key(const std::string& key, std::span<const std::string> known) {
  if (std::ranges::find(known, key) != known.end()) return {key, Comparison::kEqual};
  for (const auto& [suffix, comparison] : kSuffixes) {
    if (key.ends_with(suffix)) return {key.substr(0, key.size() - suffix.size()), comparison};
  }
  return {key, Comparison::kEqual};
}

/// The words that a column of text may hold; empty for columns of numbers. Ids are any text.
struct TextColumn {
  bool is_text = false;
  std::vector<std::string_view> words;
};

/// Columns of studies that hold text.
constexpr std::array<std::string_view, 8> kTextColumns{
    "verdict", "lost_reason", "parameter", "metric", "stage", "use", "channel", "measurement_id"};

/// States of jobs, of candidates and of the points of a fit.
std::vector<std::string_view> words_of_state() {
  std::vector<std::string_view> words(kJobStates.begin(), kJobStates.end());
  words.insert(words.end(), {"pending", "feasible", "infeasible", "lost"});
  return words;
}

TextColumn text_column(const std::string& column) {
  if (column == "job_id" || is_error_column(column)) return {.is_text = true, .words = {}};
  if (column == "state") return {.is_text = true, .words = words_of_state()};
  if (std::ranges::find(kTextColumns, column) != kTextColumns.end()) return {.is_text = true, .words = {}};
  if (column == "monotonic" || column == "on_front") return {.is_text = true, .words = {"true", "false"}};
  if (is_varied_by_cases(column) && column != kWearKey) return {.is_text = true, .words = {}};
  const ParameterInfo* const info = find_parameter(column);
  if (info == nullptr || info->kind != ParameterKind::kChoice) return {};
  return {.is_text = true, .words = info->choices};
}

std::string joined(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

/// One condition on the rows.
struct Condition {
  std::size_t column = 0;
  Comparison comparison = Comparison::kEqual;
  std::optional<double> number;  ///< empty: the text counts
  std::string text;

  [[nodiscard]] bool holds(const json& cell) const {
    if (!number)
      return cell.is_boolean() ? cell.dump() == text
                               : cell.is_string() && cell.get_ref<const std::string&>() == text;
    if (!cell.is_number()) return false;  // null: the job has no such value
    const double x = cell.get<double>();
    switch (comparison) {
      case Comparison::kEqual: return x == *number;
      case Comparison::kGreater: return x > *number;
      case Comparison::kLess: return x < *number;
      case Comparison::kGreaterOrEqual: return x >= *number;
      case Comparison::kLessOrEqual: return x <= *number;
    }
    return false;
  }
};

std::optional<double> read_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Reads the names and values of a query against the columns of a table, and gathers what is wrong with them.
class Reader {
 public:
  Reader(const std::vector<std::string>& columns, std::string_view listed)
      : columns_(columns), listed_(listed) {}

  Condition condition(const ResultFilter& filter) {
    const auto [name, comparison] = split_key(filter.key, columns_);
    const std::string pointer = pointer_token(filter.key);
    Condition condition{.column = index_of_column(name, pointer), .comparison = comparison, .number = {},
                        .text = filter.value};
    const TextColumn text = text_column(name);
    if (!text.is_text) {
      condition.number = read_number(filter.value);
      if (!condition.number) fault(pointer, "must be a number");
    } else if (comparison != Comparison::kEqual) {
      fault(pointer, name + " is text and knows no order; " + name + "=… asks for one value of it");
    } else if (!text.words.empty() && std::ranges::find(text.words, filter.value) == text.words.end()) {
      fault(pointer, "must be one of " + joined(text.words));
    }
    return condition;
  }

  /// Columns to order by; the second member says whether the largest comes first.
  std::vector<std::pair<std::size_t, bool>> order(const std::string& text) {
    std::vector<std::pair<std::size_t, bool>> order;
    if (text.empty()) return order;
    auto names = split_names(text, columns_);
    std::vector<bool> descending;
    for (std::string& name : names) {
      descending.push_back(name.starts_with('-'));
      if (descending.back()) name.erase(0, 1);
    }
    const auto indices = find_names(names, columns_, listed_, "/order_by", faults_);
    for (std::size_t i = 0; i < indices.size() && faults_.empty(); ++i)
      order.emplace_back(indices[i], descending[i]);
    return order;
  }

  /// @returns the columns that are wanted; the statistics of replicates are number columns.size()
  std::vector<std::size_t> fields(const std::string& text, bool replicates) {
    auto known = columns_;
    if (replicates) known.emplace_back("replicates");
    return find_names(split_names(text, known), known, listed_, "/fields", faults_);
  }

  void check() {
    if (!faults_.empty()) throw InvalidRequest(std::move(faults_));
  }

 private:
  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  std::size_t index_of_column(const std::string& name, const std::string& pointer) {
    const auto found = std::ranges::find(columns_, name);
    if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
    const std::vector<std::string_view> known(columns_.begin(), columns_.end());
    fault(pointer, describe_unknown_key(name, known, listed_) +
                       "; a filter is a column of the results, or one with _gt, _lt, _ge or _le");
    return 0;
  }

  const std::vector<std::string>& columns_;
  std::string_view listed_;
  std::vector<Fault> faults_;
};

/// Values before nulls, whichever way the values go.
bool comes_before(const json& a, const json& b, bool descending) {
  if (a.is_null() || b.is_null()) return !a.is_null() && b.is_null();
  return descending ? b < a : a < b;
}

/// The rows that pass.
std::vector<std::size_t> choose_rows(const ResultTable& table, const std::vector<Condition>& conditions) {
  std::vector<std::size_t> chosen;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (std::ranges::all_of(conditions, [&](const Condition& condition) {
          return condition.holds(table.rows[r][condition.column]);
        }))
      chosen.push_back(r);
  }
  return chosen;
}

/// Puts the first `count` of the chosen rows into their new order, and the rest behind them. Rows alike keep
/// the order they had.
void sort_rows(const ResultTable& table, const std::vector<std::pair<std::size_t, bool>>& order,
               std::size_t count, std::vector<std::size_t>& chosen) {
  const auto comes_first = [&](std::size_t a, std::size_t b) {
    for (const auto& [column, descending] : order) {
      const json& left = table.rows[a][column];
      const json& right = table.rows[b][column];
      if (comes_before(left, right, descending)) return true;
      if (comes_before(right, left, descending)) return false;
    }
    return a < b;
  };
  if (count == chosen.size())
    std::ranges::sort(chosen, comes_first);
  else
    std::ranges::partial_sort(chosen, chosen.begin() + static_cast<std::ptrdiff_t>(count), comes_first);
}

void take_rows(const std::vector<std::size_t>& chosen, ResultTable& table) {
  auto rows = std::exchange(table.rows, {});
  const auto replicates = std::exchange(table.replicates, {});
  table.rows.reserve(chosen.size());
  for (const std::size_t r : chosen) {
    table.rows.push_back(std::move(rows[r]));
    if (!replicates.empty()) table.replicates.push_back(replicates[r]);
  }
}

void take_columns(const std::vector<std::size_t>& wanted, ResultTable& table) {
  const std::size_t replicates = table.columns.size();
  if (std::ranges::find(wanted, replicates) == wanted.end()) table.replicates.clear();
  const auto take = [&](auto& row) {
    std::remove_reference_t<decltype(row)> taken;
    taken.reserve(wanted.size());
    for (const std::size_t column : wanted) {
      if (column != replicates) taken.push_back(std::move(row[column]));
    }
    row = std::move(taken);
  };
  take(table.columns);
  for (auto& row : table.rows) take(row);
}

/// The columns that a query names.
std::vector<std::string> names_in(const ResultQuery& query, std::span<const std::string> paths) {
  std::vector<std::string> names;
  for (const ResultFilter& filter : query.filters) names.push_back(split_key(filter.key, paths).first);
  for (const std::string& list : {query.fields, query.order_by}) {
    for (const std::string& name : split_names(list, paths))
      names.push_back(name.starts_with('-') ? name.substr(1) : name);
  }
  return names;
}

}  // namespace

std::vector<std::string> find_other_columns(const ResultQuery& query, const std::vector<std::string>& swept) {
  const auto& paths = known_paths();
  const std::vector<std::string> names = names_in(query, paths);
  std::vector<std::string> others;
  for (const std::string& path : paths) {
    if (std::ranges::find(names, path) != names.end() && std::ranges::find(swept, path) == swept.end())
      others.push_back(path);
  }
  for (const std::string_view column : kErrorColumns) {
    if (std::ranges::find(names, column) != names.end()) others.emplace_back(column);
  }
  return others;
}

RowParameters needed_parameters(const std::vector<std::string>& others) {
  return std::ranges::all_of(others, is_error_column) ? RowParameters::kNone : RowParameters::kAll;
}

void apply(const ResultQuery& query, ResultTable& table, std::string_view listed) {
  Reader reader(table.columns, listed);
  std::vector<Condition> conditions;
  for (const ResultFilter& filter : query.filters) conditions.push_back(reader.condition(filter));
  const auto order = reader.order(query.order_by);
  const auto wanted = query.fields.empty() ? std::vector<std::size_t>{}
                                           : reader.fields(query.fields, !table.replicates.empty());
  reader.check();
  auto chosen = choose_rows(table, conditions);
  const std::size_t count = std::min(chosen.size(), query.limit.value_or(chosen.size()));
  if (!order.empty()) sort_rows(table, order, count, chosen);
  chosen.resize(count);
  take_rows(chosen, table);
  if (!wanted.empty()) take_columns(wanted, table);
}

}  // namespace jobs
