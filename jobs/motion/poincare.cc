// SPDX-License-Identifier: Apache-2.0
#include "jobs/motion/poincare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/results/table_groups.h"

namespace jobs {

namespace {

constexpr const char* kCrankAngle = "crank_angle_rad";

/// Channels that are the derivatives of another one; empty: there is none.
struct Derivatives {
  std::string rate, acceleration;
};

Derivatives derivatives_of(const std::string& channel) {
  if (channel == kCrankAngle) return {"crank_velocity_rad_s", ""};
  if (channel == "slider_position_m") return {"slider_velocity_m_s", "slider_acceleration_m_s2"};
  if (channel == "slider_velocity_m_s") return {"slider_acceleration_m_s2", ""};
  if (channel.ends_with("_rad") || channel.ends_with("_m")) return {channel + "_s", channel + "_s2"};
  if (channel.ends_with("_rad_s") || channel.ends_with("_m_s")) return {channel + "2", ""};
  return {};
}

bool is_among(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// @returns whether a channel is the position of a freedom: its rate is kept, too
bool is_freedom(const std::vector<std::string>& kept, const std::string& channel) {
  return (channel.ends_with("_rad") || channel.ends_with("_m")) &&
         is_among(kept, derivatives_of(channel).rate);
}

std::string choose_angle(const std::vector<std::string>& kept, const std::string& asked) {
  if (!asked.empty()) {
    if (asked.ends_with("_rad") && is_among(kept, asked)) return asked;
    throw InvalidRequest(std::vector<Fault>{{"/angle", "must be a channel of these jobs in rad"}});
  }
  if (is_among(kept, kCrankAngle)) return kCrankAngle;
  const auto first = std::ranges::find_if(kept, [&](const std::string& channel) {
    return channel.ends_with("_rad") && is_freedom(kept, channel);
  });
  if (first == kept.end())
    throw WrongState("the linkage has no freedom that turns, whose passages could make a section");
  return *first;
}

std::vector<std::string> choose_channels(const std::vector<std::string>& kept, const std::string& angle) {
  constexpr std::string_view kJournal = "journal_x_mm";
  for (const std::string& channel : kept)
    if (channel.ends_with(kJournal)) {
      const std::string joint = channel.substr(0, channel.size() - kJournal.size());
      return {channel, joint + "journal_y_mm"};
    }
  for (const std::string& channel : kept)
    if (channel != angle && is_freedom(kept, channel)) return {channel, derivatives_of(channel).rate};
  throw WrongState("the linkage has no freedom beside " + angle + ": say which channels to take");
}

const std::vector<double>* find_column_of(const engine::Trajectory& run, std::string_view key) {
  const auto found = std::ranges::find(run.channels, key, &engine::QuantityInfo::key);
  return found == run.channels.end() ? nullptr
                                     : &run.columns[static_cast<std::size_t>(found - run.channels.begin())];
}

/// Positions, angles, quaternions and energies are smooth; forces and accelerations have kinks.
bool is_smooth(std::string_view key) {
  if (key.ends_with("_n_m")) return false;
  return std::ranges::any_of(std::array<std::string_view, 9>{"_m", "_mm", "_rad", "_mrad", "_j", "_qw", "_qx",
                                                             "_qy", "_qz"},
                             [&](std::string_view unit) { return key.ends_with(unit); });
}

void check_channel(const std::string& channel, const std::string& angle) {
  if (channel != "t_s" && channel != angle) return;
  throw InvalidRequest(std::vector<Fault>{
      {"/channel", "must be a channel other than t_s and " + angle + ", which define the section"}});
}

/// A channel between its samples: the polynomial of least degree that has its values, and as many of its
/// stored derivatives as there are, at both ends of the interval (Hermite interpolation, quintic or cubic:
/// Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, section II.6). Without derivatives,
/// the cubic through four samples of a smooth channel, the line through two of another one.
class Interpolant {
 public:
  Interpolant(const engine::Trajectory& run, std::size_t channel)
      : t_(run.columns.front()), x_(run.columns.at(channel)), smooth_(is_smooth(run.channels[channel].key)) {
    const Derivatives names = derivatives_of(run.channels[channel].key);
    rate_ = find_column_of(run, names.rate);
    if (rate_ != nullptr) acceleration_ = find_column_of(run, names.acceleration);
  }

  [[nodiscard]] double at_sample(std::size_t k) const { return x_[k]; }

  /// @param k  the sample that ends the interval, 1 or more  @param u  of the interval, from 0 to 1
  [[nodiscard]] double at(std::size_t k, double u) const {
    if (rate_ != nullptr) return calc_hermite(k, u);
    return smooth_ && t_.size() >= 4 ? calc_cubic(k, std::lerp(t_[k - 1], t_[k], u))
                                     : std::lerp(x_[k - 1], x_[k], u);
  }

 private:
  [[nodiscard]] double calc_hermite(std::size_t k, double u) const {
    const double h = t_[k] - t_[k - 1];
    const double rise = x_[k] - x_[k - 1];
    const double v0 = h * (*rate_)[k - 1], v1 = h * (*rate_)[k];
    if (acceleration_ == nullptr) {
      const double c2 = 3.0 * rise - 2.0 * v0 - v1, c3 = v0 + v1 - 2.0 * rise;
      return x_[k - 1] + u * (v0 + u * (c2 + u * c3));
    }
    const double a0 = h * h * (*acceleration_)[k - 1], a1 = h * h * (*acceleration_)[k];
    const double c3 = 10.0 * rise - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
    const double c4 = -15.0 * rise + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
    const double c5 = 6.0 * rise - 3.0 * (v0 + v1) - 0.5 * (a0 - a1);
    return x_[k - 1] + u * (v0 + u * (0.5 * a0 + u * (c3 + u * (c4 + u * c5))));
  }

  /// Lagrange's, through the samples next to the interval.
  [[nodiscard]] double calc_cubic(std::size_t k, double t) const {
    const std::size_t first = std::clamp<std::size_t>(k, 2, t_.size() - 2) - 2;
    double sum = 0.0;
    for (std::size_t i = first; i < first + 4; ++i) {
      double weight = x_[i];
      for (std::size_t j = first; j < first + 4; ++j)
        if (j != i) weight *= (t - t_[j]) / (t_[i] - t_[j]);
      sum += weight;
    }
    return sum;
  }

  const std::vector<double>& t_;
  const std::vector<double>& x_;
  const std::vector<double>* rate_ = nullptr;
  const std::vector<double>* acceleration_ = nullptr;
  bool smooth_;
};

/// Place in its k-th interval at which the angle passes a value between those at its ends, by bisection.
double find_passage(const Interpolant& angle, std::size_t k, double value, bool rises) {
  double low = 0.0, high = 1.0;
  for (double middle = 0.5; low < middle && middle < high; middle = 0.5 * (low + high))
    ((angle.at(k, middle) < value) == rises ? low : high) = middle;
  return high;
}

/// Begin of a turn between two samples.
struct TurnBegin {
  double turn = 0.0;
  double part = 0.0;  ///< of the interval
};

/// @param k  the sample that ends the interval  @returns empty if no turn begins in it
std::optional<TurnBegin> find_turn(const Interpolant& angle, std::size_t k, double phase) {
  const double before = (angle.at_sample(k - 1) - phase) / (2.0 * std::numbers::pi);
  const double after = (angle.at_sample(k) - phase) / (2.0 * std::numbers::pi);
  // The whole number in (before, after], or in [after, before) of a crank that turns back.
  const double turn = after > before ? std::floor(after) : std::ceil(after);
  if (after == before || (after > before ? turn <= before : turn >= before)) return std::nullopt;
  const double passed = phase + 2.0 * std::numbers::pi * turn;
  return TurnBegin{.turn = turn,
                   .part = turn == after ? 1.0 : find_passage(angle, k, passed, after > before)};
}

std::size_t find_angle(const engine::Trajectory& run, const SectionChannels& channels) {
  const auto found = std::ranges::find(run.channels, channels.angle, &engine::QuantityInfo::key);
  return static_cast<std::size_t>(found - run.channels.begin());
}

/// Gives a section its channels, and no rows yet. @returns the wanted ones, between their samples
std::vector<Interpolant> begin_section(const engine::Trajectory& run, const SectionChannels& channels,
                                       engine::Trajectory& section) {
  section.channels = {run.channels[0], {.key = "turn", .help = "turns since the place at rest"}};
  std::vector<Interpolant> wanted;
  for (std::size_t c = 1; c < run.columns.size(); ++c) {
    const std::string& key = run.channels[c].key;
    if (key == channels.angle || !is_among(channels.wanted, key)) continue;
    section.channels.push_back(run.channels[c]);
    wanted.emplace_back(run, c);
  }
  section.columns.resize(section.channels.size());
  return wanted;
}

}  // namespace

SectionChannels choose_section(const std::vector<std::string>& kept, const std::string& angle,
                               std::vector<std::string> wanted) {
  SectionChannels made{.angle = choose_angle(kept, angle), .wanted = std::move(wanted), .read = {}};
  if (made.wanted.empty()) made.wanted = choose_channels(kept, made.angle);
  made.read = made.wanted;
  made.read.push_back(made.angle);
  const std::vector<std::string> asked = made.read;
  for (const std::string& channel : asked) {
    const Derivatives names = derivatives_of(channel);
    for (const std::string& name : {names.rate, names.acceleration})
      if (is_among(kept, name) && !is_among(made.read, name)) made.read.push_back(name);
  }
  return made;
}

engine::Trajectory take_section(const engine::Trajectory& run, const SectionChannels& channels,
                                double phase) {
  const std::vector<double>& t = run.columns.at(0);
  const Interpolant angle(run, find_angle(run, channels));
  engine::Trajectory section;
  const std::vector<Interpolant> wanted = begin_section(run, channels, section);
  for (std::size_t k = 1; k < t.size(); ++k) {
    const auto begin = find_turn(angle, k, phase);
    if (!begin) continue;
    section.columns[0].push_back(std::lerp(t[k - 1], t[k], begin->part));
    section.columns[1].push_back(begin->turn);
    for (std::size_t c = 0; c < wanted.size(); ++c)
      section.columns[c + 2].push_back(wanted[c].at(k, begin->part));
  }
  return section;
}

namespace {

void check_job_count(const ResultTable& results) {
  if (results.rows.size() > kMostJobsOfDiagram) {
    throw WrongState("the sweep has " + std::to_string(results.rows.size()) + " jobs; a diagram is made of " +
                     std::to_string(kMostJobsOfDiagram) + " at most");
  }
}

/// Maker of a bifurcation diagram, job by job.
class DiagramMaker {
 public:
  DiagramMaker(const nlohmann::json& axes, const ResultTable& results, const BifurcationQuery& query,
               const RunReader& reader)
      : results_(results),
        query_(query),
        reader_(reader),
        run_up_(find_column(results, "run_up_s", "")),
        job_(find_column(results, "job_id", "")),
        channel_(query.channel),
        table_{.columns = axes.get<std::vector<std::string>>(), .rows = {}, .ended = results.ended} {
    for (const std::string& path : table_.columns) swept_.push_back(find_column(results, path, ""));
  }

