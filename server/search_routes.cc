#include "server/search_routes.h"

#include <string>
#include <utility>

#include "server/conditional.h"
#include "server/json_text.h"
#include "server/listing.h"
#include "server/problem.h"
#include "server/query.h"
#include "server/tables.h"

namespace server {

namespace {

HttpError no_such_search(const std::string& id) { return {404, "there is no search " + id}; }

Response make_search(const Call& call, const std::optional<nlohmann::json>& search) {
  if (!search) throw no_such_search(call.id);
  return make_json(200, to_text(*search));
}

}  // namespace

Response post_search(const Call& call) {
  Query(call.request, {}).check();
  const auto search = call.service.submit_search(parse_json(call.request.body));
  Response response = make_json(201, to_text(search));
  response.headers.emplace_back("Location", "/v1/searches/" + search.at("id").get<std::string>());
  return response;
}

Response get_searches(const Call& call) {
  return make_json(200, to_text(list_page(call.request, [&](const jobs::PageQuery& page) { return call.service.list_searches(page); })));
}

Response get_search(const Call& call) {
  Query(call.request, {}).check();
  const auto search = call.service.find_search(call.id);
  Response response = make_search(call, search);
  return search->at("state") != "running" ? with_etag(call.request, std::move(response)) : without_etag(std::move(response));
}

Response delete_search(const Call& call) {
  Query(call.request, {}).check();
  if (!call.service.delete_search(call.id)) throw no_such_search(call.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

Response get_limits(const Call& call) {
  Query query(call.request, {"format"});
  const TableFormat format = find_row_format(call.request, query);
  query.check();
  const auto table = call.service.find_limits(call.id);
  if (!table) throw no_such_search(call.id);
  Response response = make_table(format, to_text(*table, format), "search-" + call.id);
  return table->ended ? with_etag(call.request, std::move(response)) : without_etag(std::move(response));
}

Response cancel_search(const Call& call) {
  Query(call.request, {}).check();
  return make_search(call, call.service.cancel_search(call.id));
}

Response retry_search(const Call& call) {
  Query(call.request, {}).check();
  return make_search(call, call.service.retry_search(call.id));
}

}  // namespace server
