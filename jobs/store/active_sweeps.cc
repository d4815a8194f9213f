// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/active_sweeps.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/time_text.h"
#include "jobs/store/read_rows.h"
#include "jobs/store/sweep_order.h"

namespace jobs {
namespace {

constexpr const char* kUnit = "1.0";
/// SQL of the time that a job simulates, whatever sweep it is of.
constexpr const char* kOwnTime =
    "(SELECT json_extract(c.parameters, '$.duration_s') FROM contents c WHERE c.seq = j.content)";

/// SQL of the time that a job simulates, if the sweep varies it; else 1.
std::string simulated_time(const std::string& swept) {
  const auto paths = nlohmann::json::parse(swept, nullptr, false);
  if (!paths.is_array()) return kUnit;
  const auto found = std::ranges::find(paths, "duration_s");
  if (found == paths.end()) return kUnit;
  return "coalesce(json_extract(j.swept, '$[" + std::to_string(found - paths.begin()) + "]'), 1.0)";
}

void read_running_costs(const SQLite::Database& database, std::int64_t sweep, const std::string& time,
                        Costs& costs) {
  SQLite::Statement running(database, "SELECT j.kind, " + time +
                                          ", j.started_ms, j.id FROM jobs j WHERE j.sweep IS ? AND j.state = "
                                          "'running'");
  if (sweep != kSingleJobs) running.bind(1, sweep);
  const std::int64_t now_ms = now_unix_ms();
  while (running.executeStep()) {
    const std::int64_t started_ms = optional_int(running.getColumn(2)).value_or(now_ms);
    costs[running.getColumn(0).getString()].running.push_back(
        {.simulated_s = running.getColumn(1).getDouble(),
         .elapsed_s = std::max(0.0, static_cast<double>(now_ms - started_ms) / 1000.0),
         .id = running.getColumn(3).getString()});
  }
}

/// SQL of the columns that cost_of_kind() reads, behind the kind. @param sweep  as read_costs() has it
std::string cost_query(std::int64_t sweep, const std::string& time) {
  return "SELECT kind, sum(state = 'queued'), total(t) FILTER (WHERE state = 'queued'), "
         "total(t * t) FILTER (WHERE state = 'queued'), "
         "coalesce(max(t) FILTER (WHERE state = 'queued'), 0.0), "
         "count(cost), total(t) FILTER (WHERE cost IS NOT NULL), total(cost), total(cost / t), "
         "total(cost * cost / (t * t)) FROM (SELECT j.kind AS kind, j.state AS state, " +
         time +
         " AS t, r.wall_time_s AS cost FROM jobs j LEFT JOIN results r ON r.seq = j.result AND j.reused = 0 "
         "WHERE j.sweep IS ?" +
         (sweep == kSingleJobs ? " AND j.state = 'queued'" : "") + ") GROUP BY kind";
}

CostOfKind cost_of_kind(SQLite::Statement& found) {
  return {.queued = found.getColumn(1).getInt64(),
          .queued_s = found.getColumn(2).getDouble(),
          .queued_squares_s2 = found.getColumn(3).getDouble(),
          .longest_queued_s = found.getColumn(4).getDouble(),
          .computed = found.getColumn(5).getInt64(),
          .computed_s = found.getColumn(6).getDouble(),
          .wall_time_s = found.getColumn(7).getDouble(),
          .rates = found.getColumn(8).getDouble(),
          .rate_squares = found.getColumn(9).getDouble()};
}

/// @param sweep  kSingleJobs: those that wait or run; of these, the cost of what has ended is not looked at
Costs read_costs(const SQLite::Database& database, std::int64_t sweep, const std::string& time) {
  Costs costs;
  SQLite::Statement list(database, cost_query(sweep, time));
  if (sweep != kSingleJobs) list.bind(1, sweep);
  while (list.executeStep()) costs[list.getColumn(0).getString()] = cost_of_kind(list);
  read_running_costs(database, sweep, time, costs);
  return costs;
}

/// The simulated time of every job of a sweep that does not vary it.
double read_unit(const SQLite::Database& database, std::int64_t sweep, const std::string& time) {
  if (time != kUnit) return 1.0;
  SQLite::Statement first(database,
                          "SELECT json_extract(c.parameters, '$.duration_s') FROM jobs j JOIN contents c ON "
                          "c.seq = j.content WHERE j.sweep = ? LIMIT 1");
  first.bind(1, sweep);
  return first.executeStep() ? optional_double(first.getColumn(0)).value_or(1.0) : 1.0;
}

bool misses_rate(const Costs& costs) {
  return std::ranges::any_of(costs, [](const auto& of_kind) {
    const CostOfKind& cost = of_kind.second;
    return cost.computed == 0 && (cost.queued > 0 || !cost.running.empty());
  });
}

/// A sweep that has not ended, or the jobs without a sweep.
struct ListedSweep {
  std::int64_t seq = kSingleJobs;
  std::string swept;
  std::int64_t priority = 0;
  std::string executor;
  bool runs = false;       ///< has running jobs
  double weight = 1.0;
};

ListedSweep listed_sweep(SQLite::Statement& found) {
  return {.seq = found.getColumn(0).getInt64(),
          .swept = found.getColumn(1).getString(),
          .priority = found.getColumn(2).getInt64(),
          .executor = found.getColumn(3).getString(),
          .runs = found.getColumn(4).getInt() != 0};
}

/// Active sweeps in strata: those with running jobs first, then by priority.
std::vector<ListedSweep> list_active_sweeps(const SQLite::Database& database) {
  SQLite::Statement list(
      database,
      "SELECT a.seq, coalesce(s.swept, ''), coalesce(s.priority, 0) AS priority, coalesce(s.executor, ''), "
      "a.runs FROM (SELECT coalesce(sweep, 0) AS seq, max(runs) AS runs FROM ("
      "SELECT DISTINCT sweep, 0 AS runs FROM jobs WHERE state = 'queued' AND batch IS NULL "
      "UNION ALL SELECT sweep, 0 FROM jobs WHERE batch IS NOT NULL AND state IN ('queued', 'running') "
      "UNION ALL SELECT sweep, 1 FROM jobs WHERE state = 'running') GROUP BY 1) a "
      "LEFT JOIN sweeps s ON s.seq = a.seq ORDER BY a.runs DESC, priority DESC, a.seq");
  std::vector<ListedSweep> sweeps;
  while (list.executeStep()) sweeps.push_back(listed_sweep(list));
  return sweeps;
}

std::size_t count_strata(const std::vector<ListedSweep>& sweeps) {
  std::size_t strata = 0;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const bool is_first = i == 0 || sweeps[i].runs != sweeps[i - 1].runs ||
                          sweeps[i].priority != sweeps[i - 1].priority;
    if (is_first) ++strata;
  }
  return strata;
}

/// Adds sweeps at even distances, which stand for all of a stratum. @param most  number of
/// them
void add_stratum(std::span<const ListedSweep> stratum, std::size_t most, std::vector<ListedSweep>& sample) {
  const std::size_t taken = std::min(stratum.size(), most);
  for (std::size_t k = 0; k < taken; ++k) {
    sample.push_back(stratum[k * stratum.size() / taken]);
    sample.back().weight = static_cast<double>(stratum.size()) / static_cast<double>(taken);
  }
}

/// Stratified sample of the sweeps.
std::vector<ListedSweep> sample_of(const std::vector<ListedSweep>& sweeps) {
  if (sweeps.size() <= kMostActiveSweeps) return sweeps;
  const std::size_t most = std::max<std::size_t>(1, kMostActiveSweeps / count_strata(sweeps));
  std::vector<ListedSweep> sample;
  for (auto first = sweeps.begin(); first != sweeps.end();) {
    const auto end = std::find_if(first, sweeps.end(), [&](const ListedSweep& sweep) {
      return sweep.runs != first->runs || sweep.priority != first->priority;
    });
    add_stratum({first, end}, most, sample);
    first = end;
  }
  return sample;
}

}  // namespace

