// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace engine {

/// A value from outside that the model cannot take: which field, what is allowed.
class InvalidInput : public std::runtime_error {
 public:
  InvalidInput(std::string field, std::string detail)
      : std::runtime_error(field + ": " + detail), field_(std::move(field)), detail_(std::move(detail)) {}

  [[nodiscard]] const std::string& field() const {
    return field_;
  }  ///< path of the field, e.g. "links.1,3.inertia"
  [[nodiscard]] const std::string& detail() const { return detail_; }  ///< fault, and the allowed values

 private:
  std::string field_;
  std::string detail_;
};

/// @param allowed  what follows "must be"  @throws InvalidInput if it does not hold
inline void require(bool holds, const std::string& field, const std::string& allowed) {
  if (!holds) throw InvalidInput(field, "must be " + allowed);
}

}  // namespace engine
