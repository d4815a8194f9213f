// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace jobs {

/// A page of a listing.
struct PageQuery {
  static constexpr std::size_t kLargestLimit = 10'000;

  std::string state;            ///< only these; empty: all
  std::size_t limit = 50;       ///< 1 .. kLargestLimit
  std::string cursor;           ///< next_cursor of the page before; empty: the newest
  std::string fields{};         ///< keys of the items, with commas between; empty: all
};

}  // namespace jobs
