#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "jobs/service.h"
#include "jobs/store.h"

namespace jobs {

/// Takes searches and keeps them going: whenever jobs have ended, those that their results ask for next are added to the sweep that the
/// search has. All members may be called from any thread.
class SearchDesk {
 public:
  /// @param options  of the service: how many jobs a search may have, how many may wait, how many are computed at a time
  SearchDesk(Store& store, const ServiceOptions& options) : store_(store), options_(options) {}

  /// @throws InvalidRequest, QueueFull
  nlohmann::json submit(const nlohmann::ordered_json& request);
  [[nodiscard]] std::optional<nlohmann::json> find(const std::string& id) const;
  [[nodiscard]] nlohmann::json list(const PageQuery& query) const;
  [[nodiscard]] std::optional<ResultTable> find_limits(const std::string& id) const;

  /// Ends a search that is under way; `cancel_sweep` is called with its sweep then.
  /// @returns false if there is none  @throws WrongState if it has ended otherwise
  bool cancel(const std::string& id, const std::function<void(const std::string&)>& cancel_sweep);
  /// Lets a search that has ended go on; `retry_sweep` is called with its sweep. False if there is none.
  bool retry(const std::string& id, const std::function<void(const std::string&)>& retry_sweep);

  /// Does what the results of all searches under way ask for. @returns whether jobs were added
  bool advance();

 private:
  bool advance(const SearchRow& search);

  Store& store_;
  const ServiceOptions& options_;
  std::mutex moving_;  ///< held by who changes a search, so that nothing is added to one that is being cancelled
};

}  // namespace jobs
