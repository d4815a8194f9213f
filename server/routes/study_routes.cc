// SPDX-License-Identifier: Apache-2.0
#include "server/routes/study_routes.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
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

using jobs::StudyKind;

HttpError no_such(StudyKind kind, const std::string& id) {
  return {404, "there is no " + std::string(kind_info(kind).name) + " " + id};
}

Resource study_resource(StudyKind kind, const RequestContext& context) {
  jobs::Service& service = context.service;
  return {.path = std::string(kind_info(kind).path) + "/",
          .find = [&service, kind](const std::string& id) { return service.find_study(kind, id); },
          .wait_for = [&service, kind](
                          const std::string& id,
                          std::chrono::seconds at_most) { service.wait_for_study(kind, id, at_most); },
          .has_ended = [](const nlohmann::json& found) { return found.at("state") != "running"; },
          .missing = [kind](const std::string& id) { return no_such(kind, id); }};
}

/// @param suffix  of the name of the file
Response answer_with_rows(
    const RequestContext& context, StudyKind kind, const std::string& suffix,
    const std::function<std::optional<jobs::ResultTable>(const jobs::ResultQuery&)>& find_table) {
  Query query(context.request, {"format", "fields", "order_by", "limit"}, Query::Others::kKept);
  const TableFormat format = find_row_format(context.request, query);
  const jobs::ResultQuery wanted = read_result_query(query);
  const auto table = query.check_and([&] { return find_table(wanted); });
  if (!table) throw no_such(kind, context.id);
  const std::string name = std::string(kind_info(kind).file_name) + "-" + context.id + suffix;
  return with_etag_if(table->ended, context.request, make_table(format, to_text(*table, format), name));
}

}  // namespace

template <StudyKind kKind>
Response StudyRoutes<kKind>::post(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_created(context, study_resource(kKind, context),
                         context.service.submit_study(kKind, parse_json(context.request.body),
                                                      find_idempotency_key(context.request)));
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::list(const RequestContext& context) {
  return json_response(200, to_text(list_page(context.request, [&](const jobs::PageQuery& page) {
                         return context.service.list_studies(kKind, page);
                       })));
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::get(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_found(context, study_resource(kKind, context));
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::erase(const RequestContext& context) {
  Query(context.request, {}).check();
  if (!context.service.delete_study(kKind, context.id)) throw no_such(kKind, context.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::get_results(const RequestContext& context) {
  return answer_with_rows(context, kKind, "", [&](const jobs::ResultQuery& wanted) {
    return context.service.find_study_table(kKind, context.id, wanted);
  });
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::get_signals(const RequestContext& context) {
  return answer_with_rows(context, kKind, "-signals", [&](const jobs::ResultQuery& wanted) {
    return context.service.find_study_signals(kKind, context.id, wanted);
  });
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::get_events(const RequestContext& context) {
  const auto find_news = [&service = context.service, id = context.id](std::int64_t after) {
    return service.find_study_news(kKind, id, after);
  };
  return answer_events(context, find_news, no_such(kKind, context.id));
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::cancel(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, study_resource(kKind, context),
                         context.service.cancel_study(kKind, context.id));
}

template <StudyKind kKind>
Response StudyRoutes<kKind>::retry(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, study_resource(kKind, context),
                         context.service.retry_study(kKind, context.id));
}

template struct StudyRoutes<StudyKind::kSearch>;
template struct StudyRoutes<StudyKind::kWear>;
template struct StudyRoutes<StudyKind::kOptimisation>;
template struct StudyRoutes<StudyKind::kFit>;

}  // namespace server
