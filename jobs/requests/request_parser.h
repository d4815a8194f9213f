// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/range.h"

namespace jobs {

/// Part of a request with these keys: the part that a study has in common with its sweep.
template <std::size_t n>
[[nodiscard]] nlohmann::ordered_json take_keys(const nlohmann::ordered_json& request,
                                               const std::array<std::string_view, n>& keys) {
  nlohmann::ordered_json part = nlohmann::ordered_json::object();
  for (const std::string_view key : keys)
    if (request.contains(key)) part[std::string(key)] = request.at(key);
  return part;
}

/// Base of the parsers of studies: gathers the faults of a request.
class RequestParser {
 protected:
  /// @throws InvalidRequest if the request is no object
  explicit RequestParser(const nlohmann::ordered_json& request) : request_(request) {
    if (!request.is_object()) throw InvalidRequest(std::vector<Fault>{{"", "must be an object"}});
  }

  void fault(std::string pointer, std::string detail) {
    faults_.push_back({std::move(pointer), std::move(detail)});
  }

  /// Adds a fault unless the text is empty. @returns whether it is
  bool is_right(const std::string& pointer, std::string detail) {
    const bool right = detail.empty();
    if (!right) fault(pointer, std::move(detail));
    return right;
  }

  void add_faults(const InvalidRequest& invalid) {
    faults_.insert(faults_.end(), invalid.faults().begin(), invalid.faults().end());
  }

  void throw_if_faulty() {
    if (!faults_.empty()) throw InvalidRequest(std::move(faults_));
  }

  template <std::size_t n>
  void check_keys_of(const nlohmann::json& given, const std::string& pointer,
                     const std::array<std::string_view, n>& keys) {
    for (const auto& [key, value] : given.items()) {
      if (std::ranges::find(keys, key) == keys.end())
        fault(pointer + pointer_token(key), describe_unknown_key(key, keys));
    }
  }

  std::uint64_t read_integer(const char* key, const Range& range, std::uint64_t otherwise) {
    if (!request_.contains(key)) return otherwise;
    const nlohmann::json given = request_.at(key);
    return is_right(std::string("/") + key, describe_integer_fault(range, given)) ? given.get<std::uint64_t>()
                                                                                  : otherwise;
  }

  const nlohmann::ordered_json& request_;
  std::vector<Fault> faults_;
};

}  // namespace jobs
