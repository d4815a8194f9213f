// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/remote_commands.h"
#include "server/commands/signals.h"
#include "server/messages/json_text.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr auto kBetweenLooks = 500ms;
constexpr auto kBetweenStudies = 1s;  // answers of studies may be long
constexpr auto kPatience = 2min;      // a service that starts reads its store first

bool has_ended(const Json& resource) {
  const Json& state = resource.at("state");
  return state != "queued" && state != "running";
}

/// A job as a sweep that has this one.
Json as_sweep(const Json& job) {
  Json counts = {{"queued", 0}, {"running", 0},   {"succeeded", 0},
                 {"failed", 0}, {"cancelled", 0}, {"total", 1}};
  counts[job.at("state").get<std::string>()] = 1;
  return {{"counts", counts}, {"progress", has_ended(job) ? 1.0 : 0.0}, {"eta_s", nullptr}};
}

/// "job_...  clearance_mm 0.25, coupler rigid", of a row of results.
std::string describe_running(const Json& row) {
  std::string text;
  for (const auto& [column, value] : row.items()) {
    const std::string shown = terminal_text(value.is_string() ? value.get<std::string>() : value.dump());
    if (column == "job_id") text = shown + " ";
    else text.append(text.ends_with(' ') ? " " : ", ").append(terminal_text(column) + " " + shown);
  }
  return text;
}

/// The running jobs of a sweep, with the parameters that it varies.
std::vector<std::string> list_running(RemoteService& service, const Json& sweep) {
  constexpr const char* kMost = "10";
  if (sweep.at("counts").at("running") == 0) return {};
  std::string fields = "job_id";
  for (const Json& axis : sweep.at("axes")) fields += "," + axis.get<std::string>();
  const auto rows =
      parse_json(service.get_part(Kind::kSweep, sweep.at("id").get<std::string>(), "results", kJsonType,
                                  {{"state", "running"}, {"fields", fields}, {"limit", kMost}}));
  std::vector<std::string> lines;
  for (const Json& row : rows) lines.push_back(describe_running(row));
  return lines;
}

/// Patience with a service that has answered before.
class Patience {
 public:
  /// Tells of the first failure in a row. @throws error if the first was too long ago
  void bear(const Unreachable& error) {
    if (!lost_since_) {
      lost_since_ = Clock::now();
      std::cerr << "rpsup: " << terminal_text(error.what()) << "; trying again for " << kPatience / 1s << " s"
                << std::endl;
    }
    if (Clock::now() - *lost_since_ > kPatience) throw error;
  }
  void renew() { lost_since_.reset(); }

 private:
  std::optional<Clock::time_point> lost_since_;
};

/// Looks at one resource again and again.
class Watcher {
 public:
  Watcher(RemoteService& service, Kind kind, const std::string& id)
      : service_(service), kind_(kind), id_(id), view_(ProgressView::on_standard_error()) {}

  /// @returns the resource that has ended; empty if the user ended the watching
  std::optional<Json> follow(const EndSignals& signals) {
    const bool is_study = kind_ != Kind::kSweep && kind_ != Kind::kJob;
    for (;;) {
      auto seen = look();
      if (seen && has_ended(*seen)) return finish(std::move(seen));
      if (signals.arrived(is_study ? kBetweenStudies : kBetweenLooks)) return finish(std::nullopt);
    }
  }

 private:
  /// Empty if the service did not answer, which it had done before.
  std::optional<Json> look() {
    try {
      Json resource = service_.find(kind_, id_);
      show(resource);
      patience_.renew();
      answered_ = true;
      return resource;
    } catch (const Busy& error) {
      view_.finish();
      patience_.bear(error);
    } catch (const Unreachable& error) {
      if (!answered_) throw;
      view_.finish();
      patience_.bear(error);
    }
    return std::nullopt;
  }

  void show(const Json& resource) {
    if (kind_ == Kind::kJob) return view_.show(as_sweep(resource));
    const Json sweep = kind_ == Kind::kSweep
                           ? resource
                           : service_.find(Kind::kSweep, resource.at("sweep_id").get<std::string>());
    if (view_.form() == ProgressView::Form::kBar) update_running(sweep);
    view_.show(sweep, running_);
  }

  /// Lists the running jobs anew, unless it took so long last time that it would be a burden to the service.
  void update_running(const Json& sweep) {
    constexpr int kPauses = 20;  // as long as the list takes
    const auto begin = Clock::now();
    if (begin < list_again_ && sweep.at("counts").at("running") != 0) return;
    try {
      running_ = list_running(service_, sweep);
    } catch (const Busy&) {
      // The last list stays: it is no more than a sight.
    }
    list_again_ = Clock::now() + kPauses * (Clock::now() - begin);
  }

  std::optional<Json> finish(std::optional<Json> resource) {
    view_.finish();
    return resource;
  }

  RemoteService& service_;
  Kind kind_;
  std::string id_;
  ProgressView view_;
  std::vector<std::string> running_;  ///< a line for each running job
  Clock::time_point list_again_;      ///< from then on
  bool answered_ = false;
  Patience patience_;
};

}  // namespace

std::optional<Json> follow(RemoteService& service, Kind kind, const std::string& id) {
  const EndSignals signals;
  auto ended = Watcher(service, kind, id).follow(signals);
  if (ended) std::cerr << id << ' ' << terminal_text(ended->at("state").get<std::string>()) << '\n';
  else std::cerr << "rpsup: no longer watching; " << id << " goes on (rpsup cancel ends it)\n";
  return ended;
}

std::string fetch_part(RemoteService& service, Kind kind, const std::string& id, std::string_view part,
                       const std::string& media_type) {
  Patience patience;
  for (;;) {
    try {
      return service.get_part(kind, id, part, media_type);
    } catch (const Unreachable& error) {
      patience.bear(error);
    }
    std::this_thread::sleep_for(kBetweenStudies);
  }
}

int watch(const WatchOptions& options) {
  const Kind kind = checked_kind("watch", options.id);
  RemoteService service(options.remote);
  const auto ended = follow(service, kind, options.id);
  if (!ended) return kInterrupted;
  return ended->at("state") == "succeeded" ? kDone : kJobFailed;
}

}  // namespace server::commands
