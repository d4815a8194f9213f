// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/requests/expand.h"
#include "jobs/results/page.h"
#include "jobs/results/result_table.h"
#include "jobs/store/store.h"

namespace jobs {

/// What the results of a study ask for.
struct StudyStep {
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();  ///< to add to its sweep; none: wait for jobs that are under way
  std::optional<std::string> end_state;  ///< it has ended
  std::optional<std::string> error;      ///< why it could not go on
};

/// What the jobs of a study under way have shown so far. Taking what is new costs the same however many there were before.
class StudyCourse {
 public:
  virtual ~StudyCourse() = default;

  /// Takes a job that has ended since the course was made, or since it was asked for by find_step().
  virtual void take(const ResultRow& ended) = 0;
  /// What is wanted now; the cases of a step are then added to the sweep.
  [[nodiscard]] virtual StudyStep find_step() = 0;
  [[nodiscard]] virtual double progress() const = 0;  ///< 0 .. 1
};

/// What has come of looking at studies.
struct StudyMoves {
  bool any = false;    ///< something is known that was not before
  bool added = false;  ///< jobs were added
};

/// Under which key the answer to a request is kept, and what it was.
struct KeptText {
  std::string key, request;  ///< as in KeptAnswer
  std::string* answer = nullptr;
};

/// A sweep with which a study begins.
struct FirstSweep {
  nlohmann::ordered_json request;
  SweepPlan plan;
};

/// What tells one kind of study from another. A study is a sweep to which cases are added as its results ask for them; it keeps nothing
/// beside them, and so goes on after a crash where it was.
class StudyKind {
 public:
  virtual ~StudyKind() = default;

  [[nodiscard]] virtual std::string_view id_prefix() const = 0;
  /// @throws InvalidRequest with every fault
  [[nodiscard]] virtual FirstSweep plan_first(const nlohmann::ordered_json& request, std::size_t max_jobs) const = 0;
  [[nodiscard]] virtual std::unique_ptr<StudyCourse> make_course(const SearchRow& study, const SweepResults& results) const = 0;

  /// The resource as users see it. @param threads  how many jobs are computed at a time
  [[nodiscard]] virtual nlohmann::json make_resource(const SearchRow& study, const SweepResults& results, int threads) const = 0;
  /// What a listing has of it, which does not look at the jobs.
  [[nodiscard]] virtual nlohmann::json make_summary(const SearchRow& study) const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& listing_keys() const = 0;
  [[nodiscard]] virtual ResultTable make_table(const SearchRow& study, const SweepResults& results) const = 0;
};

/// How much of a service studies may take.
struct StudyRoom {
  std::size_t max_sweep_jobs;   ///< of one study
  std::size_t max_queued_jobs;  ///< that may wait, of all that the service has
  int threads;                  ///< jobs computed at a time
};

/// Takes studies of one kind and keeps them going: whenever jobs have ended, those that their results ask for next are added to the sweep that the
/// study has. All members may be called from any thread.
class StudyDesk {
 public:
  StudyDesk(Store& store, const StudyRoom& room, std::unique_ptr<StudyKind> kind) : store_(store), room_(room), kind_(std::move(kind)) {}

  /// @param kept  how the answer is kept; without a key it is not
  /// @throws InvalidRequest, QueueFull
  nlohmann::json submit(const nlohmann::ordered_json& request, const KeptText& kept);
  [[nodiscard]] std::optional<nlohmann::json> find(const std::string& id) const;
  [[nodiscard]] std::optional<SearchRow> find_row(const std::string& id) const;
  [[nodiscard]] nlohmann::json list(const PageQuery& query) const;
  [[nodiscard]] std::optional<ResultTable> find_table(const std::string& id) const;

  /// Ends a study that is under way; `cancel_sweep` is called with its sweep then.
  /// @returns false if there is none  @throws WrongState if it has ended otherwise
  bool cancel(const std::string& id, const std::function<void(const std::string&)>& cancel_sweep);
  /// Lets a study that has ended go on: `retry_sweep` is called with its sweep, and does so. False if there is none.
  bool retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep);
  /// The sweep of a study that has ended. @throws WrongState if it has not
  [[nodiscard]] std::optional<std::string> find_ended_sweep(const std::string& id) const;

  /// Changes the jobs of a sweep otherwise than by computing them; a study of it sees them anew then.
  void change_sweep(const std::string& sweep_id, const std::function<void()>& change);

  /// Does what the results of all studies under way ask for.
  StudyMoves advance();
  /// How far a study under way is, 0 .. 1, as it was last seen.
  [[nodiscard]] double find_progress(const std::string& id) const;

 private:
  /// A study under way, as far as its jobs have been looked at.
  struct UnderWay {
    std::string sweep_id;
    nlohmann::ordered_json common;  ///< the sweep's request without its cases
    std::int64_t change = 0;        ///< the last end of a job that was taken
    std::unique_ptr<StudyCourse> course;
  };

  /// What is known of studies that have ended is forgotten.
  void forget_ended(const std::vector<SearchRow>& running);
  StudyMoves advance(const SearchRow& study);
  /// Takes the jobs that have ended since. False if there are none.
  bool look_at(const SearchRow& study);
  StudyMoves take_step(const SearchRow& study);

  Store& store_;
  const StudyRoom room_;
  std::unique_ptr<StudyKind> kind_;
  std::mutex moving_;  ///< held by who changes a study, so that nothing is added to one that is being cancelled
  std::map<std::string, UnderWay> under_way_;  ///< by id; guarded by moving_
  std::atomic<std::uint64_t> begun_ = 1;       ///< how often a study has begun or gone on
  std::uint64_t idle_since_ = 0;               ///< begun_ when none was under way; guarded by moving_
  mutable std::mutex progress_mutex_;
  std::map<std::string, double> progress_;     ///< by id; guarded by progress_mutex_
};

}  // namespace jobs
