// SPDX-License-Identifier: Apache-2.0
#include "server/routes/job_routes.h"

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "jobs/assembly.h"
#include "jobs/base/errors.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/requests/parameter_schema.h"
#include "server/messages/identifiers.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/routes/listing.h"
#include "server/routes/resource.h"
#include "server/routes/tables.h"
#include "server/routes/trajectory_answer.h"

namespace server {

namespace {

HttpError no_such_job(const std::string& id) { return {404, "there is no job " + id}; }

bool has_ended(const nlohmann::json& job) {
  return job.at("state") != "queued" && job.at("state") != "running";
}

Resource job_resource(const RequestContext& context) {
  jobs::Service& service = context.service;
  return {.path = "/v1/jobs/",
          .find = [&service](const std::string& id) { return service.find_job(id); },
          .wait_for = [&service](const std::string& id,
                                 std::chrono::seconds at_most) { service.wait_for_job(id, at_most); },
          .has_ended = has_ended,
          .missing = no_such_job};
}

}  // namespace

Response post_job(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_created(
      context, job_resource(context),
      context.service.submit_job(parse_json(context.request.body), find_idempotency_key(context.request)));
}

Response post_assembly(const RequestContext& context) {
  Query(context.request, {}).check();
  const nlohmann::json request = parse_json(context.request.body);
  if (!request.is_object() || request.size() != 1 || !request.contains("parameters"))
    throw jobs::InvalidRequest(std::vector<jobs::Fault>{{"", "must be an object with \"parameters\""}});
  return json_response(200, to_text(jobs::find_assembly(request.at("parameters"))));
}

Response get_jobs(const RequestContext& context) {
  return json_response(200, to_text(list_page(context.request, [&](const jobs::PageQuery& page) {
                         return context.service.list_jobs(page);
                       })));
}

Response get_job(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_found(context, job_resource(context));
}

Response cancel_job(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_updated(context, job_resource(context), context.service.cancel_job(context.id));
}

Response delete_job(const RequestContext& context) {
  Query(context.request, {}).check();
  if (!context.service.delete_job(context.id)) throw no_such_job(context.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

Response get_trajectory(const RequestContext& context) {
  Query query(context.request, {"channels", "from", "to", "points", "format"});
  const TableFormat format = find_column_format(context.request, query);
  const jobs::TrajectoryQuery wanted = read_trajectory_query(query);
  auto response = answer_with_columns(
      context, query, wanted, format, "job-" + context.id, [&](const auto& asked, const auto& is_wanted) {
        return context.service.find_trajectory_view(context.id, asked, is_wanted);
      });
  if (response) return std::move(*response);
  throw no_trajectory(context);
}

HttpError no_trajectory(const RequestContext& context) {
  const auto job = context.service.find_job(context.id);
  if (!job) return no_such_job(context.id);
  const bool kept = !jobs::keeps_metrics_alone(job->at("parameters"));
  return {404, "job " + context.id + " is " + job->at("state").get<std::string>() + " and has no trajectory" +
                   (kept ? "" : ": it was submitted with \"keep\": \"metrics\"")};
}

Response get_parameters(const RequestContext& context) {
  Query(context.request, {}).check();
  static const std::string text = to_text(jobs::parameter_schema());
  return json_response(200, text);
}

}  // namespace server
