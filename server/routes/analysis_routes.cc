// SPDX-License-Identifier: Apache-2.0
#include "server/routes/analysis_routes.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/flexibility/flexibility.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/motion/lyapunov.h"
#include "jobs/motion/poincare.h"
#include "jobs/motion/spectrum.h"
#include "jobs/paper/paper_statements.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/requests/parameters.h"
#include "jobs/results/csv.h"
#include "jobs/results/table_groups.h"
#include "jobs/results/table_json.h"
#include "jobs/sensitivity/sensitivity.h"
#include "jobs/surrogate/surrogate.h"
#include "jobs/trajectories/npz.h"
#include "jobs/wear/wear.h"
#include "server/messages/conditional.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/report/html.h"
#include "server/report/report.h"
#include "server/routes/job_routes.h"
#include "server/routes/tables.h"

namespace server {

namespace {

/// A sweep and its table of results.
struct SweepAndResults {
  nlohmann::json sweep;
  jobs::ResultTable results;
};

std::optional<SweepAndResults> find_sweep_and_results(const RequestContext& context,
                                                      const jobs::ResultQuery& query = {}) {
  auto sweep = context.service.find_sweep(context.id);
  auto results = sweep ? context.service.find_results(context.id, query) : std::nullopt;
  return results ? std::optional(SweepAndResults{std::move(*sweep), std::move(*results)}) : std::nullopt;
}

/// @throws WrongState if the jobs of a sweep have no trajectories
void check_keeps_trajectories(const nlohmann::json& sweep) {
  const nlohmann::json& request = sweep.at("request");
  if (jobs::keeps_metrics_alone(request) ||
      jobs::keeps_metrics_alone(request.value("parameters", nlohmann::json::object())))
    throw jobs::WrongState(
        "the sweep's jobs have no trajectories: it was submitted with \"keep\": \"metrics\"");
}

/// The sweep with job_id, replicate if it has any, the values of its axes, and run_up_s. Its jobs have
/// trajectories.
std::optional<SweepAndResults> find_with_run_up(const RequestContext& context) {
  const auto sweep = context.service.find_sweep(context.id);
  if (sweep) check_keeps_trajectories(*sweep);
  const auto all = sweep ? context.service.find_results(context.id, {.limit = 1}) : std::nullopt;
  if (!all) return std::nullopt;
  jobs::ResultQuery query;
  query.fields = "job_id,run_up_s";
  if (std::ranges::find(all->columns, "replicate") != all->columns.end()) query.fields += ",replicate";
  for (const auto& path : sweep->at("axes")) {
    if (path != "run_up_s") query.fields += "," + path.get<std::string>();
  }
  return find_sweep_and_results(context, query);
}

/// Runs an analysis of a sweep. Its faults are reported together with those of the query.
template <typename Analysis>
auto run_analysis(const RequestContext& context, Query& query,
                  std::optional<SweepAndResults> (*find)(const RequestContext&), const Analysis& analysis) {
  auto outcome = query.check_and([&] {
    const auto found = find(context);
    return found ? std::optional(analysis(*found)) : std::nullopt;
  });
  if (!outcome) throw HttpError(404, "there is no sweep " + context.id);
  return std::move(*outcome);
}

std::optional<SweepAndResults> find_with_all_columns(const RequestContext& context) {
  return find_sweep_and_results(context);
}

Response make_rows(const RequestContext& context, TableFormat format, const jobs::ResultTable& table,
                   const std::string& name) {
  return with_etag_if(table.ended, context.request,
                      make_table(format, to_text(table, format), name + "-" + context.id));
}

/// The metric that a query asks for, of those that the sweep's linkages have.
std::string metric_of(const Query& query, const SweepAndResults& found) {
  return jobs::choose_free_metric(found.sweep, found.results, query.text("metric").value_or(""));
}

/// Names of all channels of a job; none of a job that is not there.
std::vector<std::string> list_channels(const RequestContext& context, const std::string& id) {
  std::vector<std::string> names;
  if (const auto job = context.service.find_job(id))
    for (const engine::QuantityInfo& channel : jobs::channel_table(jobs::to_job_spec(job->at("parameters"))))
      names.push_back(channel.key);
  return names;
}

jobs::RunReader make_run_reader(const RequestContext& context) {
  return {.find = [&context](const std::string& id, const jobs::TrajectoryQuery& query)
              { return context.service.find_trajectory(id, query); },
          .list_channels = [&context](const std::string& id) { return list_channels(context, id); }};
}

/// Runs a query of a single channel. A fault of /channels/0 becomes one of /channel, the key of the query.
template <typename Ask>
auto with_one_channel(const Ask& ask) {
  try {
    return ask();
  } catch (const jobs::InvalidRequest& invalid) {
    std::vector<jobs::Fault> faults = invalid.faults();
    for (jobs::Fault& fault : faults) {
      if (fault.pointer == "/channels/0") fault.pointer = "/channel";
    }
    throw jobs::InvalidRequest(std::move(faults));
  }
}

/// Channels of a wear map. Older programs did not keep all of them.
std::optional<engine::Trajectory> find_wear_trajectory(const RequestContext& context,
                                                       const jobs::WornBearing& bearing,
                                                       jobs::TrajectoryQuery part) {
  part.channels = jobs::wear_channels(bearing);
  try {
    return context.service.find_trajectory(context.id, part);
  } catch (const jobs::InvalidRequest& invalid) {
    const bool kept = !invalid.faults().front().pointer.starts_with("/channels");
    if (!kept) throw jobs::WrongState("the job was computed by a program that did not keep its sliding work");
    throw;
  }
}

Response make_columns(const RequestContext& context, TableFormat format, const engine::Trajectory& table,
                      const std::string& name) {
  std::string text = format == TableFormat::kCsv   ? jobs::to_csv(table)
                     : format == TableFormat::kNpz ? jobs::to_npz(table)
                                                   : jobs::to_json_columns(table);
  return with_etag(
      context.request,
      make_table(format, std::move(text), name + "-" + context.id));  // only what has ended has a trajectory
}

/// Counts a job for its program and machine.
void count_setup(nlohmann::json setup, report::Provenance& provenance) {
  auto found = std::ranges::find_if(provenance.setups, [&](nlohmann::json known) {
    known.erase("jobs");
    return known == setup;
  });
  if (found == provenance.setups.end()) {
    setup["jobs"] = 0;
    found = provenance.setups.insert(found, setup);
  }
  (*found)["jobs"] = found->at("jobs").get<int>() + 1;
}

/// Programs and machines of the first jobs of a sweep.
report::Provenance find_provenance(const RequestContext& context, const jobs::ResultTable& results) {
  constexpr std::size_t kMaxJobs = 1000;
  report::Provenance provenance;
  for (const auto& row : results.rows) {
    if (provenance.jobs_examined == kMaxJobs) break;
    ++provenance.jobs_examined;
    const auto job = context.service.find_job(row.front().get<std::string>());
    if (!job || job->at("run").is_null()) continue;
    nlohmann::json setup = job->at("run").at("program");
    for (const char* const key : {"host", "cpu"}) setup[key] = job->at("run").at(key);
    count_setup(std::move(setup), provenance);
  }
  return provenance;
}

report::FailureCounts count_failures(const RequestContext& context, const nlohmann::json& sweep) {
  report::FailureCounts counts;
  if (sweep.at("counts").at("failed") == 0) return counts;
  const auto failed =
      context.service.find_results(context.id, {.fields = "error_reason", .filters = {{"state", "failed"}}});
  if (!failed) return counts;
  for (const auto& row : failed->rows)
    ++counts[row.front().is_string() ? row.front().get<std::string>() : std::string("unknown")];
  return counts;
}

report::ReportQuery read_report_query(Query& query) {
  constexpr std::array<std::string_view, 2> kWords{"false", "true"};
  return {.metric = query.text("metric").value_or(""),
          .x = query.text("x").value_or(""),
          .appendix = query.word("rows", kWords) == kWords.back() ? report::Appendix::kRows
                                                                  : report::Appendix::kNone};
}

jobs::WearQuery read_wear_query(Query& query) {
  jobs::WearQuery wanted;
  wanted.wear_coefficient =
      query.number_in("wear_coefficient_m2_n", jobs::kWearCoefficientRange).value_or(wanted.wear_coefficient);
  wanted.sectors = query.count_in("sectors", jobs::kMapSectorsRange).value_or(wanted.sectors);
  wanted.worn_clearance = query.number("worn_clearance_mm");
  return wanted;
}

/// @throws HttpError 404
jobs::WornBearing find_bearing(const RequestContext& context, const std::string& joint) {
  const auto job = context.service.find_job(context.id);
  if (!job) throw HttpError(404, "there is no job " + context.id);
  return jobs::find_worn_bearing(job->at("parameters"), list_channels(context, context.id), joint);
}

}  // namespace

Response get_sensitivity(const RequestContext& context) {
  Query query(context.request, {"metric", "format"});
  const TableFormat format = find_row_format(context.request, query);
  const auto table = run_analysis(context, query, find_with_all_columns, [&](const SweepAndResults& found) {
    return jobs::calc_sensitivity(found.sweep, found.results, metric_of(query, found));
  });
  return make_rows(context, format, table, "sensitivity");
}

Response get_surrogate(const RequestContext& context) {
  Query query(context.request, {"metric", "x", "y"});
  bool ended = false;
  const auto surrogate =
      run_analysis(context, query, find_with_all_columns, [&](const SweepAndResults& found) {
        const jobs::SurrogateQuery wanted{.metric = metric_of(query, found),
                                          .x = query.text("x").value_or(""),
                                          .y = query.text("y").value_or("")};
        ended = found.results.ended;
        return make_surrogate(found.sweep, found.results, wanted);
      });
  return with_etag_if(ended, context.request, json_response(200, to_text(surrogate)));
}

Response get_flexibility(const RequestContext& context) {
  Query query(context.request, {"metric", "format"});
  const TableFormat format = find_row_format(context.request, query);
  const auto table = run_analysis(context, query, find_with_all_columns, [&](const SweepAndResults& found) {
    return jobs::compare_links(found.sweep, found.results, metric_of(query, found));
  });
  return make_rows(context, format, table, "flexibility");
}

Response get_paper(const RequestContext& context) {
  Query query(context.request, {"format"});
  const TableFormat format = find_row_format(context.request, query);
  const auto table = run_analysis(context, query, find_with_all_columns, [](const SweepAndResults& found) {
    return jobs::hold_against_paper(found.results);
  });
  return make_rows(context, format, table, "paper");
}

Response get_bifurcation(const RequestContext& context) {
  Query query(context.request, {"channel", "angle", "phase_rad", "from", "format"});
  const TableFormat format = find_row_format(context.request, query);
  jobs::BifurcationQuery wanted;
  wanted.channel = query.text("channel").value_or("");
  wanted.angle = query.text("angle").value_or("");
  wanted.phase = query.number("phase_rad").value_or(wanted.phase);
  wanted.from = query.number("from");
  const auto table = run_analysis(context, query, find_with_run_up, [&](const SweepAndResults& found) {
    return with_one_channel([&] {
      return make_bifurcation(found.sweep.at("axes"), found.results, wanted, make_run_reader(context));
    });
  });
  return make_rows(context, format, table, "bifurcation");
}

Response get_lyapunov(const RequestContext& context) {
  Query query(context.request, {"format"});
  const TableFormat format = find_row_format(context.request, query);
  const auto table = run_analysis(context, query, find_with_run_up, [&](const SweepAndResults& found) {
    return make_lyapunov(found.sweep.at("axes"), found.results, make_run_reader(context));
  });
  return make_rows(context, format, table, "lyapunov");
}

Response get_report(const RequestContext& context) {
  Query query(context.request, {"metric", "x", "rows"});
  const report::ReportQuery wanted = read_report_query(query);
  bool ended = false;
  std::string page = run_analysis(context, query, find_with_all_columns, [&](const SweepAndResults& found) {
    ended = found.results.ended;
    return report::make_report(found.sweep, found.results, wanted, count_failures(context, found.sweep),
                               find_provenance(context, found.results));
  });
  return with_etag_if(ended, context.request,
                      {.status = 200, .content_type = "text/html; charset=utf-8", .body = std::move(page),
                       .headers = {{"Content-Security-Policy", report::page_policy()}}});
}

Response get_spectrum(const RequestContext& context) {
  Query query(context.request, {"channel", "window", "from", "to", "format"});
  const TableFormat format = find_column_format(context.request, query);
  const std::string channel = query.text("channel").value_or("slider_acceleration_m_s2");
  const jobs::TrajectoryQuery wanted{
      .channels = {channel}, .from = query.number("from"), .to = query.number("to")};
  const auto window = query.word("window", jobs::kWindowNames);
  const auto run = query.check_and([&] {
    if (channel == "t_s")
      throw jobs::InvalidRequest(std::vector<jobs::Fault>{{"/channel", "must be a channel other than t_s"}});
    return with_one_channel([&] { return context.service.find_trajectory(context.id, wanted); });
  });
  if (!run) throw no_trajectory(context);
  return make_columns(context, format,
                      jobs::make_spectrum(*run, jobs::find_window(window.value_or("hann")).value()),
                      "spectrum");
}

Response get_poincare(const RequestContext& context) {
  Query query(context.request, {"channels", "angle", "phase_rad", "from", "to", "format"});
  const TableFormat format = find_column_format(context.request, query);
  const std::vector<std::string> asked = query.list("channels");
  const std::string angle = query.text("angle").value_or("");
  jobs::TrajectoryQuery wanted{.channels = {}, .from = query.number("from"), .to = query.number("to")};
  const double phase = query.number("phase_rad").value_or(0.0);
  jobs::SectionChannels channels;
  const auto run = query.check_and([&]() -> std::optional<engine::Trajectory> {
    const std::vector<std::string> kept = list_channels(context, context.id);
    if (kept.empty()) return std::nullopt;
    channels = jobs::choose_section(kept, angle, asked);
    wanted.channels = channels.read;
    return context.service.find_trajectory(context.id, wanted);
  });
  if (!run) throw no_trajectory(context);
  return make_columns(context, format, jobs::take_section(*run, channels, phase), "poincare");
}

Response get_wear(const RequestContext& context) {
  Query query(context.request,
              {"joint", "wear_coefficient_m2_n", "sectors", "worn_clearance_mm", "from", "to", "format"});
  const TableFormat format = find_row_format(context.request, query);
  const jobs::WearQuery wanted = read_wear_query(query);
  const std::string joint = query.text("joint").value_or("");
  const jobs::TrajectoryQuery part{
      .channels = {}, .from = query.number("from"), .to = query.number("to")};
  query.check();
  const jobs::WornBearing bearing = find_bearing(context, joint);
  const auto run = find_wear_trajectory(context, bearing, part);
  if (!run) throw no_trajectory(context);
  return make_rows(context, format, make_wear_map(bearing, *run, wanted), "wear");
}

}  // namespace server
