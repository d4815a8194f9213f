// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "jobs/parameters/range.h"
#include "server/messages/message.h"

namespace server {

/// The query string of one request, read key by key. Faults are collected, so that a user sees all of them at
/// once.
class Query {
 public:
  /// @param allowed  the keys that the route knows; any other is a fault that names them
  Query(const Request& request, std::initializer_list<std::string_view> allowed);

  /// Treatment of keys that are not among those allowed: they are faults, or the caller's to understand.
  enum class Others { kRefused, kKept };
  Query(const Request& request, std::initializer_list<std::string_view> allowed, Others others);

  /// The other keys with their values.
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& others() const { return others_; }

  /// The value of a key, if it stands in the query.
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;
  /// The same, split at its commas; empty if the key is missing. An empty item is no name: the service
  /// refuses it.
  [[nodiscard]] std::vector<std::string> list(std::string_view key) const;
  /// The same as it stands, for lists whose items may have commas; an empty text is a fault.
  [[nodiscard]] std::string names(std::string_view key);
  /// The same as an object in JSON, an empty one if the key is missing; anything else is a fault.
  [[nodiscard]] nlohmann::ordered_json object(std::string_view key);
  /// The same as a finite number; anything else is a fault.
  [[nodiscard]] std::optional<double> number(std::string_view key);
  /// The same as a number in a range; anything else is a fault.
  [[nodiscard]] std::optional<double> number_in(std::string_view key, const jobs::Range& range);
  /// The same as a count without sign; anything else is a fault.
  [[nodiscard]] std::optional<std::size_t> count(std::string_view key);
  [[nodiscard]] std::optional<std::size_t> count_in(std::string_view key, const jobs::Range& range);
  /// The same as one of the words given; anything else is a fault.
  [[nodiscard]] std::optional<std::string> word(std::string_view key,
                                                std::span<const std::string_view> words);

  /// @throws jobs::InvalidRequest with every fault met so far, if there is any. Call it once all keys are
  /// read.
  void check() const;

  /// Asks what the query is for, also if it has faults: the service finds more of them, and a user sees all
  /// at once.
  /// @returns what the service answers
  /// @throws jobs::InvalidRequest with the faults met so far and those that the service finds
  template <typename Ask>
  [[nodiscard]] auto check_and(const Ask& ask) {
    std::optional<decltype(ask())> answer;
    try {
      answer = ask();
    } catch (const jobs::InvalidRequest& invalid) {
      faults_.insert(faults_.end(), invalid.faults().begin(), invalid.faults().end());
    }
    check();
    return std::move(*answer);
  }

 private:
  void add_fault(std::string_view key, const std::string& detail);

  const Request& request_;
  std::vector<std::pair<std::string, std::string>> others_;
  std::vector<jobs::Fault> faults_;
};

}  // namespace server
