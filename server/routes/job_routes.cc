// SPDX-License-Identifier: Apache-2.0
#include "server/routes/job_routes.h"

#include <chrono>
#include <string>
#include <utility>

#include "jobs/requests/parameter_schema.h"
#include "jobs/results/csv.h"
#include "jobs/results/table_json.h"
#include "jobs/trajectories/npz.h"
#include "server/messages/conditional.h"
#include "server/messages/identifiers.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/routes/listing.h"
#include "server/routes/resource.h"
#include "server/routes/tables.h"

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

std::string trajectory_text(const engine::Trajectory& trajectory, TableFormat format) {
  if (format == TableFormat::kCsv) return jobs::to_csv(trajectory);
  return format == TableFormat::kNpz ? jobs::to_npz(trajectory) : jobs::to_json_columns(trajectory);
}

}  // namespace

Response post_job(const RequestContext& context) {
  Query(context.request, {}).check();
  return respond_created(
      context, job_resource(context),
      context.service.submit_job(parse_json(context.request.body), find_idempotency_key(context.request)));
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

Response get_trajectory(const RequestContext& context) {
  Query query(context.request, {"channels", "from", "to", "points", "format"});
  const TableFormat format = find_column_format(context.request, query);
  jobs::TrajectoryQuery wanted;
  wanted.channels = query.list("channels");
  wanted.from = query.number("from");
  wanted.to = query.number("to");
  wanted.points = query.count("points");
  const auto trajectory =
      query.check_and([&] { return context.service.find_trajectory(context.id, wanted); });
  if (!trajectory) {
    const auto job = context.service.find_job(context.id);
    if (!job) throw no_such_job(context.id);
    throw HttpError(404, "job " + context.id + " is " + job->at("state").template get<std::string>() +
                             " and has no trajectory");
  }
  // Only what has ended has a trajectory.
  return with_etag(context.request,
                   make_table(format, trajectory_text(*trajectory, format), "job-" + context.id));
}

Response get_parameters(const RequestContext& context) {
  Query(context.request, {}).check();
  return json_response(200, to_text(jobs::parameter_schema()));
}

}  // namespace server
