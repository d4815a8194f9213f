// SPDX-License-Identifier: Apache-2.0
#include "jobs/motion/lyapunov.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <boost/math/distributions/students_t.hpp>

#include "jobs/base/errors.h"
#include "jobs/results/table_groups.h"
#include "jobs/statistics/replicate_statistics.h"

namespace jobs {
namespace {

using nlohmann::json;

// Distances, of the motion's size
constexpr double kFloor = 1e-6, kLost = 1e-7, kCeiling = 0.1, kLeast = 1e-12;
constexpr double kTransient = 0.05, kDelay = 0.01;  // of the run
constexpr double kLatest = 0.75;                    // of what is measured: begin of a stretch
constexpr double kLeastAge = 0.1;                   // of the stretch, for ln(to / from)
constexpr std::size_t kPointsOfDelay = 5;           // curves are sampled so often in it
constexpr std::size_t kBlocks = 20, kSpan = 5;

/// Root mean square deviation from the mean, of all coordinates together.
double size_of(const Orbit& run, std::size_t begin, std::size_t end) {
  double squares = 0.0;
  for (const auto& column : run) {
    const auto spread = calc_replicate_statistics(std::span(column).subspan(begin, end - begin)).spread;
    squares += spread.value_or(0.0) * spread.value_or(0.0);
  }
  return std::sqrt(squares);
}

double squared_distance(const Orbit& a, const Orbit& b, std::size_t sample) {
  double square = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) square += std::pow(a[c][sample] - b[c][sample], 2);
  return square;
}

/// Points between which a neighbour is followed.
struct GrowthPhase {
  std::size_t first = 0, last = 0;
  bool resolved = false;  ///< whether its distance exceeds kFloor
  bool parted = false;    ///< whether it reaches kCeiling
};

GrowthPhase find_stretch(const std::vector<double>& logarithms) {
  const auto begin = logarithms.begin(), end = logarithms.end();
  const std::size_t points = logarithms.size();
  const auto latest = begin + static_cast<std::ptrdiff_t>(std::ceil(kLatest * static_cast<double>(points)));
  const auto above = std::find_if(begin, latest, [](double x) { return x >= std::log(kFloor); });
  if (above == latest) return {.first = 0, .last = points - 1};
  const auto reached = std::find_if(above, end, [](double x) { return x >= std::log(kCeiling); });
  auto last = reached == end ? end - 1 : reached;
  while (last != above && *last < std::log(kLost)) --last;
  return {.first = static_cast<std::size_t>(above - begin), .last = static_cast<std::size_t>(last - begin),
          .resolved = true, .parted = reached != end};
}

/// Growth of all neighbours together between two blocks of time.
struct BlockGrowth {
  double rise = 0.0;      ///< of the mean logarithms
  double time = 0.0;
};

/// Bartlett's estimate of the variance of a sum of consecutive residuals, from their products over less than
/// kSpan blocks; about their mean it is too small by that part of the sample (Newey and West, Econometrica 55
/// (1987) 703-708; Anderson, The Statistical Analysis of Time Series, chapter 8).
double calc_variance_of_sum(std::span<const double> residuals) {
  double sum = 0.0;
  for (std::size_t lag = 0; lag < std::min(kSpan, residuals.size()); ++lag) {
    const double weight =
        (lag == 0 ? 1.0 : 2.0) * (1.0 - static_cast<double>(lag) / static_cast<double>(kSpan));
    for (std::size_t b = lag; b < residuals.size(); ++b) sum += weight * residuals[b] * residuals[b - lag];
  }
  return sum / (1.0 - static_cast<double>(kSpan) / static_cast<double>(residuals.size()));
}

/// Ratio of sums over blocks, with Student's interval of its linearised residuals (Cochran, Sampling
/// Techniques, section 6.4). Blocks count with their times: fewer degrees of freedom where these differ.
Estimate estimate_ratio(std::span<const BlockGrowth> blocks) {
  constexpr double kConfidence = 0.95;
  double rise = 0.0, time = 0.0, time_squares = 0.0;
  for (const BlockGrowth& block : blocks) {
    rise += block.rise;
    time += block.time;
    time_squares += block.time * block.time;
  }
  const double ratio = rise / time;
  std::vector<double> residuals;
  for (const BlockGrowth& block : blocks) residuals.push_back(block.rise - ratio * block.time);
  // Bartlett's window has 3/2 of the degrees of freedom of spans that do not overlap
  const double freedom = 1.5 * time * time / time_squares / static_cast<double>(kSpan) - 1.0;
  if (residuals.size() < 2 * kSpan || !(freedom > 0.0)) {
    const double infinite = std::numeric_limits<double>::infinity();
    return {ratio, -infinite, infinite};
  }
  const double reach = boost::math::quantile(boost::math::students_t(freedom), 0.5 * (1.0 + kConfidence)) *
                       std::sqrt(calc_variance_of_sum(residuals)) / time;
  return {ratio, ratio - reach, ratio + reach};
}

/// Neighbour with its curve of ln d.
struct Followed {
  GrowthPhase stretch;
  const std::vector<double>* curve;
};

/// Mean of a neighbour's logarithms over the part of a block in which it is followed, and the mean time.
struct BlockMean {
  double logarithm = 0.0, time = 0.0;
};

std::optional<BlockMean> find_block_mean(std::span<const double> t, const Followed& neighbour,
                                         std::size_t from, std::size_t to) {
  const std::size_t first = std::max(from, neighbour.stretch.first);
  const std::size_t end = std::min(to, neighbour.stretch.last + 1);
  if (first >= end) return std::nullopt;
  const std::vector<double>& curve = *neighbour.curve;
  BlockMean mean{.logarithm = curve[first], .time = t[first]};  // exact where all are equal
  for (std::size_t k = first; k < end; ++k) {
    mean.logarithm += (curve[k] - curve[first]) / static_cast<double>(end - first);
    mean.time += (t[k] - t[first]) / static_cast<double>(end - first);
  }
  return mean;
}

/// Growth from block to block of the time from the first begin of a stretch to the last end.
std::vector<BlockGrowth> gather_blocks(std::span<const double> t, std::span<const Followed> followed) {
  std::size_t first = t.size(), last = 0;
  for (const Followed& neighbour : followed) {
    first = std::min(first, neighbour.stretch.first);
    last = std::max(last, neighbour.stretch.last);
  }
  const std::size_t points = last + 1 - first;
  const std::size_t count = std::min(kBlocks, points);
  std::vector<BlockGrowth> blocks(count - 1);
  for (const Followed& neighbour : followed) {
    std::optional<BlockMean> before;
    for (std::size_t b = 0; b < count; ++b) {
      const auto mean =
          find_block_mean(t, neighbour, first + b * points / count, first + (b + 1) * points / count);
      if (before && mean) {
        blocks[b - 1].rise += mean->logarithm - before->logarithm;
        blocks[b - 1].time += mean->time - before->time;
      }
      before = mean;
    }
  }
  return blocks;
}

/// t_s, and the position of the journal in each joint with clearance. @throws WrongState without one
std::optional<engine::Trajectory> find_orbit(const json& job_id, const RunReader& reader) {
  const std::string id = job_id.get<std::string>();
  TrajectoryQuery query;
  const std::vector<std::string> kept = reader.list_channels(id);
  for (const std::string& channel : kept)
    if (channel.ends_with("journal_x_mm") || channel.ends_with("journal_y_mm"))
      query.channels.push_back(channel);
  if (!kept.empty() && query.channels.empty())
    throw WrongState("job " + id + " has no joint with clearance, whose journal's positions are compared");
  return reader.find(id, query);
}

Orbit positions_of(const engine::Trajectory& run) { return {run.columns.begin() + 1, run.columns.end()}; }

json finite_or_null(double x) { return std::isfinite(x) ? json(x) : json(); }

std::vector<json> cells_of(std::size_t pairs, const Divergence& divergence) {
  std::vector<json> cells{pairs, divergence.parted};
  if (!divergence.exponent) return cells.resize(7), cells;
  const Estimate& exponent = *divergence.exponent;
  cells.insert(cells.end(), {exponent.value, finite_or_null(exponent.low), finite_or_null(exponent.high),
                             divergence.from, divergence.to});
  return cells;
}

}  // namespace

