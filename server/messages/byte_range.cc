// SPDX-License-Identifier: Apache-2.0
#include "server/messages/byte_range.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <utility>

#include "server/messages/problem.h"

namespace server {

namespace {

struct ByteRange {
  std::size_t first = 0, last = 0;  ///< both included
};

std::optional<std::size_t> to_count(std::string_view digits) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return count;
}

/// Range of "bytes=2-5", "bytes=2-" or "bytes=-3". Empty if the text is none of these. A range that begins at
/// the end of the file or beyond has first == size.
std::optional<ByteRange> read_range(std::string_view text, std::size_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (!text.starts_with(kUnit)) return std::nullopt;
  text.remove_prefix(kUnit.size());
  const auto dash = text.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto first = to_count(text.substr(0, dash));
  const auto last = to_count(text.substr(dash + 1));
  const std::size_t end = std::max<std::size_t>(size, 1) - 1;
  if (dash == 0) {
    if (!last) return std::nullopt;
    return ByteRange{size - std::min(*last, size), end};
  }
  if (!first || (!last && dash + 1 != text.size()) || (last && *last < *first)) return std::nullopt;
  return ByteRange{std::min(*first, size), std::min(last.value_or(end), end)};
}

Response make_range_problem(std::size_t size) {
  Response refusal = make_problem(416, "the file has " + std::to_string(size) + " bytes");
  refusal.headers.emplace_back("Content-Range", "bytes */" + std::to_string(size));
  return refusal;
}

/// Makes the answer with a whole file that with a part of it.
void cut_to_range(Response& response, const ByteRange& range) {
  response.status = 206;
  response.headers.emplace_back("Content-Range", "bytes " + std::to_string(range.first) + "-" +
                                                     std::to_string(range.last) + "/" +
                                                     std::to_string(response.file->size()));
  response.file->cut(range.first, range.last + 1);
}

}  // namespace

Response answer_with_file(const Request& request, Response response, std::shared_ptr<FileBody> file,
                          std::string_view etag) {
  const std::size_t size = file->size();
  response.headers.emplace_back("Accept-Ranges", "bytes");
  response.file = std::move(file);
  if (response.status != 200 || request.method != "GET" ||
      (!request.if_range.empty() && request.if_range != etag))
    return response;
  const auto range = read_range(request.range, size);
  if (!range) return response;
  if (range->first == size) return make_range_problem(size);
  cut_to_range(response, *range);
  return response;
}

}  // namespace server
