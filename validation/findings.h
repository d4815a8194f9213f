// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "validation/engine_names.h"

namespace validation {

/// Comparison of a result of the engine with one that the engine did not compute: a row of rows.csv and an
/// assertion of a test.
struct Check {
  /// Quantity that is compared, with its case.
  std::string what{};
  /// Source of the expected value: a closed form, a published number, a second route.
  std::string reference{};
  /// Value of the engine; NaN where only the difference makes sense (of matrices, say).
  double found = std::numeric_limits<double>::quiet_NaN();
  double expected = std::numeric_limits<double>::quiet_NaN();
  /// Unit of found, expected, difference and bound; "1" for ratios.
  std::string unit{};
  /// Magnitude, in `unit`.
  double difference = std::numeric_limits<double>::quiet_NaN();
  /// Largest difference allowed.
  double bound = 0.0;
  /// Reason for the bound.
  std::string why{};

  /// NaN holds no bound.
  [[nodiscard]] bool holds() const { return difference <= bound; }
};

/// Comparison of two numbers.
/// @param bound  largest |found - expected| allowed
[[nodiscard]] Check compare(std::string what, std::string reference, double found, double expected,
                            double bound, std::string unit, std::string why);

/// Comparison whose difference was computed elsewhere, of many numbers at once.
[[nodiscard]] Check limit(std::string what, std::string reference, double difference, double bound,
                          std::string unit, std::string why);

/// Place of a table or a figure.
enum class Place {
  kBeside,    ///< the table in rows.csv, the figure behind a link of the report
  kInReport,  ///< in the report as well
};

/// Numbers to be read beside each other; cells are text already.
struct Table {
  std::string caption{};
  std::vector<std::string> head{};
  std::vector<std::vector<std::string>> rows{};
  /// Share or factor by which a number may move on another machine. Below 1: a share of itself. From 1 on: a
  /// factor, for residuals of rounding (below 1e-6 all are alike) and for samples of chaotic cases.
  double reproducible_to = 1e-3;
  std::vector<double> row_reproducible_to{};  ///< one per row, in place of the above; empty: rows are alike
  std::size_t keys = 1;                       ///< leading columns that name the case of a row
  Place place = Place::kBeside;
};

struct Figure {
  std::string file;     ///< name of the SVG file, without folder
  std::string caption;
  std::string svg;
  Place place = Place::kBeside;
};

/// Findings of a part of the validation.
struct Findings {
  std::vector<Check> checks{};
  std::vector<Table> tables{};
  std::vector<Figure> figures{};
};

/// Cost of a part: heavy ones take seconds or minutes, and are left out where time is short.
enum class Cost { kLight, kHeavy };

/// Part of a chapter: computed on its own, from nothing.
struct Part {
  std::string name;          ///< lower_snake_case, unique; section of rows.csv and name of a test
  Findings (*compute)();
  Cost cost = Cost::kLight;
};

struct Chapter {
  std::string name{};        ///< lower_snake_case, the chapter's folder or file; first column of rows.csv
  std::string title;
  std::string text;          ///< Markdown below the title
  std::vector<Part> parts;
};

}  // namespace validation
