#include "server/listing.h"

#include "server/query.h"

namespace server {

jobs::PageQuery read_page_query(const Request& request) {
  Query query(request, {"state", "limit", "cursor", "fields"});
  jobs::PageQuery page;
  page.state = query.text("state").value_or("");
  page.limit = query.count("limit").value_or(page.limit);
  page.cursor = query.text("cursor").value_or("");
  page.fields = query.names("fields");
  query.check();
  return page;
}

}  // namespace server
