#include "server/listing.h"

#include "server/query.h"

namespace server {

nlohmann::json list_page(const Request& request, const std::function<nlohmann::json(const jobs::PageQuery&)>& list) {
  Query query(request, {"state", "limit", "cursor", "fields"});
  jobs::PageQuery page;
  page.state = query.text("state").value_or("");
  page.limit = query.count("limit").value_or(page.limit);
  page.cursor = query.text("cursor").value_or("");
  page.fields = query.names("fields");
  return query.check_and([&] { return list(page); });
}

}  // namespace server
