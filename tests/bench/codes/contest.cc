// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/contest.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/table.h"

namespace bench {

namespace {

void run_once(Competitor& competitor) {
  const std::function<CodeRun()> run = competitor.prepare();
  competitor.seconds.add(time_cpu([&] { competitor.last = run(); }));
}

}  // namespace

Contest::Contest(std::string title, std::string measured, std::function<CodeRun()> reference, Competitor ours,
                 std::vector<Competitor> rivals)
    : title_(std::move(title)),
      measured_(std::move(measured)),
      run_reference_(std::move(reference)),
      ours_(std::move(ours)),
      rivals_(std::move(rivals)) {}

void Contest::run(int repeats) {
  reference_ = run_reference_();
  for (int i = 0; i < repeats; ++i)
    for (Competitor& rival : rivals_) {
      run_once(ours_);
      run_once(rival);
    }
}

bool Contest::is_fair() const {
  const auto holds = [this](const Competitor& competitor) {
    return std::abs(calc_error(competitor.last)) <= competitor.accuracy;
  };
  return holds(ours_) && std::all_of(rivals_.begin(), rivals_.end(), holds);
}

std::vector<std::string> Contest::make_row(const Competitor& competitor) const {
  const double ratio = competitor.seconds.median() / ours_.seconds.median();
  const bool off = std::abs(calc_error(competitor.last)) > competitor.accuracy;
  const std::optional<double>& wanted = competitor.wanted_ratio;
  return {competitor.name,
          digits(competitor.seconds.median(), 3),
          std::to_string(competitor.last.evaluations),
          digits(competitor.last.peak, 6),
          digits(100.0 * calc_error(competitor.last), 2) + (off ? " OFF" : ""),
          digits(100.0 * competitor.accuracy, 2),
          digits(ratio, 3),
          wanted ? digits(*wanted, 3) : "",
          !wanted            ? ""
          : ratio >= *wanted ? "yes"
                             : "no"};
}

void Contest::print(std::ostream& out) const {
  out << '\n'
      << title_ << ": peak " << measured_ << " of a tight run " << digits(reference_.peak, 6) << "\n\n";
  Table table({"code", "CPU median [s]", "evaluations", "peak", "error [%]", "allowed [%]",
               "ratio", "asked for", "met"});
  table.add(make_row(ours_));
  for (const Competitor& rival : rivals_) table.add(make_row(rival));
  table.print(out);
}

}  // namespace bench
