#include "server/job_routes.h"

#include <chrono>
#include <string>
#include <utility>

#include "jobs/requests/parameter_schema.h"
#include "jobs/results/csv.h"
#include "jobs/trajectories/npz.h"
#include "server/conditional.h"
#include "server/json_text.h"
#include "server/listing.h"
#include "server/problem.h"
#include "server/query.h"
#include "server/tables.h"

namespace server {

namespace {

HttpError no_such_job(const std::string& id) { return {404, "there is no job " + id}; }

bool has_ended(const nlohmann::json& job) { return job.at("state") != "queued" && job.at("state") != "running"; }

/// Waits for the end of a job, if that is preferred.
bool wait_as_preferred(const Call& call, const std::string& id, Response& response) {
  return call.waiting_room.wait(call.request, response, [&](std::chrono::seconds time) { call.service.wait_for_job(id, time); });
}

std::string trajectory_text(const engine::Trajectory& trajectory, TableFormat format) {
  if (format == TableFormat::kCsv) return jobs::to_csv(trajectory);
  return format == TableFormat::kNpz ? jobs::to_npz(trajectory) : to_json_columns(trajectory);
}

}  // namespace

Response post_job(const Call& call) {
  Query(call.request, {}).check();
  auto job = call.service.submit_job(parse_json(call.request.body), find_key(call.request));
  const std::string id = job.at("id");
  Response response = make_json(201, "");
  if (wait_as_preferred(call, id, response)) job = call.service.find_job(id).value_or(job);
  response.body = to_text(job) + "\n";
  response.headers.emplace_back("Location", "/v1/jobs/" + id);
  return response;
}

Response get_jobs(const Call& call) {
  return make_json(200, to_text(list_page(call.request, [&](const jobs::PageQuery& page) { return call.service.list_jobs(page); })));
}

Response get_job(const Call& call) {
  Query(call.request, {}).check();
  Response response = make_json(200, "");
  wait_as_preferred(call, call.id, response);
  const auto job = call.service.find_job(call.id);
  if (!job) throw no_such_job(call.id);
  response.body = to_text(*job) + "\n";
  return has_ended(*job) ? with_etag(call.request, std::move(response)) : without_etag(std::move(response));
}

Response cancel_job(const Call& call) {
  Query(call.request, {}).check();
  const auto job = call.service.cancel_job(call.id);
  if (!job) throw no_such_job(call.id);
  return make_json(200, to_text(*job));
}

Response get_trajectory(const Call& call) {
  Query query(call.request, {"channels", "from", "to", "points", "format"});
  const TableFormat format = find_column_format(call.request, query);
  jobs::TrajectoryQuery wanted;
  wanted.channels = query.list("channels");
  wanted.from = query.number("from");
  wanted.to = query.number("to");
  wanted.points = query.count("points");
  const auto trajectory = query.check_and([&] { return call.service.find_trajectory(call.id, wanted); });
  if (!trajectory) {
    const auto job = call.service.find_job(call.id);
    if (!job) throw no_such_job(call.id);
    throw HttpError(404, "job " + call.id + " is " + job->at("state").template get<std::string>() +
                             " and has no trajectory");
  }
  // Only what has ended has a trajectory.
  return with_etag(call.request, make_table(format, trajectory_text(*trajectory, format), "job-" + call.id));
}

Response get_parameters(const Call& call) {
  Query(call.request, {}).check();
  return make_json(200, to_text(jobs::parameter_schema()));
}

}  // namespace server
