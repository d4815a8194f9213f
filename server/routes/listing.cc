// SPDX-License-Identifier: Apache-2.0
#include "server/routes/listing.h"

#include <utility>

#include "server/routes/resource.h"

namespace server {

nlohmann::json list_page(const Request& request,
                         const std::function<nlohmann::json(const jobs::PageQuery&)>& list) {
  Query query(request, {"state", "limit", "cursor", "fields"});
  jobs::PageQuery page;
  page.state = query.text("state").value_or("");
  page.limit = query.count("limit").value_or(page.limit);
  page.cursor = query.text("cursor").value_or("");
  page.fields = query.names("fields");
  nlohmann::json found = query.check_and([&] { return list(page); });
  for (auto& item : found.at("items")) item = under_base_path(request, std::move(item));
  return found;
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
