// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/ids.h"

#include <algorithm>
#include <cstddef>
#include <random>

namespace jobs {
namespace {

constexpr std::string_view kAlphabet = "0123456789abcdefghjkmnpqrstvwxyz";
constexpr std::size_t kPrefixLength = 4;
constexpr int kTimeLength = 10;
constexpr int kHalfChanceLength = 8;
constexpr std::uint64_t kHalfChanceMask = (std::uint64_t{1} << 40U) - 1;

void append_base32(std::uint64_t value, int length, std::string& text) {
  for (int digit = length - 1; digit >= 0; --digit)
    text += kAlphabet[(value >> (5U * static_cast<unsigned>(digit))) & 31U];
}

std::uint64_t draw_40_bits() {
  std::random_device device;
  return ((std::uint64_t{device()} << 32U) | device()) & kHalfChanceMask;
}

}  // namespace

void IdMaker::advance(std::int64_t now_unix_ms) {
  if (now_unix_ms > last_ms_) {
    last_ms_ = now_unix_ms;
    chance_high_ = draw_40_bits();
    chance_low_ = draw_40_bits();
  } else {
    // The same millisecond, or a clock that was set back: count on. A carry out of 80 bits would go into the
    // time.
    chance_low_ = (chance_low_ + 1) & kHalfChanceMask;
    if (chance_low_ == 0) chance_high_ = (chance_high_ + 1) & kHalfChanceMask;
    if (chance_low_ == 0 && chance_high_ == 0) ++last_ms_;
  }
}

void IdMaker::follow(std::string_view id) {
  if (!is_id(id, id.substr(0, kPrefixLength))) return;
  std::int64_t ms = 0;
  for (const char digit : id.substr(kPrefixLength, kTimeLength))
    ms = 32 * ms + static_cast<std::int64_t>(kAlphabet.find(digit));
  const std::lock_guard lock(mutex_);
  advance(ms + 1);
}

std::string IdMaker::make(std::string_view prefix, std::int64_t now_unix_ms) {
  const std::lock_guard lock(mutex_);
  advance(now_unix_ms);
  std::string id(prefix);
  append_base32(static_cast<std::uint64_t>(last_ms_), kTimeLength, id);
  append_base32(chance_high_, kHalfChanceLength, id);
  append_base32(chance_low_, kHalfChanceLength, id);
  return id;
}

bool is_id(std::string_view text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return text.size() == kTimeLength + 2 * kHalfChanceLength &&
         std::ranges::all_of(text, [](char c) { return kAlphabet.find(c) != std::string_view::npos; });
}

}  // namespace jobs
