// SPDX-License-Identifier: Apache-2.0
#include "server/routes/study_routes.h"

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

using jobs::Study;

/// What users call a study of the kind, and where it stands.
struct Words {
  const char* name;
  const char* path;
};

constexpr Words words_of(Study study) {
  return study == Study::kLimit ? Words{"search", "/v1/searches/"} : Words{"wear study", "/v1/wear-studies/"};
}

HttpError no_such(Study study, const std::string& id) { return {404, std::string("there is no ") + words_of(study).name + " " + id}; }

Resource study_resource(Study study, const Call& call) {
  jobs::Service& service = call.service;
  return {.path = words_of(study).path,
          .find = [&service, study](const std::string& id) { return service.find_study(study, id); },
          .wait_for = [&service, study](const std::string& id, std::chrono::seconds at_most) { service.wait_for_study(study, id, at_most); },
          .has_ended = [](const nlohmann::json& found) { return found.at("state") != "running"; },
          .missing = [study](const std::string& id) { return no_such(study, id); }};
}

}  // namespace

template <Study kStudy>
Response post_study(const Call& call) {
  Query(call.request, {}).check();
  return answer_made(call, study_resource(kStudy, call), call.service.submit_study(kStudy, parse_json(call.request.body), find_key(call.request)));
}

template <Study kStudy>
Response get_studies(const Call& call) {
  return make_json(200, to_text(list_page(call.request, [&](const jobs::PageQuery& page) { return call.service.list_studies(kStudy, page); })));
}

template <Study kStudy>
Response get_study(const Call& call) {
  Query(call.request, {}).check();
  return answer_found(call, study_resource(kStudy, call));
}

template <Study kStudy>
Response delete_study(const Call& call) {
  Query(call.request, {}).check();
  if (!call.service.delete_study(kStudy, call.id)) throw no_such(kStudy, call.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

template <Study kStudy>
Response get_study_results(const Call& call) {
  Query query(call.request, {"format", "fields", "order_by", "limit"}, Query::Others::kKept);
  const TableFormat format = find_row_format(call.request, query);
  const jobs::ResultQuery wanted = read_result_query(query);
  const auto table = query.check_and([&] { return call.service.find_study_table(kStudy, call.id, wanted); });
  if (!table) throw no_such(kStudy, call.id);
  const std::string name = (kStudy == Study::kLimit ? "search-" : "wear-study-") + call.id;
  return with_etag_if(table->ended, call.request, make_table(format, to_text(*table, format), name));
}

template <Study kStudy>
Response get_study_events(const Call& call) {
  const auto find_news = [&service = call.service, id = call.id](std::int64_t after) { return service.find_study_news(kStudy, id, after); };
  return answer_events(call, find_news, no_such(kStudy, call.id));
}

template <Study kStudy>
Response cancel_study(const Call& call) {
  Query(call.request, {}).check();
  return answer_changed(call, study_resource(kStudy, call), call.service.cancel_study(kStudy, call.id));
}

template <Study kStudy>
Response retry_study(const Call& call) {
  Query(call.request, {}).check();
  return answer_changed(call, study_resource(kStudy, call), call.service.retry_study(kStudy, call.id));
}

template Response post_study<Study::kLimit>(const Call&);
template Response get_studies<Study::kLimit>(const Call&);
template Response get_study<Study::kLimit>(const Call&);
template Response delete_study<Study::kLimit>(const Call&);
template Response get_study_results<Study::kLimit>(const Call&);
template Response get_study_events<Study::kLimit>(const Call&);
template Response cancel_study<Study::kLimit>(const Call&);
template Response retry_study<Study::kLimit>(const Call&);

template Response post_study<Study::kWear>(const Call&);
template Response get_studies<Study::kWear>(const Call&);
template Response get_study<Study::kWear>(const Call&);
template Response delete_study<Study::kWear>(const Call&);
template Response get_study_results<Study::kWear>(const Call&);
template Response get_study_events<Study::kWear>(const Call&);
template Response cancel_study<Study::kWear>(const Call&);
template Response retry_study<Study::kWear>(const Call&);

}  // namespace server
