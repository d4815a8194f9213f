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

BlockGrowth sum_growth(std::span<const BlockGrowth> blocks) {
  BlockGrowth sum;
  for (const BlockGrowth& block : blocks) {
    sum.rise += block.rise;
    sum.time += block.time;
  }
  return sum;
}

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

/// Degrees of freedom of the residuals of blocks, which count with their times: fewer where these differ.
double calc_degrees_of_freedom(std::span<const BlockGrowth> blocks, double time) {
  double time_squares = 0.0;
  for (const BlockGrowth& block : blocks) time_squares += block.time * block.time;
  // Bartlett's window has 3/2 of the degrees of freedom of spans that do not overlap
  return 1.5 * time * time / time_squares / static_cast<double>(kSpan) - 1.0;
}

/// Ratio of sums over blocks, with Student's interval of its linearised residuals (Cochran, Sampling
/// Techniques, section 6.4).
Estimate estimate_ratio(std::span<const BlockGrowth> blocks) {
  constexpr double kConfidence = 0.95;
  const auto [rise, time] = sum_growth(blocks);
  const double ratio = rise / time;
  std::vector<double> residuals;
  for (const BlockGrowth& block : blocks) residuals.push_back(block.rise - ratio * block.time);
  const double freedom = calc_degrees_of_freedom(blocks, time);
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

/// Division of points into blocks of nearly equal size.
struct BlockDivision {
  std::size_t first = 0, points = 0, blocks = 0;

  [[nodiscard]] std::size_t begin_of(std::size_t block) const { return first + block * points / blocks; }
};

/// Division from the first begin of a stretch to the last end.
BlockDivision divide_stretches(std::span<const Followed> followed) {
  std::size_t first = followed.front().stretch.first, last = 0;
  for (const Followed& neighbour : followed) {
    first = std::min(first, neighbour.stretch.first);
    last = std::max(last, neighbour.stretch.last);
  }
  const std::size_t points = last + 1 - first;
  return {.first = first, .points = points, .blocks = std::min(kBlocks, points)};
}

void add_growth(std::span<const double> t, const Followed& neighbour, const BlockDivision& division,
                std::vector<BlockGrowth>& growth) {
  std::optional<BlockMean> before;
  for (std::size_t b = 0; b < division.blocks; ++b) {
    const auto mean = find_block_mean(t, neighbour, division.begin_of(b), division.begin_of(b + 1));
    if (before && mean) {
      growth[b - 1].rise += mean->logarithm - before->logarithm;
      growth[b - 1].time += mean->time - before->time;
    }
    before = mean;
  }
}

/// Growth from block to block. @param followed  one or more
std::vector<BlockGrowth> gather_blocks(std::span<const double> t, std::span<const Followed> followed) {
  const BlockDivision division = divide_stretches(followed);
  std::vector<BlockGrowth> growth(division.blocks - 1);
  for (const Followed& neighbour : followed) add_growth(t, neighbour, division, growth);
  return growth;
}

/// The neighbours that are measured: those whose distance is resolved, or all if no one's is.
std::vector<Followed> choose_followed(std::span<const GrowthPhase> stretches,
                                      const std::vector<std::vector<double>>& curves) {
  const bool resolved = std::ranges::any_of(stretches, &GrowthPhase::resolved);
  std::vector<Followed> followed;
  for (std::size_t k = 0; k < curves.size(); ++k)
    if (stretches[k].resolved == resolved && stretches[k].first < stretches[k].last)
      followed.push_back({stretches[k], &curves[k]});
  return followed;
}

void set_mean_stretch(std::span<const double> t, std::span<const Followed> followed, Divergence& divergence) {
  const auto count = static_cast<double>(followed.size());
  for (const Followed& neighbour : followed) {
    divergence.from += t[neighbour.stretch.first] / count;
    divergence.to += t[neighbour.stretch.last] / count;
  }
}

/// The interval, wider by the exponent that a distance has which grows with the first power of time.
/// @param age  from the time at which the runs began to differ to the stretch, [s]
/// @param measured  length of the stretch, [s]
Estimate widen_interval(const Estimate& exponent, double age, double measured) {
  const double linear = std::log1p(measured / std::max(age, kLeastAge * measured)) / measured;
  return {exponent.value, exponent.low - linear, exponent.high + linear};
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
  divergence.parted =
      static_cast<std::size_t>(std::ranges::count_if(stretches, &GrowthPhase::parted));
  const std::vector<Followed> followed = choose_followed(stretches, curves_);
  if (followed.empty()) return divergence;
  const Estimate exponent = estimate_ratio(gather_blocks(times_, followed));
  if (!std::isfinite(exponent.value)) return divergence;
  set_mean_stretch(times_, followed, divergence);
  divergence.exponent = widen_interval(exponent, divergence.from - start_, divergence.to - divergence.from);
  return divergence;
}

namespace {

void check_can_be_measured(const ResultTable& results) {
  if (std::ranges::find(results.columns, "replicate") == results.columns.end())
    throw WrongState("the sweep has no replicates, which could part");
  if (results.rows.size() > kMostJobsOfDiagram) {
    throw WrongState("the sweep has " + std::to_string(results.rows.size()) +
                     " jobs; exponents are measured of " + std::to_string(kMostJobsOfDiagram) + " at most");
  }
}

/// Reader of the runs of a table's jobs.
class OrbitReader {
 public:
  OrbitReader(const ResultTable& results, const RunReader& reader)
      : results_(results),
        reader_(reader),
        job_(find_column(results, "job_id", "")),
        run_up_(std::ranges::find(results.columns, "run_up_s") - results.columns.begin()) {}

  [[nodiscard]] std::optional<engine::Trajectory> find(std::size_t row) const {
    return find_orbit(results_.rows[row][job_], reader_);
  }
  /// Time at which the run-up of a job ends, [s].
  [[nodiscard]] double run_up_of(std::size_t row) const {
    const auto& cells = results_.rows[row];
    return run_up_ < std::ssize(cells) ? cells[static_cast<std::size_t>(run_up_)].get<double>() : 0.0;
  }

 private:
  const ResultTable& results_;
  const RunReader& reader_;
  const std::size_t job_;
  const std::ptrdiff_t run_up_;  ///< column; beyond the last one: there is none
};

/// Cells of a set of replicates, the first of which is not perturbed.
std::vector<json> measure_set(std::span<const std::size_t> rows, const OrbitReader& orbits) {
  const auto run = orbits.find(rows.front());
  if (!run) return cells_of(0, {});
  DivergenceMeasurement measurement(run->columns.front(), positions_of(*run), orbits.run_up_of(rows.front()));
  std::size_t pairs = 0;
  for (const std::size_t row : rows.subspan(1)) {
    const auto neighbour = orbits.find(row);
    if (!neighbour) continue;
    ++pairs;
    measurement.add(positions_of(*neighbour));
  }
  return cells_of(pairs, measurement.finish());
}

}  // namespace

ResultTable make_lyapunov(const json& axes, const ResultTable& results, const RunReader& reader) {
  check_can_be_measured(results);
  ResultTable table{.columns = axes.get<std::vector<std::string>>(), .rows = {}, .ended = results.ended};
  std::vector<std::size_t> swept;
  for (const std::string& path : table.columns) swept.push_back(find_column(results, path, ""));
  table.columns.insert(table.columns.end(), {"pairs", "pairs_diverged", "exponent_1_s", "exponent_low_1_s",
                                             "exponent_high_1_s", "from_s", "to_s"});
  const OrbitReader orbits(results, reader);
  for (const RowGroup& set : group_rows(results, swept)) {
    std::vector<json> cells = set.values;
    const auto measured = measure_set(set.rows, orbits);
    cells.insert(cells.end(), measured.begin(), measured.end());
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
