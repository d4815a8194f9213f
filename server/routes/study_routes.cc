// SPDX-License-Identifier: Apache-2.0
#include "server/routes/study_routes.h"

#include <chrono>
#include <cstdint>
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

using jobs::Study;

/// Name that users know a kind of study by, and path of its resources.
struct KindOfStudy {
  const char* name;
  const char* path;
};

constexpr KindOfStudy kind_of_study(Study study) {
  return study == Study::kLimit ? KindOfStudy{"search", "/v1/searches/"}
                                : KindOfStudy{"wear study", "/v1/wear-studies/"};
}

HttpError no_such(Study study, const std::string& id) {
  return {404, std::string("there is no ") + kind_of_study(study).name + " " + id};
}

Resource study_resource(Study study, const RequestContext& context) {
  jobs::Service& service = context.service;
  return {.path = kind_of_study(study).path,
          .find = [&service, study](const std::string& id) { return service.find_study(study, id); },
          .wait_for = [&service, study](
                          const std::string& id,
                          std::chrono::seconds at_most) { service.wait_for_study(study, id, at_most); },
          .has_ended = [](const nlohmann::json& found) { return found.at("state") != "running"; },
          .missing = [study](const std::string& id) { return no_such(study, id); }};
}

}  // namespace

template <Study kStudy>
Response post_study(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_created(context, study_resource(kStudy, context),
                         context.service.submit_study(kStudy, parse_json(context.request.body),
                                                      find_idempotency_key(context.request)));
}

template <Study kStudy>
Response get_studies(const RequestContext& context) {
  return json_response(200, to_text(list_page(context.request, [&](const jobs::PageQuery& page) {
                         return context.service.list_studies(kStudy, page);
                       })));
}

template <Study kStudy>
Response get_study(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_found(context, study_resource(kStudy, context));
}

template <Study kStudy>
Response delete_study(const RequestContext& context) {
  Query(context.request, {}).check();
  if (!context.service.delete_study(kStudy, context.id)) throw no_such(kStudy, context.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

template <Study kStudy>
Response get_study_results(const RequestContext& context) {
  Query query(context.request, {"format", "fields", "order_by", "limit"}, Query::Others::kKept);
  const TableFormat format = find_row_format(context.request, query);
  const jobs::ResultQuery wanted = read_result_query(query);
  const auto table =
      query.check_and([&] { return context.service.find_study_table(kStudy, context.id, wanted); });
  if (!table) throw no_such(kStudy, context.id);
  const std::string name = (kStudy == Study::kLimit ? "search-" : "wear-study-") + context.id;
  return with_etag_if(table->ended, context.request, make_table(format, to_text(*table, format), name));
}

template <Study kStudy>
Response get_study_events(const RequestContext& context) {
  const auto find_news = [&service = context.service, id = context.id](std::int64_t after) {
    return service.find_study_news(kStudy, id, after);
  };
  return answer_events(context, find_news, no_such(kStudy, context.id));
}

template <Study kStudy>
Response cancel_study(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, study_resource(kStudy, context),
                         context.service.cancel_study(kStudy, context.id));
}

template <Study kStudy>
Response retry_study(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, study_resource(kStudy, context),
                         context.service.retry_study(kStudy, context.id));
}

template Response post_study<Study::kLimit>(const RequestContext&);
template Response get_studies<Study::kLimit>(const RequestContext&);
template Response get_study<Study::kLimit>(const RequestContext&);
template Response delete_study<Study::kLimit>(const RequestContext&);
template Response get_study_results<Study::kLimit>(const RequestContext&);
template Response get_study_events<Study::kLimit>(const RequestContext&);
template Response cancel_study<Study::kLimit>(const RequestContext&);
template Response retry_study<Study::kLimit>(const RequestContext&);

template Response post_study<Study::kWear>(const RequestContext&);
template Response get_studies<Study::kWear>(const RequestContext&);
template Response get_study<Study::kWear>(const RequestContext&);
template Response delete_study<Study::kWear>(const RequestContext&);
template Response get_study_results<Study::kWear>(const RequestContext&);
template Response get_study_events<Study::kWear>(const RequestContext&);
template Response cancel_study<Study::kWear>(const RequestContext&);
template Response retry_study<Study::kWear>(const RequestContext&);

}  // namespace server
