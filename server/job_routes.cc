#include "server/job_routes.h"

#include <string>

#include "server/json_text.h"
#include "server/listing.h"
#include "server/problem.h"
#include "server/query.h"
#include "server/tables.h"

namespace server {

namespace {

HttpError no_such_job(const std::string& id) { return {404, "there is no job " + id}; }

}  // namespace

Response post_job(const Call& call) {
  Query(call.request, {}).check();
  const auto job = call.service.submit_job(parse_json(call.request.body));
  Response response = make_json(201, to_text(job));
  response.headers.emplace_back("Location", "/v1/jobs/" + job.at("id").template get<std::string>());
  return response;
}

Response get_jobs(const Call& call) {
  return make_json(200, to_text(call.service.list_jobs(read_page_query(call.request))));
}

Response get_job(const Call& call) {
  Query(call.request, {}).check();
  const auto job = call.service.find_job(call.id);
  if (!job) throw no_such_job(call.id);
  return make_json(200, to_text(*job));
}

Response cancel_job(const Call& call) {
  Query(call.request, {}).check();
  const auto job = call.service.cancel_job(call.id);
  if (!job) throw no_such_job(call.id);
  return make_json(200, to_text(*job));
}

Response get_trajectory(const Call& call) {
  Query query(call.request, {"channels", "from", "to", "format"});
  const TableFormat format = find_format(call.request, query);
  jobs::TrajectoryQuery wanted;
  wanted.channels = query.list("channels");
  wanted.from = query.number("from");
  wanted.to = query.number("to");
  query.check();
  const auto trajectory = call.service.find_trajectory(call.id, wanted);
  if (!trajectory) {
    const auto job = call.service.find_job(call.id);
    if (!job) throw no_such_job(call.id);
    throw HttpError(404, "job " + call.id + " is " + job->at("state").template get<std::string>() +
                             " and has no trajectory");
  }
  return make_table(format, format == TableFormat::kCsv ? jobs::to_csv(*trajectory) : to_json_columns(*trajectory),
                    "job-" + call.id);
}

Response get_parameters(const Call& call) {
  Query(call.request, {}).check();
  return make_json(200, to_text(jobs::parameter_schema()));
}

}  // namespace server