std::map<std::string, double> read_cost_rates(const SQLite::Database& database) {
  SQLite::Statement list(database,
                         "SELECT j.kind, avg(r.wall_time_s / json_extract(c.parameters, '$.duration_s')) "
                         "FROM (SELECT seq, content, wall_time_s FROM results WHERE error_reason IS NULL "
                         "ORDER BY seq DESC LIMIT 500) r "
                         "JOIN contents c ON c.seq = r.content JOIN jobs j ON j.result = r.seq AND "
                         "j.reused = 0 GROUP BY j.kind");
  std::map<std::string, double> rates;
  while (list.executeStep()) rates.emplace(list.getColumn(0).getString(), list.getColumn(1).getDouble());
  return rates;
}

namespace {

RivalSweep read_rival(const SQLite::Database& database, const ListedSweep& sweep) {
  const bool single = sweep.seq == kSingleJobs;
  const std::string time = single ? kOwnTime : simulated_time(sweep.swept);
  return {.priority = sweep.priority,
          .executor = sweep.executor,
          .unit_s = single ? 1.0 : read_unit(database, sweep.seq, time),
          .costs = read_costs(database, sweep.seq, time),
          .weight = sweep.weight};
}

ActiveSweepSample read_sample(const SQLite::Database& database, const std::vector<ListedSweep>& all) {
  ActiveSweepSample read;
  bool is_incomplete = all.size() > kMostActiveSweeps;  // a sweep that is not in the sample may have none
  for (const ListedSweep& sweep : sample_of(all)) {
    const auto rival = std::make_shared<const RivalSweep>(read_rival(database, sweep));
    read.sweeps.emplace(sweep.seq, rival);
    is_incomplete = is_incomplete || misses_rate(rival->costs);
  }
  if (is_incomplete) read.cost_rates = read_cost_rates(database);
  return read;
}

}  // namespace

std::shared_ptr<const ActiveSweepSample> ActiveSweepCache::read(const SQLite::Database& database) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kKept{1};
  std::unique_lock lock(mutex_);
  if (kept_ && Clock::now() < kept_until_) return kept_;
  // While there are many, one reads for all who wait here.
  if (!kept_) lock.unlock();
  const std::vector<ListedSweep> all = list_active_sweeps(database);
  auto sample = std::make_shared<const ActiveSweepSample>(read_sample(database, all));
  if (!lock.owns_lock()) lock.lock();
  kept_ = all.size() > kMostActiveSweeps ? sample : nullptr;
  kept_until_ = Clock::now() + kKept;
  return sample;
}

void ActiveSweeps::read_what_is_left(std::int64_t seq, SweepRow& row) {
  if (!sample_) sample_ = cache_.read(database_);
  const std::string time = simulated_time(row.swept);
  row.costs = read_costs(database_, seq, time);
  row.unit_s = read_unit(database_, seq, time);
  for (const auto& [number, rival] : sample_->sweeps)
    if (number != seq) row.rivals.push_back(rival);
  row.cost_rates = sample_->cost_rates;
}

}  // namespace jobs
