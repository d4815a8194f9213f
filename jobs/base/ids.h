// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

namespace jobs {

/// Makes opaque ids that sort by the time of their making: prefix, 10 characters of Unix time in ms, 16 of
/// chance, in Crockford's base 32 in lower case. Each is greater than the one before, whatever the clock
/// does. After one that was far ahead, ids count on from there until the clock is there again.
class IdMaker {
 public:
  /// Makes later ids greater than one of a former process. Does nothing with a text that is no id.
  void follow(std::string_view id);
  [[nodiscard]] std::string make(std::string_view prefix, std::int64_t now_unix_ms);

 private:
  /// Moves on to a later id, by chance in a new millisecond, else by counting. mutex_ is held.
  void advance(std::int64_t now_unix_ms);

  std::mutex mutex_;  // guards the rest
  std::int64_t last_ms_ = 0;
  std::uint64_t chance_high_ = 0;  ///< 40 bits
  std::uint64_t chance_low_ = 0;   ///< 40 bits
};

inline constexpr std::string_view kSweepPrefix = "swp_";
inline constexpr std::string_view kJobPrefix = "job_";
inline constexpr std::string_view kSearchPrefix = "sch_";
inline constexpr std::string_view kWearStudyPrefix = "wst_";
inline constexpr std::string_view kOptimisationPrefix = "opt_";
inline constexpr std::string_view kFitPrefix = "fit_";
inline constexpr std::string_view kMeasurementPrefix = "mea_";

/// @returns whether a text has the form of an id of that kind
[[nodiscard]] bool is_id(std::string_view text, std::string_view prefix);

}  // namespace jobs
