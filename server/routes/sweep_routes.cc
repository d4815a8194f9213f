// SPDX-License-Identifier: Apache-2.0
#include "server/routes/sweep_routes.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "server/messages/conditional.h"
#include "server/messages/identifiers.h"
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

Resource sweep_resource(const RequestContext& context) {
  jobs::Service& service = context.service;
  return {.path = "/v1/sweeps/",
          .find = [&service](const std::string& id) { return service.find_sweep(id); },
          .wait_for = [&service](const std::string& id,
                                 std::chrono::seconds at_most) { service.wait_for_sweep(id, at_most); },
          .has_ended = have_all_ended,
          .missing = no_such_sweep};
}

}  // namespace

Response post_sweep(const RequestContext& context) {
  Query query(context.request, {"dry_run"});
  constexpr std::array<std::string_view, 2> kWords{"false", "true"};
  const bool dry = query.word("dry_run", kWords) == kWords.back();
  query.check();
  if (dry)
    return json_response(200, to_text(context.service.estimate_sweep(parse_json(context.request.body))));
  return respond_created(
      context, sweep_resource(context),
      context.service.submit_sweep(parse_json(context.request.body), find_idempotency_key(context.request)));
}

Response get_sweeps(const RequestContext& context) {
  return json_response(200, to_text(list_page(context.request, [&](const jobs::PageQuery& page) {
                         return context.service.list_sweeps(page);
                       })));
}

Response get_sweep(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_found(context, sweep_resource(context));
}

Response describe_sweep(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, sweep_resource(context),
                         context.service.describe_sweep(context.id, parse_json(context.request.body)));
}

Response delete_sweep(const RequestContext& context) {
  Query(context.request, {}).check();
  if (!context.service.delete_sweep(context.id)) throw no_such_sweep(context.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

Response get_results(const RequestContext& context) {
  Query query(context.request, {"format", "fields", "order_by", "limit", "metric"}, Query::Others::kKept);
  const TableFormat format = find_row_format(context.request, query);
  jobs::ResultQuery wanted = read_result_query(query);
  wanted.metric = query.text("metric").value_or("");
  const auto table = query.check_and([&] { return context.service.find_results(context.id, wanted); });
  if (!table) throw no_such_sweep(context.id);
  return with_etag_if(table->ended, context.request,
                      make_table(format, to_text(*table, format), "sweep-" + context.id));
}

Response get_events(const RequestContext& context) {
  const auto find_news = [&service = context.service, id = context.id](std::int64_t after) {
    return service.find_news(id, after);
  };
  return answer_events(context, find_news, no_such_sweep(context.id));
}

Response cancel_sweep(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, sweep_resource(context), context.service.cancel_sweep(context.id));
}

Response retry_sweep(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, sweep_resource(context), context.service.retry_sweep(context.id));
}

Response extend_sweep(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, sweep_resource(context),
                         context.service.extend_sweep(context.id, parse_json(context.request.body)));
}

Response move_sweep(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, sweep_resource(context),
                         context.service.move_sweep(context.id, parse_json(context.request.body)));
}

Response get_executors(const RequestContext& context) {
  Query(context.request, {}).check();
  return json_response(200, to_text(context.service.list_executors()));
}

}  // namespace server
