// SPDX-License-Identifier: Apache-2.0
#include "server/messages/accept.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "server/messages/trimmed.h"

namespace server {

namespace {

/// A media range, or a content coding.
struct MediaRange {
  std::string name;  ///< in small letters
  double weight = 1.0;
};

/// Piece of a text before the first separator. Both are taken off the text.
std::string_view take_until(char separator, std::string_view& text) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view taken = trimmed(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return taken;
}

std::string to_small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

/// A weight that cannot be read counts as none said.
double find_weight(std::string_view parameters) {
  while (!parameters.empty()) {
    std::string_view value = take_until(';', parameters);
    const std::string_view name = take_until('=', value);
    if (name != "q" && name != "Q") continue;
    double weight = 1.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), weight);
    return error == std::errc{} && end == value.data() + value.size() && weight >= 0.0 && weight <= 1.0
               ? weight
               : 1.0;
  }
  return 1.0;
}

std::vector<MediaRange> read_ranges(std::string_view accept) {
  std::vector<MediaRange> ranges;
  while (!accept.empty()) {
    std::string_view item = take_until(',', accept);
    const std::string name = to_small_letters(take_until(';', item));
    ranges.push_back({name, find_weight(item)});
  }
  return ranges;
}

/// Index of the narrowest range that a type is in: itself, its kind, or all; past the end if there is
/// none.
std::size_t find_range(const std::vector<MediaRange>& ranges, std::string_view media_type) {
  const std::string kind = std::string(media_type.substr(0, media_type.find('/'))) + "/*";
  for (const std::string_view name : {media_type, std::string_view(kind), std::string_view("*/*")}) {
    const auto found = std::ranges::find(ranges, name, &MediaRange::name);
    if (found != ranges.end()) return static_cast<std::size_t>(found - ranges.begin());
  }
  return ranges.size();
}

}  // namespace

std::optional<std::size_t> find_accepted(std::string_view accept,
                                         std::span<const std::string_view> media_types) {
  const std::vector<MediaRange> ranges = read_ranges(accept);
  std::optional<std::size_t> best;
  std::size_t best_index = 0;
  for (std::size_t i = 0; i < media_types.size(); ++i) {
    const std::size_t index = find_range(ranges, media_types[i]);
    if (index == ranges.size() || ranges[index].weight == 0.0) continue;
    const bool wins = !best || ranges[index].weight > ranges[best_index].weight ||
                      (ranges[index].weight == ranges[best_index].weight && index < best_index);
    if (!wins) continue;
    best = i;
    best_index = index;
  }
  return best;
}

bool wants_gzip(std::string_view accept_encoding) {
  const std::vector<MediaRange> codings = read_ranges(accept_encoding);
  const auto weight_of = [&](std::initializer_list<std::string_view> names, double unsaid) {
    for (const std::string_view name : names) {
      const auto found = std::ranges::find(codings, name, &MediaRange::name);
      if (found != codings.end()) return found->weight;
    }
    return unsaid;
  };
  const double gzip = weight_of({"gzip", "x-gzip", "*"}, 0.0);
  return gzip > 0.0 && gzip >= weight_of({"identity", "*"}, 0.0);
}

}  // namespace server