DivergenceMeasurement::DivergenceMeasurement(std::span<const double> t, Orbit run, double begin)
    : run_(std::move(run)), start_(t.empty() ? 0.0 : t.front()) {
  if (t.empty()) return;
  const auto samples = static_cast<double>(t.size());
  delay_ = std::max<std::size_t>(1, static_cast<std::size_t>(kDelay * samples));
  const double after = std::max(begin, t.front() + kTransient * (t.back() - t.front()));
  const auto first = static_cast<std::size_t>(std::ranges::lower_bound(t, after) - t.begin());
  size_ = size_of(run_, first, t.size());
  for (std::size_t k = first; k < t.size(); k += std::max<std::size_t>(1, delay_ / kPointsOfDelay)) {
    samples_.push_back(k);
    times_.push_back(t[k]);
  }
}

std::vector<double> DivergenceMeasurement::calc_log_distances(const Orbit& neighbour) const {
  std::vector<double> logarithms;
  for (const std::size_t sample : samples_) {
    if (sample >= neighbour.front().size()) break;
    const std::size_t count = std::min(sample + 1, delay_);
    double sum = 0.0;
    for (std::size_t k = sample + 1 - count; k <= sample; ++k) sum += squared_distance(run_, neighbour, k);
    logarithms.push_back(std::log(std::max(std::sqrt(sum / static_cast<double>(count)) / size_, kLeast)));
  }
  return logarithms;
}