  ResultTable make() {
    for (const auto& row : results_.rows) add_job(row);
    table_.columns.insert(table_.columns.end(), {"job_id", "t_s", channel_});
    return std::move(table_);
  }

 private:
  void add_job(const std::vector<nlohmann::json>& row) {
    const std::string job_id = row[job_].get<std::string>();
    const std::vector<std::string> kept = reader_.list_channels(job_id);
    if (kept.empty()) return;
    if (channel_.empty()) channel_ = choose_section(kept, query_.angle, {}).wanted.front();
    const SectionChannels channels = choose_section(kept, query_.angle, {channel_});
    check_channel(channel_, channels.angle);
    const TrajectoryQuery wanted{.channels = channels.read,
                                 .from = query_.from ? *query_.from : row[run_up_].get<double>(),
                                 .to = {}};
    const auto run = reader_.find(job_id, wanted);
    if (run) add_points(row, take_section(*run, channels, query_.phase));
  }

  void add_points(const std::vector<nlohmann::json>& row, const engine::Trajectory& section) {
    for (std::size_t k = 0; k < section.columns[0].size(); ++k) {
      std::vector<nlohmann::json> cells;
      for (const std::size_t column : swept_) cells.push_back(row[column]);
      const double value = section.columns.back()[k];
      cells.insert(cells.end(), {row[job_], section.columns[0][k],
                                 std::isfinite(value) ? nlohmann::json(value) : nlohmann::json()});
      table_.rows.push_back(std::move(cells));
    }
  }

  const ResultTable& results_;
  const BifurcationQuery& query_;
  const RunReader& reader_;
  const std::size_t run_up_, job_;  ///< columns
  std::string channel_;             ///< empty: that of the first job is to be chosen
  ResultTable table_;
  std::vector<std::size_t> swept_;  ///< columns
};

}  // namespace

ResultTable make_bifurcation(const nlohmann::json& axes, const ResultTable& results,
                             const BifurcationQuery& query, const RunReader& reader) {
  check_job_count(results);
  return DiagramMaker(axes, results, query, reader).make();
}

}  // namespace jobs
