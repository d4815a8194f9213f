// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/nearest_name.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace jobs {
namespace {

/// Optimal string alignment: Levenshtein's distance in which two neighbours that have changed places count 1.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j] + (a[i] == b[j] ? 0 : 1), row[j] + 1, last[j + 1] + 1});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last.back();
}

/// Edit distance of a name from a known one; empty if too far to be a slip of the pen.
std::optional<std::size_t> name_distance(std::string_view given, std::string_view known) {
  if (!given.empty() && known.size() > given.size() && known.starts_with(given) && known[given.size()] == '_')
    return 0;
  const std::size_t furthest = std::max<std::size_t>(1, known.size() / 4);
  // The difference of the lengths is a lower bound, and costs nothing.
  if (given.size() > known.size() + furthest || known.size() > given.size() + furthest) return std::nullopt;
  const std::size_t distance = edit_distance(given, known);
  return distance <= furthest ? std::optional(distance) : std::nullopt;
}

}  // namespace

std::optional<std::string_view> find_nearest_name(std::string_view given,
                                                  std::span<const std::string_view> known) {
  std::optional<std::string_view> nearest;
  std::optional<std::size_t> least;
  for (const std::string_view candidate : known) {
    const auto distance = name_distance(given, candidate);
    if (!distance || (least && *distance >= *least)) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace jobs
