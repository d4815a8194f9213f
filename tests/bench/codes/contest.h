// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/codes/code_run.h"
#include "tests/bench/support/samples.h"

namespace bench {

/// A code with one of its methods.
struct Competitor {
  std::string name;
  double accuracy;        ///< how far its peak may be off: beyond, it computes another physics; relative
  std::optional<double> wanted_ratio;  ///< its time over ours that is asked for
  std::function<std::function<CodeRun()>()> prepare;  ///< makes the model, and then a run of it
  Samples seconds{};
  CodeRun last{};
};

/// One job in our code and in others, by turns.
class Contest {
 public:
  /// @param measured   whose peaks are compared, with its unit
  /// @param reference  our code at a tight tolerance
  Contest(std::string title, std::string measured, std::function<CodeRun()> reference, Competitor ours,
          std::vector<Competitor> rivals);

  void run(int repeats);
  void print(std::ostream& out) const;
  /// True if every code's peak is that of the tight reference, within its accuracy.
  [[nodiscard]] bool is_fair() const;

 private:
  [[nodiscard]] double calc_error(const CodeRun& run) const { return run.peak / reference_.peak - 1.0; }
  [[nodiscard]] std::vector<std::string> make_row(const Competitor& competitor) const;

  std::string title_, measured_;
  std::function<CodeRun()> run_reference_;
  Competitor ours_;
  std::vector<Competitor> rivals_;
  CodeRun reference_;
};

}  // namespace bench