void DivergenceMeasurement::add(const Orbit& neighbour) {
  if (!(size_ > 0.0)) return;
  std::vector<double> logarithms = calc_log_distances(neighbour);
  if (!logarithms.empty()) curves_.push_back(std::move(logarithms));
}

Divergence DivergenceMeasurement::finish() const {
  Divergence divergence;
  std::vector<GrowthPhase> stretches;
  for (const auto& curve : curves_) stretches.push_back(find_stretch(curve));
  const bool resolved = std::ranges::any_of(stretches, &GrowthPhase::resolved);
  std::vector<Followed> followed;
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    divergence.parted += stretches[k].parted ? 1 : 0;
    if (stretches[k].resolved == resolved && stretches[k].first < stretches[k].last)
      followed.push_back({stretches[k], &curves_[k]});
  }
  if (followed.empty()) return divergence;
  const Estimate exponent = estimate_ratio(gather_blocks(times_, followed));
  if (!std::isfinite(exponent.value)) return divergence;
  const auto count = static_cast<double>(followed.size());
  for (const Followed& neighbour : followed) {
    divergence.from += times_[neighbour.stretch.first] / count;
    divergence.to += times_[neighbour.stretch.last] / count;
  }
  const double measured = divergence.to - divergence.from;
  const double age = std::max(divergence.from - start_, kLeastAge * measured);
  const double linear = std::log1p(measured / age) / measured;
  divergence.exponent = Estimate{exponent.value, exponent.low - linear, exponent.high + linear};
  return divergence;
}

ResultTable make_lyapunov(const json& axes, const ResultTable& results, const RunReader& reader) {
  if (std::ranges::find(results.columns, "replicate") == results.columns.end())
    throw WrongState("the sweep has no replicates, which could part");
  if (results.rows.size() > kMostJobsOfDiagram) {
    throw WrongState("the sweep has " + std::to_string(results.rows.size()) +
                     " jobs; exponents are measured of " + std::to_string(kMostJobsOfDiagram) + " at most");
  }
  ResultTable table{.columns = axes.get<std::vector<std::string>>(), .rows = {}, .ended = results.ended};
  std::vector<std::size_t> swept;
  for (const std::string& path : table.columns) swept.push_back(find_column(results, path, ""));
  table.columns.insert(table.columns.end(), {"pairs", "pairs_diverged", "exponent_1_s", "exponent_low_1_s",
                                             "exponent_high_1_s", "from_s", "to_s"});
  const std::size_t job = find_column(results, "job_id", "");
  const auto run_up = std::ranges::find(results.columns, "run_up_s") - results.columns.begin();
  for (const RowGroup& set : group_rows(results, swept)) {
    const auto& unperturbed = results.rows[set.rows.front()];
    const double begin =
        run_up < std::ssize(unperturbed) ? unperturbed[static_cast<std::size_t>(run_up)].get<double>() : 0.0;
    std::vector<json> cells = set.values;
    std::size_t pairs = 0;
    Divergence divergence;
    if (const auto run = find_orbit(unperturbed[job], reader)) {
      DivergenceMeasurement measurement(run->columns.front(), positions_of(*run), begin);
      for (const std::size_t row : std::span(set.rows).subspan(1)) {
        const auto neighbour = find_orbit(results.rows[row][job], reader);
        if (!neighbour) continue;
        ++pairs;
        measurement.add(positions_of(*neighbour));
      }
      divergence = measurement.finish();
    }
    const auto measured = cells_of(pairs, divergence);
    cells.insert(cells.end(), measured.begin(), measured.end());
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
