#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/expand.h"
#include "jobs/service.h"
#include "jobs/store.h"

namespace jobs {

/// What the results of a study ask for.
struct StudyStep {
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();  ///< to add to its sweep; none: wait for jobs that are under way
  std::optional<std::string> end_state;  ///< it has ended
  std::optional<std::string> error;      ///< why it could not go on
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
  /// Of a study under way.
  [[nodiscard]] virtual StudyStep find_step(const SearchRow& study, const SweepResults& results) const = 0;

  /// The resource as users see it. @param threads  how many jobs are computed at a time
  [[nodiscard]] virtual nlohmann::json make_resource(const SearchRow& study, const SweepResults& results, int threads) const = 0;
  /// What a listing has of it, which does not look at the jobs.
  [[nodiscard]] virtual nlohmann::json make_summary(const SearchRow& study) const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& listing_keys() const = 0;
  [[nodiscard]] virtual ResultTable make_table(const SearchRow& study, const SweepResults& results) const = 0;
};

/// Takes studies of one kind and keeps them going: whenever jobs have ended, those that their results ask for next are added to the sweep that the
/// study has. All members may be called from any thread.
class StudyDesk {
 public:
  /// @param options  of the service: how many jobs a study may have, how many may wait, how many are computed at a time
  StudyDesk(Store& store, const ServiceOptions& options, std::unique_ptr<StudyKind> kind)
      : store_(store), options_(options), kind_(std::move(kind)) {}

  /// @throws InvalidRequest, QueueFull
  nlohmann::json submit(const nlohmann::ordered_json& request);
  [[nodiscard]] std::optional<nlohmann::json> find(const std::string& id) const;
  [[nodiscard]] nlohmann::json list(const PageQuery& query) const;
  [[nodiscard]] std::optional<ResultTable> find_table(const std::string& id) const;

  /// Ends a study that is under way; `cancel_sweep` is called with its sweep then.
  /// @returns false if there is none  @throws WrongState if it has ended otherwise
  bool cancel(const std::string& id, const std::function<void(const std::string&)>& cancel_sweep);
  /// Lets a study that has ended go on; `retry_sweep` is called with its sweep. False if there is none.
  bool retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep);
  /// The sweep of a study that has ended. @throws WrongState if it has not
  [[nodiscard]] std::optional<std::string> find_ended_sweep(const std::string& id) const;

  /// Does what the results of all studies under way ask for. @returns whether jobs were added
  bool advance();

 private:
  [[nodiscard]] std::optional<SearchRow> find_row(const std::string& id) const;
  bool advance(const SearchRow& study);

  Store& store_;
  const ServiceOptions& options_;
  std::unique_ptr<StudyKind> kind_;
  std::mutex moving_;  ///< held by who changes a study, so that nothing is added to one that is being cancelled
};

}  // namespace jobs
