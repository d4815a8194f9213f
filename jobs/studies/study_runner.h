// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
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
#include "jobs/store/idempotency_record.h"
#include "jobs/store/rows.h"

namespace jobs {

class Store;

/// Answer of a study to ask(): the cases to compute next, or the end.
struct NextCases {
  nlohmann::ordered_json cases =
      nlohmann::ordered_json::array();   ///< for its sweep; none: wait for running jobs
  std::optional<std::string> end_state;  ///< the study has ended
  std::optional<std::string> error;      ///< fault that stopped the study
};

/// Sampler of a running study, with the ask-and-tell interface of adaptive sampling (Optuna's Study.ask and
/// Study.tell, Optimizer.ask and Optimizer.tell of scikit-optimize and Nevergrad): tell() takes the result of
/// a job, ask() gives the cases to compute next. The cost of both does not depend on the number of earlier
/// jobs.
class StudySampler {
 public:
  virtual ~StudySampler() = default;

  /// Takes a job that has ended since the sampler was made, or since ask() asked for it.
  virtual void tell(const ResultRow& ended) = 0;
  /// The caller adds the cases to the sweep.
  [[nodiscard]] virtual NextCases ask() = 0;
  [[nodiscard]] virtual double progress() const = 0;  ///< 0 .. 1
};

/// Outcome of StudyRunner::advance().
struct StudyChanges {
  bool any = false;    ///< a study has a new result or a new state
  bool added = false;  ///< jobs were added
  std::exception_ptr failure{};  ///< of the first study that could not go on yet; it is asked again

  void add(const StudyChanges& more) {
    any |= more.any;
    added |= more.added;
    if (!failure) failure = more.failure;
  }
};

/// Sweep with which a study begins.
struct FirstSweep {
  nlohmann::ordered_json request;
  SweepPlan plan;
  std::vector<std::string> measurements{};  ///< ids of those in the study's request, in their order
};

/// Interface of one kind of study. A study is a sweep to which cases are added as its results ask for them.
/// The sweep is all that is stored, so a study goes on after a crash.
class StudyType {
 public:
  virtual ~StudyType() = default;

  [[nodiscard]] virtual std::string_view id_prefix() const = 0;
  /// @throws InvalidRequest with every fault
  [[nodiscard]] virtual FirstSweep plan_first(const nlohmann::ordered_json& request,
                                              std::size_t max_jobs) const = 0;
  [[nodiscard]] virtual std::unique_ptr<StudySampler> make_sampler(const StudyRow& study,
                                                                   const SweepResults& results) const = 0;

  /// Resource as users see it. @param threads  how many jobs are computed at a time
  [[nodiscard]] virtual nlohmann::json make_resource(const StudyRow& study, const SweepResults& results,
                                                     int threads) const = 0;
  /// Entry of a listing; made without a look at the jobs.
  [[nodiscard]] virtual nlohmann::json make_summary(const StudyRow& study) const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& listing_keys() const = 0;
  [[nodiscard]] virtual ResultTable make_table(const StudyRow& study, const SweepResults& results) const = 0;
  /// Measured signals beside those of the jobs; empty for studies without them.
  [[nodiscard]] virtual std::optional<ResultTable> make_signal_table(const StudyRow& /*study*/,
                                                                     const SweepResults& /*results*/) const {
    return std::nullopt;
  }
};

/// Limits on the jobs of studies.
struct StudyLimits {
  std::size_t max_sweep_jobs;   ///< of one study
  std::size_t max_queued_jobs;  ///< that may wait, of all that the service has
  int threads;                  ///< jobs computed at a time
};

/// Runner of all studies of one kind: stores them, and adds the jobs that their results ask for. All members
/// may be called from any thread.
class StudyRunner {
 public:
  StudyRunner(Store& store, const StudyLimits& limits, std::unique_ptr<StudyType> type)
      : store_(store), limits_(limits), type_(std::move(type)) {}

  /// @param idempotency  without a key, the response is not stored
  /// @throws InvalidRequest, QueueFull
  nlohmann::json submit(const nlohmann::ordered_json& request, const IdempotentRequest& idempotency);
  [[nodiscard]] std::optional<nlohmann::json> find(const std::string& id) const;
  [[nodiscard]] std::optional<StudyRow> find_row(const std::string& id) const;
  [[nodiscard]] nlohmann::json list(const PageQuery& query) const;
  [[nodiscard]] std::optional<ResultTable> find_table(const std::string& id) const;
  /// See StudyType::make_signal_table().
  [[nodiscard]] std::optional<ResultTable> find_signal_table(const std::string& id) const;

  /// Ends a study that runs; calls `cancel_study`, which cancels it with its jobs in the store.
  /// @returns false if there is no such study  @throws WrongState if it has ended otherwise
  bool cancel(const std::string& id, const std::function<void()>& cancel_study);
  /// Restarts a study that has ended; calls `retry_sweep`, which queues its failed and cancelled jobs again,
  /// with the id of its sweep. One that runs reads all its jobs again. False if there is no such study.
  bool retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep);
  /// Sweep of a study that has ended. @throws WrongState if it has not
  [[nodiscard]] std::optional<std::string> find_ended_sweep(const std::string& id) const;

  /// Calls `change`, which changes the jobs of a sweep otherwise than by computing them. A study of the sweep
  /// reads all its jobs again.
  void change_sweep(const std::string& sweep_id, const std::function<void()>& change);

  /// Tells all running studies their new results, and adds the jobs that they ask for. A study that fails
  /// keeps no other one from going on.
  StudyChanges advance();
  /// Progress of a running study at the last advance(), 0 .. 1.
  [[nodiscard]] double find_progress(const std::string& id) const;

 private:
  /// A running study and the jobs that it was told of.
  struct ActiveStudy {
    std::string sweep_id;
    nlohmann::ordered_json common;  ///< the sweep's request without its cases
    std::int64_t change = 0;        ///< ResultRow::change of the last job that was told
    std::unique_ptr<StudySampler> sampler;
  };

  void forget_ended(const std::vector<StudyRow>& running);
  /// Lets one study go on as far as it can.
  StudyChanges advance_fully(const StudyRow& study);
  StudyChanges advance(const StudyRow& study);
  /// Makes the sampler of a study from its sweep. False if the sweep has been deleted.
  bool activate(const StudyRow& study);
  /// Tells the sampler the jobs that have ended since it was told last. False if there are none.
  bool tell_ended_jobs(ActiveStudy& study);
  StudyChanges add_next_cases(const StudyRow& study);
  void set_progress(const std::string& id, double progress);
  /// Response to the request for a study, as it begins: results that are known already have not been told.
  [[nodiscard]] nlohmann::json make_response(StudySnapshot begun) const;

  Store& store_;
  const StudyLimits limits_;
  std::unique_ptr<StudyType> type_;
  std::mutex mutex_;  ///< held while a study changes, so that no job is added to one that is being cancelled
  std::map<std::string, ActiveStudy> active_;  ///< by id; guarded by mutex_
  std::atomic<std::uint64_t> wakeups_ = 1;     ///< counts the studies that begin or go on
  std::uint64_t idle_wakeups_ = 0;             ///< wakeups_ when no study ran; guarded by mutex_
  mutable std::mutex progress_mutex_;
  std::map<std::string, double> progress_;  ///< by id; guarded by progress_mutex_
};

}  // namespace jobs
