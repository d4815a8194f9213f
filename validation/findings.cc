// SPDX-License-Identifier: Apache-2.0
#include "validation/findings.h"

#include <cmath>
#include <utility>

namespace validation {

Check compare(std::string what, std::string reference, double found, double expected, double bound,
              std::string unit, std::string why) {
  return {.what = std::move(what),
          .reference = std::move(reference),
          .found = found,
          .expected = expected,
          .unit = std::move(unit),
          .difference = std::abs(found - expected),
          .bound = bound,
          .why = std::move(why)};
}

Check limit(std::string what, std::string reference, double difference, double bound, std::string unit,
            std::string why) {
  Check check;
  check.what = std::move(what);
  check.reference = std::move(reference);
  check.unit = std::move(unit);
  check.difference = std::abs(difference);
  check.bound = bound;
  check.why = std::move(why);
  return check;
}

}  // namespace validation
