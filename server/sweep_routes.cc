#include "server/sweep_routes.h"

#include <string>

#include "server/json_text.h"
#include "server/listing.h"
#include "server/problem.h"
#include "server/query.h"
#include "server/tables.h"

namespace server {

namespace {

HttpError no_such_sweep(const std::string& id) { return {404, "there is no sweep " + id}; }

}  // namespace

Response post_sweep(const Call& call) {
  Query(call.request, {}).check();
  const auto sweep = call.service.submit_sweep(parse_json(call.request.body));
  Response response = make_json(201, to_text(sweep));
  response.headers.emplace_back("Location", "/v1/sweeps/" + sweep.at("id").template get<std::string>());
  return response;
}

Response get_sweeps(const Call& call) {
  return make_json(200, to_text(call.service.list_sweeps(read_page_query(call.request))));
}

Response get_sweep(const Call& call) {
  Query(call.request, {}).check();
  const auto sweep = call.service.find_sweep(call.id);
  if (!sweep) throw no_such_sweep(call.id);
  return make_json(200, to_text(*sweep));
}

Response delete_sweep(const Call& call) {
  Query(call.request, {}).check();
  if (!call.service.delete_sweep(call.id)) throw no_such_sweep(call.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

Response get_results(const Call& call) {
  Query query(call.request, {"format"});
  const TableFormat format = find_format(call.request, query);
  query.check();
  const auto table = call.service.find_results(call.id);
  if (!table) throw no_such_sweep(call.id);
  return make_table(format, format == TableFormat::kCsv ? jobs::to_csv(*table) : to_json_rows(*table),
                    "sweep-" + call.id);
}

Response cancel_sweep(const Call& call) {
  Query(call.request, {}).check();
  const auto sweep = call.service.cancel_sweep(call.id);
  if (!sweep) throw no_such_sweep(call.id);
  return make_json(200, to_text(*sweep));
}

}  // namespace server
