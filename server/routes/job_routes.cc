// SPDX-License-Identifier: Apache-2.0
#include "server/routes/job_routes.h"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/requests/parameter_schema.h"
#include "jobs/results/trajectory_table_text.h"
#include "jobs/trajectories/trajectory_text.h"
#include "server/messages/conditional.h"
#include "server/messages/error_answer.h"
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

std::unique_ptr<jobs::TrajectoryText> make_trajectory_text(jobs::TrajectoryView view, TableFormat format) {
  if (format == TableFormat::kCsv) return jobs::csv_text(std::move(view));
  return format == TableFormat::kNpz ? jobs::npz_text(std::move(view)) : jobs::json_text(std::move(view));
}

/// Text of a long trajectory, with the permit to hold it.
class TrajectoryBody final : public BodyStream {
 public:
  TrajectoryBody(std::unique_ptr<jobs::TrajectoryText> text, std::shared_ptr<const void> permit)
      : permit_(std::move(permit)), text_(std::move(text)) {}
  bool append_next(std::string& to) override { return text_ != nullptr && text_->append_next(to); }

 private:
  std::shared_ptr<const void> permit_;
  std::unique_ptr<jobs::TrajectoryText> text_;
};

/// Fills in a body: at once if it is short, else as a stream.
void set_trajectory(const RequestContext& context, jobs::TrajectoryView view, TableFormat format,
                    Response& response) {
  constexpr std::size_t kMostAtOnce = 250'000;  // values; some 5 MB of text
  const bool is_short = view.samples() * view.channels().size() <= kMostAtOnce;
  auto permit = is_short ? nullptr : context.stream_limit.acquire();
  if (!is_short && !permit) {
    response = make_retry_later(503, "as many long trajectories are being sent as may; try again");
    return;
  }
  auto text = make_trajectory_text(std::move(view), format);
  if (!is_short) {
    response.stream = std::make_shared<TrajectoryBody>(std::move(text), std::move(permit));
    return;
  }
  while (text->append_next(response.body)) {
  }
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

Response delete_job(const RequestContext& context) {
  Query(context.request, {}).check();
  if (!context.service.delete_job(context.id)) throw no_such_job(context.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

Response get_trajectory(const RequestContext& context) {
  Query query(context.request, {"channels", "from", "to", "points", "format"});
  const TableFormat format = find_column_format(context.request, query);
  jobs::TrajectoryQuery wanted;
  wanted.channels = query.list("channels");
  wanted.from = query.number("from");
  wanted.to = query.number("to");
  wanted.points = query.count("points");
  Response response = make_table(format, "", "job-" + context.id);
  bool is_wanted = false;
  auto view = query.check_and([&] {
    return context.service.find_trajectory_view(context.id, wanted, [&](const std::string& fingerprint) {
      // Only what has ended has a trajectory.
      const std::string name = jobs::sha256_hex(response.content_type + "\n", fingerprint).substr(0, 32);
      response.headers.emplace_back("Cache-Control", "private, no-cache");
      response = with_etag(context.request, std::move(response), "\"" + name + "\"");
      return is_wanted = response.status == 200 && context.request.method != "HEAD";
    });
  });
  if (!view) {
    const auto job = context.service.find_job(context.id);
    if (!job) throw no_such_job(context.id);
    throw HttpError(404, "job " + context.id + " is " + job->at("state").template get<std::string>() +
                             " and has no trajectory");
  }
  if (is_wanted) set_trajectory(context, std::move(*view), format, response);
  else if (response.status == 200) response.stream = std::make_shared<TrajectoryBody>(nullptr, nullptr);
  return response;
}

Response get_parameters(const RequestContext& context) {
  Query(context.request, {}).check();
  return json_response(200, to_text(jobs::parameter_schema()));
}

}  // namespace server
