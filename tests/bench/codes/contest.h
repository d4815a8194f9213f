// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "engine/simulate_rpsup.h"
#include "tests/bench/codes/code_run.h"
#include "tests/bench/support/samples.h"

namespace bench {

/// Another code with one method of its own.
struct Rival {
  std::string name;
  double accuracy;        ///< how far its peak may be off: beyond, it computes another physics; relative
  double wanted_ratio;    ///< its time over ours that is asked for
  std::function<CodeRun()> run;
  Samples seconds{};
  CodeRun last{};
};

/// One job in our code and in others, by turns.
class Contest {
 public:
  /// @param method  what our options stand for
  Contest(std::string title, std::string method, engine::RpsupParameters parameters,
          engine::RunOptions options, std::vector<Rival> rivals);

  void run(int repeats);
  void print(std::ostream& out) const;
  /// True if every code's peak is that of the tight reference, within its accuracy.
  [[nodiscard]] bool is_fair() const;

  [[nodiscard]] const std::vector<Rival>& rivals() const { return rivals_; }

 private:
  void run_ours();
  [[nodiscard]] double calc_error(const CodeRun& run) const { return run.peak / reference_.peak - 1.0; }
  [[nodiscard]] std::vector<std::string> make_row(const Rival& rival) const;

  std::string title_;
  engine::RpsupParameters parameters_;
  engine::RunOptions options_;
  std::vector<Rival> rivals_;
  Rival ours_;
  CodeRun reference_;
};

}  // namespace bench
