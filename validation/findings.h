// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "validation/engine_names.h"

namespace validation {

/// One comparison of the engine with a result that it did not compute itself: a line of the report and an assertion of a test.
struct Check {
  std::string what{};                                          ///< what is compared, with its case
  std::string reference{};                                     ///< with what: a closed form, a published number, a second route
  double found = std::numeric_limits<double>::quiet_NaN();     ///< NaN where only the difference makes sense (of matrices, say)
  double expected = std::numeric_limits<double>::quiet_NaN();
  std::string unit{};                                          ///< of found, expected, difference and bound; "1" for ratios
  double difference = std::numeric_limits<double>::quiet_NaN();///< magnitude, in `unit`
  double bound = 0.0;                                          ///< largest difference allowed
  std::string why{};                                           ///< the bound is that

  /// Not-a-number holds nothing.
  [[nodiscard]] bool holds() const { return difference <= bound; }
};

/// A comparison of two numbers.
/// @param bound  largest |found - expected| allowed
[[nodiscard]] Check compare(std::string what, std::string reference, double found, double expected, double bound, std::string unit,
                            std::string why);

/// A difference that was computed elsewhere, of many numbers at once.
[[nodiscard]] Check limit(std::string what, std::string reference, double difference, double bound, std::string unit, std::string why);

/// Numbers that are shown beside each other; cells are text already.
struct Table {
  std::string caption{};
  std::vector<std::string> head{};
  std::vector<std::vector<std::string>> rows{};
  /// By how much a number may move on another machine. Below 1: relative to itself. From 1 on: a factor, for residuals of rounding
  /// (below 1e-6 all are alike) and for samples of chaotic cases.
  double reproducible_to = 1e-3;
  std::vector<double> row_reproducible_to{};  ///< where rows differ in this: one a row, in place of the above
};

struct Figure {
  std::string file;     ///< name of the SVG file, without folder
  std::string caption;
  std::string svg;
};

/// What a part of the validation has found.
struct Findings {
  std::vector<Check> checks{};
  std::vector<Table> tables{};
  std::vector<Figure> figures{};
};

/// Seconds of computing or minutes: a heavy part is left out where time is short.
enum class Cost { kLight, kHeavy };

/// A part of a chapter: computed on its own, from nothing.
struct Part {
  std::string name;          ///< lower_snake_case, one of a kind in the report; the name of its test as well
  Findings (*compute)();
  Cost cost = Cost::kLight;
};

struct Chapter {
  std::string title;
  std::string text;          ///< Markdown between the title and the lines
  std::vector<Part> parts;
};

}  // namespace validation
