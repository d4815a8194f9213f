// SPDX-License-Identifier: Apache-2.0
#include "server/routes/events.h"

#include <charconv>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"

namespace server {

namespace {

constexpr std::string_view kDoneSuffix = "-done";

/// Last event that a client has received: number of its change, and whether `done` followed.
struct LastEvent {
  std::int64_t change = 0;
  bool done = false;
};

LastEvent read_last_event(std::string_view last_event_id) {
  LastEvent last;
  if (last_event_id.empty()) return last;
  last.done = last_event_id.ends_with(kDoneSuffix);
  if (last.done) last_event_id.remove_suffix(kDoneSuffix.size());
  const char* const end = last_event_id.data() + last_event_id.size();
  const auto [stop, error] = std::from_chars(last_event_id.data(), end, last.change);
  if (error != std::errc{} || stop != end || last.change < 0)
    throw HttpError(400, "Last-Event-ID must be the id of an event of this stream");
  return last;
}

std::string event_text(const char* name, const nlohmann::json& data, const std::string& id) {
  return (id.empty() ? "" : "id: " + id + "\n") + "event: " + name + "\ndata: " + to_text(data) + "\n\n";
}

/// Jobs that ended in one change share its number: only the last of them carries it as its id, so that a
/// client that resumes from it has received all of them.
std::string job_events_text(const std::vector<jobs::SweepNews::JobEvent>& events) {
  std::string text;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto& [change, job] = events[i];
    const bool last_of_change = i + 1 == events.size() || events[i + 1].change != change;
    text += event_text("job", job, last_of_change ? std::to_string(change) : "");
  }
  return text;
}

class Events final : public EventSource {
 public:
  /// @param first     news since `after`
  /// @param activity  the service's activity counter before they were found
  Events(const jobs::Service& service, FindNews find_news, std::int64_t after, jobs::SweepNews first,
         std::uint64_t activity)
      : service_(service),
        find_news_(std::move(find_news)),
        after_(after),
        first_(std::move(first)),
        seen_(activity) {}

  std::string next() override {
    if (first_) return text_of(*std::exchange(first_, std::nullopt));
    const std::uint64_t activity = service_.activity();
    if (seen_ == activity) return "";
    seen_ = activity;
    const auto news = find_news_(after_);
    if (!news) {  // the sweep or study has been deleted
      ended_ = true;
      return "";
    }
    return text_of(*news);
  }

  [[nodiscard]] bool has_ended() const override { return ended_; }

 private:
  std::string text_of(const jobs::SweepNews& news) {
    std::string text = job_events_text(news.jobs);
    if (!news.jobs.empty()) after_ = news.jobs.back().change;
    if (news.progress != progress_) text += event_text("progress", progress_ = news.progress, "");
    ended_ = news.ended;
    if (ended_) text += event_text("done", progress_, std::to_string(after_) + std::string(kDoneSuffix));
    return text;
  }

  const jobs::Service& service_;
  const FindNews find_news_;
  std::int64_t after_;
  std::optional<jobs::SweepNews> first_;  ///< not sent yet
  std::uint64_t seen_;                    ///< the service's activity counter before the last query
  nlohmann::json progress_;               ///< last progress sent
  bool ended_ = false;
};

}  // namespace

Response answer_events(const RequestContext& context, FindNews find_news, const HttpError& missing) {
  Query(context.request, {}).check();
  const LastEvent last = read_last_event(context.request.last_event_id);
  const std::uint64_t activity = context.service.activity();
  auto news = find_news(last.change);
  if (!news) throw missing;
  if (last.done && news->ended && news->jobs.empty())
    return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
  Response response{.status = 200,
                    .content_type = "text/event-stream",
                    .body = {},
                    .headers = {{"Cache-Control", "no-store"}}};
  response.events = std::make_shared<Events>(context.service, std::move(find_news), last.change,
                                             std::move(*news), activity);
  return response;
}

}  // namespace server
