// SPDX-License-Identifier: Apache-2.0
#include "server/routes/sweep_routes.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "server/messages/conditional.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/routes/events.h"
#include "server/routes/listing.h"
#include "server/routes/resource.h"
#include "server/routes/tables.h"

namespace server {

namespace {

HttpError no_such_sweep(const std::string& id) { return {404, "there is no sweep " + id}; }

bool have_all_ended(const nlohmann::json& sweep) {
  const auto& counts = sweep.at("counts");
  return counts.at("queued") == 0 && counts.at("running") == 0;
}

Resource sweep_resource(const Call& call) {
  jobs::Service& service = call.service;
  return {.path = "/v1/sweeps/",
          .find = [&service](const std::string& id) { return service.find_sweep(id); },
          .wait_for = [&service](const std::string& id, std::chrono::seconds at_most) { service.wait_for_sweep(id, at_most); },
          .has_ended = have_all_ended,
          .missing = no_such_sweep};
}

}  // namespace

Response post_sweep(const Call& call) {
  Query(call.request, {}).check();
  return answer_made(call, sweep_resource(call), call.service.submit_sweep(parse_json(call.request.body), find_key(call.request)));
}

Response get_sweeps(const Call& call) {
  return make_json(200, to_text(list_page(call.request, [&](const jobs::PageQuery& page) { return call.service.list_sweeps(page); })));
}

Response get_sweep(const Call& call) {
  Query(call.request, {}).check();
  return answer_found(call, sweep_resource(call));
}

Response delete_sweep(const Call& call) {
  Query(call.request, {}).check();
  if (!call.service.delete_sweep(call.id)) throw no_such_sweep(call.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

Response get_results(const Call& call) {
  Query query(call.request, {"format", "fields", "order_by", "limit"}, Query::Others::kKept);
  const TableFormat format = find_row_format(call.request, query);
  const jobs::ResultQuery wanted = read_result_query(query);
  const auto table = query.check_and([&] { return call.service.find_results(call.id, wanted); });
  if (!table) throw no_such_sweep(call.id);
  return with_etag_if(table->ended, call.request, make_table(format, to_text(*table, format), "sweep-" + call.id));
}

Response get_events(const Call& call) {
  const auto find_news = [&service = call.service, id = call.id](std::int64_t after) { return service.find_news(id, after); };
  return answer_events(call, find_news, no_such_sweep(call.id));
}

Response cancel_sweep(const Call& call) {
  Query(call.request, {}).check();
  return answer_changed(call, sweep_resource(call), call.service.cancel_sweep(call.id));
}

Response retry_sweep(const Call& call) {
  Query(call.request, {}).check();
  return answer_changed(call, sweep_resource(call), call.service.retry_sweep(call.id));
}

Response extend_sweep(const Call& call) {
  Query(call.request, {}).check();
  return answer_changed(call, sweep_resource(call), call.service.extend_sweep(call.id, parse_json(call.request.body)));
}

Response move_sweep(const Call& call) {
  Query(call.request, {}).check();
  return answer_changed(call, sweep_resource(call), call.service.move_sweep(call.id, parse_json(call.request.body)));
}

Response get_executors(const Call& call) {
  Query(call.request, {}).check();
  return make_json(200, to_text(call.service.list_executors()));
}

}  // namespace server
