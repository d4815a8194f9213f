// SPDX-License-Identifier: Apache-2.0
#include "server/routes/trajectory_answer.h"

#include <memory>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/results/trajectory_table_text.h"
#include "jobs/trajectories/trajectory_text.h"
#include "server/messages/conditional.h"
#include "server/messages/error_answer.h"

namespace server {

namespace {

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

jobs::TrajectoryQuery read_trajectory_query(Query& query) {
  jobs::TrajectoryQuery wanted;
  wanted.channels = query.list("channels");
  wanted.from = query.number("from");
  wanted.to = query.number("to");
  wanted.points = query.count("points");
  return wanted;
}

std::optional<Response> answer_with_columns(const RequestContext& context, Query& query,
                                            const jobs::TrajectoryQuery& wanted, TableFormat format,
                                            const std::string& file_stem, const FindColumns& find) {
  Response response = make_table(format, "", file_stem);
  bool is_wanted = false;
  auto view = query.check_and([&] {
    return find(wanted, [&](const std::string& fingerprint) {
      // Only what has ended has columns.
      const std::string name = jobs::sha256_hex(response.content_type + "\n", fingerprint).substr(0, 32);
      response.headers.emplace_back("Cache-Control", "private, no-cache");
      response = with_etag(context.request, std::move(response), "\"" + name + "\"");
      return is_wanted = response.status == 200 && context.request.method != "HEAD";
    });
  });
  if (!view) return std::nullopt;
  if (is_wanted) set_trajectory(context, std::move(*view), format, response);
  else if (response.status == 200) response.stream = std::make_shared<TrajectoryBody>(nullptr, nullptr);
  return response;
}

}  // namespace server
