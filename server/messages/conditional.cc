// SPDX-License-Identifier: Apache-2.0
#include "server/messages/conditional.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "jobs/base/content_id.h"
#include "server/messages/problem.h"

namespace server {

namespace {

enum class WeakTags { kCount, kDoNotCount };

/// @returns whether a list of tags has this one, or is "*"
/// @param tag   empty: there is none
/// @param weak  to read something, tags marked as weak count: bodies are the same to the byte or differ
bool has_tag(std::string_view list, std::string_view tag, WeakTags weak) {
  while (!list.empty()) {
    const auto comma = std::min(list.find(','), list.size());
    std::string_view item = list.substr(0, comma);
    list.remove_prefix(std::min(comma + 1, list.size()));
    while (item.starts_with(' ') || item.starts_with('\t')) item.remove_prefix(1);
    while (item.ends_with(' ') || item.ends_with('\t')) item.remove_suffix(1);
    if (weak == WeakTags::kCount && item.starts_with("W/")) item.remove_prefix(2);
    // Empty items mean nothing (RFC 9110, section 5.6.1.2), not even where there is no tag.
    if (!item.empty() && (item == tag || item == "*")) return true;
  }
  return false;
}

}  // namespace

Response with_etag(const Request& request, Response response) {
  const std::string tag =
      "\"" + jobs::sha256_hex(response.content_type + "\n", response.body).substr(0, 32) + "\"";
  response.headers.emplace_back("Cache-Control", "private, no-cache");
  return with_etag(request, std::move(response), tag);
}

Response with_etag(const Request& request, Response response, std::string_view etag) {
  response.headers.emplace_back("ETag", etag);
  if (!has_tag(request.if_none_match, etag, WeakTags::kCount)) return response;
  response.status = 304;
  response.content_type.clear();
  response.body.clear();
  return response;
}

void check_if_match(const Request& request, const Response& current) {
  const auto header = std::ranges::find(current.headers, "ETag", &std::pair<std::string, std::string>::first);
  const std::string tag = header == current.headers.end() ? "" : header->second;
  if (has_tag(request.if_match, tag, WeakTags::kDoNotCount)) return;
  throw HttpError(412, tag.empty() ? "If-Match names a state, and what has not ended has no ETag yet"
                                   : "this has changed since: its ETag is " + tag + " now");
}

Response without_etag(Response response) {
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

Response with_etag_if(bool ended, const Request& request, Response response) {
  return ended ? with_etag(request, std::move(response)) : without_etag(std::move(response));
}

}  // namespace server
