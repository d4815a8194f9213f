// SPDX-License-Identifier: Apache-2.0
#include "server/routes/listing.h"

#include <utility>

#include "server/routes/resource.h"

namespace server {

namespace {

using List = std::function<nlohmann::json(const jobs::PageQuery&)>;

nlohmann::json list_with(const Request& request, Query& query, jobs::PageQuery page, const List& list) {
  page.limit = query.count("limit").value_or(page.limit);
  page.cursor = query.text("cursor").value_or("");
  page.fields = query.names("fields");
  nlohmann::json found = query.check_and([&] { return list(page); });
  for (auto& item : found.at("items")) item = under_base_path(request, std::move(item));
  return found;
}

}  // namespace

nlohmann::json list_page(const Request& request, const List& list) {
  Query query(request, {"state", "limit", "cursor", "fields"});
  jobs::PageQuery page;
  page.state = query.text("state").value_or("");
  return list_with(request, query, std::move(page), list);
}

nlohmann::json list_stateless_page(const Request& request, const List& list) {
  Query query(request, {"limit", "cursor", "fields"});
  return list_with(request, query, {}, list);
}

jobs::ResultQuery read_result_query(Query& query) {
  jobs::ResultQuery wanted;
  wanted.fields = query.names("fields");
  wanted.order_by = query.names("order_by");
  wanted.limit = query.count("limit");
  for (const auto& [key, value] : query.others()) wanted.filters.push_back({key, value});
  return wanted;
}

}  // namespace server
