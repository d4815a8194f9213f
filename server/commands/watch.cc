// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <optional>

#include "server/commands/command.h"
#include "server/commands/progress.h"
#include "server/commands/remote_commands.h"
#include "server/commands/signals.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr auto kBetweenLooks = 500ms;
constexpr auto kPatience = 30s;  // with a service that has answered before

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

/// Looks at one resource again and again.
class Watcher {
 public:
  Watcher(const RemoteOptions& remote, const std::string& id)
      : service_(remote),
        id_(id),
        view_(std::cerr, isatty(STDERR_FILENO) != 0 ? ProgressView::Form::kBar : ProgressView::Form::kLines) {
  }

  /// @returns the state that it ended in; empty if the user ended the watching
  std::optional<std::string> follow(const EndSignals& signals) {
    for (;;) {
      const auto seen = look();
      if (seen && has_ended(*seen)) return finish(seen->at("state").get<std::string>());
      if (signals.arrived(kBetweenLooks)) return finish(std::nullopt);
    }
  }

 private:
  /// Empty if the service did not answer, which it had done before.
  std::optional<Json> look() {
    try {
      auto [kind, resource] = service_.find(id_);
      view_.show(kind == RemoteService::Kind::kSweep ? resource : as_sweep(resource));
      lost_since_.reset();
      answered_ = true;
      return resource;
    } catch (const Unreachable& error) {
      tell_loss(error);
      return std::nullopt;
    }
  }

  void tell_loss(const Unreachable& error) {
    if (!answered_) throw error;
    if (!lost_since_) {
      lost_since_ = Clock::now();
      view_.finish();
      std::cerr << "rpsup: " << terminal_text(error.what()) << "; trying again for " << kPatience.count()
                << " s" << std::endl;
    }
    if (Clock::now() - *lost_since_ > kPatience) throw error;
  }

  std::optional<std::string> finish(std::optional<std::string> state) {
    view_.finish();
    return state;
  }

  RemoteService service_;
  std::string id_;
  ProgressView view_;
  bool answered_ = false;
  std::optional<Clock::time_point> lost_since_;
};

}  // namespace

int watch(const WatchOptions& options) {
  const EndSignals signals;
  const auto state = Watcher(options.remote, options.id).follow(signals);
  if (!state) {
    std::cerr << "rpsup: no longer watching; " << options.id << " goes on (rpsup cancel ends it)\n";
    return kInterrupted;
  }
  std::cerr << options.id << ' ' << terminal_text(*state) << '\n';
  return *state == "succeeded" ? kDone : kJobFailed;
}

}  // namespace server::commands
