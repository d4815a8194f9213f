// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace validation::program {

struct ValidateOptions {
  std::string report;     ///< Markdown file to write, with rows.csv and the figures beside it; empty: none
  std::string check;      ///< report whose lines and rows.csv must agree with this run; empty: none
  std::string store;      ///< SQLite file that keeps the study's jobs; empty: a temporary one
  int threads = 2;
  bool quick = false;     ///< without the study and whatever else takes long
};

/// Compares the engine with results that it did not compute, one line each on standard output.
/// @returns an exit code: kJobFailed if a comparison is outside its bound or the report differs from this run
int validate(const ValidateOptions& options);

}  // namespace validation::program
