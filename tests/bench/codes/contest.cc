// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/contest.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

#include "tests/bench/codes/rpsup_jobs.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/table.h"

namespace bench {

namespace {

constexpr double kOurAccuracy = 1e-3;

void run_once(Rival& rival) {
  rival.seconds.add(time_cpu([&rival] { rival.last = rival.run(); }));
}

/// The other codes' peaks are measured against this one, too.
engine::RunOptions tight(engine::RunOptions options) {
  options.integrator = engine::Integrator::kDopri5;
  options.relative_tolerance = 1e-8;
  options.absolute_tolerance = 1e-9;
  return options;
}

}  // namespace

Contest::Contest(std::string title, std::string method, engine::RpsupParameters parameters,
                 engine::RunOptions options, std::vector<Rival> rivals)
    : title_(std::move(title)),
      parameters_(std::move(parameters)),
      options_(options),
      rivals_(std::move(rivals)),
      ours_{"rpsup, " + method, kOurAccuracy, 1.0,
            [job = parameters_, options] { return run_rpsup(job, options); }} {}

void Contest::run(int repeats) {
  reference_ = run_rpsup(parameters_, tight(options_));
  for (int i = 0; i < repeats; ++i)
    for (Rival& rival : rivals_) {
      run_once(ours_);
      run_once(rival);
      run_once(ours_);
    }
}

bool Contest::is_fair() const {
  const auto holds = [this](const Rival& rival) {
    return std::abs(calc_error(rival.last)) <= rival.accuracy;
  };
  return holds(ours_) && std::all_of(rivals_.begin(), rivals_.end(), holds);
}

std::vector<std::string> Contest::make_row(const Rival& rival) const {
  const double ratio = rival.seconds.median() / ours_.seconds.median();
  const bool off = std::abs(calc_error(rival.last)) > rival.accuracy;
  const bool is_ours = &rival == &ours_;
  return {rival.name,
          digits(rival.seconds.least(), 3),
          digits(rival.seconds.median(), 3),
          std::to_string(rival.last.evaluations),
          digits(rival.last.peak, 6),
          digits(100.0 * calc_error(rival.last), 2) + (off ? " OFF" : ""),
          digits(100.0 * rival.accuracy, 2),
          digits(ratio, 3),
          is_ours ? "" : digits(rival.wanted_ratio, 3),
          is_ours ? "" : ratio >= rival.wanted_ratio ? "yes" : "no"};
}

void Contest::print(std::ostream& out) const {
  out << '\n'
      << title_ << ": peak slider acceleration of a tight run " << digits(reference_.peak, 6) << " m/s^2\n\n";
  Table table({"code", "CPU least [s]", "median [s]", "evaluations", "peak [m/s^2]", "error [%]",
               "allowed [%]", "ratio", "asked for", "met"});
  table.add(make_row(ours_));
  for (const Rival& rival : rivals_) table.add(make_row(rival));
  table.print(out);
}

}  // namespace bench
