// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

namespace jobs {

/// Size of a described linkage, which decides what its jobs cost.
struct LinkageSize {
  std::size_t coordinates = 0;  ///< of the joints that carry bodies, and between the elements of beams
  std::size_t freedoms = 0;     ///< those of the joints alone
  std::size_t constraints = 0;  ///< by the joints that close loops or have clearance
};

/// @param description  value of the key "linkage", of the right types
/// @param elements     rigid elements of a beam that does not say how many
[[nodiscard]] LinkageSize size_of_linkage(const nlohmann::json& description, std::size_t elements);

/// Fault of a linkage that is too large for a job; empty if it is not. Memory and time of a step grow with
/// the square of the coordinates and more.
[[nodiscard]] std::string describe_size_fault(const LinkageSize& size);

/// Time to see whether the loops of a linkage close, in times of one with few bodies.
[[nodiscard]] double calc_closing_work(const LinkageSize& size);

}  // namespace jobs
