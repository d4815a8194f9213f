// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/check.h"

#include <array>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include <unistd.h>

#include "jobs/base/machine.h"
#include "jobs/cluster/batch.h"
#include "jobs/cluster/shared_folder.h"
#include "jobs/cluster/slurm.h"
#include "jobs/requests/parameters.h"
#include "jobs/store/store_lock.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs::cluster {
namespace {

using Kind = Finding::Kind;

constexpr std::size_t kTrialLogTail = 600;
/// Some impacts: what processors do differently shows.
constexpr const char* kJob =
    R"({"duration_s": 0.3, "run_up_s": 0.1, "clearance_mm": 0.25, "coupler": "flexible"})";

std::string seconds_text(double seconds) {
  const long tenths = std::lround(seconds * 10.0);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " s";
}

std::string with_options(const Site& site) {
  std::string text;
  const std::array<std::pair<const char*, std::string>, 4> options{
      {{"partition", site.partition}, {"account", site.account}, {"QOS", site.qos},
       {"constraint", site.constraint}}};
  for (const auto& [name, value] : options) {
    if (!value.empty()) text += std::string(text.empty() ? " with " : ", ") + name + " " + value;
  }
  return text;
}

/// The trial of one cluster; a member function a step.
class Check {
 public:
  Check(const Site& site, const std::function<void(const Finding&)>& tell)
      : site_(site), tell_(tell), slurm_(site),
        batch_({.seq = 0, .id = "check-" + host_name() + "-" + std::to_string(::getpid()),
                .sweep_id = {}}, site.folder, site.grace) {}

  ~Check() {
    for (const std::string& name : batch_.array_names()) slurm_.cancel_array(name);
    std::error_code ignored;
    std::filesystem::remove_all(batch_.folder().path, ignored);
  }
  Check(const Check&) = delete;
  Check& operator=(const Check&) = delete;

  bool ask_for_limits() {
    std::string problem;
    const auto limits = slurm_.find_limits(problem);
    if (!limits) {
      return fault(problem, "Is this a machine from which jobs are submitted, as a login node? "
                            "If Slurm's commands work on another one, give --slurm-prefix 'ssh THAT-MACHINE "
                            "--'.");
    }
    good("Slurm " + limits->version + " answers; an array may have " +
         std::to_string(limits->max_array_size - 1) + " tasks");
    if (site_.most_tasks() >= limits->max_array_size) {
      warn("--slurm-tasks or --slurm-slots allow more tasks at a time than an array may have",
           "More arrays are made; ask the site whether so many tasks are welcome.");
    }
    return true;
  }

  bool write_into_folder() {
    try {
      program_ = share_program(site_);
      const StoreLock lock(batch_.folder().path);  // as the service does
      write_batch();
    } catch (const std::exception& error) {
      return fault(error.what(),
                   "--slurm-folder must be a folder in which this user may write and lock files, with some "
                   "50 MB of room.");
    }
    good("the shared folder can be written; the program for nodes is " + program_.string());
    return true;
  }

  bool try_options() {
    std::vector<std::string> arguments = slurm_.submit_arguments(order());
    arguments.insert(arguments.begin() + 1, "--test-only");
    const ProcessOutcome outcome = slurm_.run(arguments, site_.submit_deadline);
    if (!outcome.succeeded()) {
      return fault("sbatch would refuse the tasks: " + outcome.text(),
                   "sinfo shows partitions, sacctmgr show assoc user=$USER accounts; give them by "
                   "--slurm-partition, --slurm-account and so on.");
    }
    good("sbatch would take the tasks" + with_options(site_));
    return true;
  }

  bool have_a_job_computed(std::chrono::seconds at_most, const std::function<bool()>& stop_requested) {
    const Submission answer = slurm_.submit(order());
    if (!answer.array_job) return fault(answer.problem, "sbatch --test-only had taken the same.");
    return await_result(at_most, stop_requested);
  }

 private:
  void write_batch() {
    const auto job = nlohmann::json::parse(kJob);
    const std::string parameters = complete_parameters(job, "").dump();
    const BatchHeader header{
        .batch = batch_.row().id, .engine = engine_version(), .limits = {}, .deliver_every_s = 60.0};
    batch_.prepare(header,
                   {{.batch_index = 0, .parameters = parameters, .kind = {}, .duration_s = 0.3}});
    batch_.add_generation(
        {{.indices = {0}}},
        make_script(site_, program_, "run-task " + shell_quoted(batch_.folder().path.string()) + " 0"));
  }

  bool await_result(std::chrono::seconds at_most, const std::function<bool()>& stop_requested) {
    const auto start = Clock::now();
    for (auto next_look = start; Clock::now() - start < at_most && !stop_requested();) {
      if (const auto files = batch_.find_new_results(); !files.empty()) {
        tell_result(decode_results(read_whole(files.front())), start);
        return true;
      }
      if (Clock::now() >= next_look) {
        next_look = Clock::now() + std::min(site_.queue_poll, std::chrono::milliseconds(2'000));
        look();
        if (ended_ && Clock::now() - *ended_ > site_.grace) return no_result();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return too_late(at_most);
  }

  void good(std::string text) { tell_({.kind = Kind::kGood, .text = std::move(text), .advice = {}}); }
  void warn(std::string text, std::string advice) { tell_({.kind = Kind::kWarning, .text = std::move(text),
                                                           .advice = std::move(advice)}); }
  bool fault(std::string text, std::string advice) {
    tell_({.kind = Kind::kFault, .text = std::move(text), .advice = std::move(advice)});
    return false;
  }

  [[nodiscard]] ArrayOrder order() const {
    constexpr double kTime_s = 300.0;
    const BatchFolder& folder = batch_.folder();
    return {.name = batch_.array_name(0), .tasks = 1, .time_s = kTime_s, .memory_factor = 1,
            .folder = folder.path, .script = folder.script(0),
            .log = (folder.path / "log" / "g0-%a.log").string()};
  }

  void look() {
    std::string problem;
    const auto reports = slurm_.observe({batch_.array_name(0)}, problem);
    if (reports) {
      const auto own = batch_.reports_of(*reports);
      if (!own.empty()) last_ = own.begin()->second;
    }
    if (!is_alive(last_.phase) && !ended_) ended_ = Clock::now();
  }

  bool too_late(std::chrono::seconds at_most) {
    return fault(
        "the job has not been computed within " + std::to_string(at_most.count()) + " s; Slurm says " +
            last_.word + ", " + last_.reason,
        is_alive(last_.phase)
            ? "If the queue is long, check again with a larger --wait-s; sinfo shows which nodes are up."
            : "");
  }

  bool no_result() {
    const std::string log = tail_of(batch_.folder().log(0, 0), kTrialLogTail);
    const std::string ended = "the task ended as " + last_.word + " on " + last_.node + " without a result";
    if (log.empty() && !std::filesystem::exists(batch_.folder().log(0, 0))) {
      return fault(ended + " and without a log",
                   "The node does not see the shared folder, or may not write into it: "
                   "--slurm-folder must be on a file system that all nodes have.");
    }
    return fault(ended + "; its log: " + log,
                 "If a library is missing there, --slurm-prologue can load it ('module load gcc').");
  }

  void tell_result(const ResultFile& file, Clock::time_point start) {
    const std::chrono::duration<double> took = Clock::now() - start;
    good("a node, " + file.provenance.host + ", has computed a job; its result was here after " +
         seconds_text(took.count()));
    if (ended_) check_delay(Clock::now() - *ended_);
    compare_with_own(file);
  }

  void check_delay(std::chrono::duration<double> late) {
    const std::string text = "the result showed " + seconds_text(late.count()) + " after the end of the task";
    if (late > site_.grace / 2) warn(text, "Let --slurm-grace-s be some times that.");
  }

  void compare_with_own(const ResultFile& file) {
    const JobSpec job = to_job_spec(complete_parameters(nlohmann::json::parse(kJob), ""));
    const RunRecord own = run_and_record(job, engine_runner(), [](double) { return false; });
    const std::string here = provenance_text(own_provenance()), there = provenance_text(file.provenance);
    const BatchResult& result = file.results.at(0);
    if (result.record.metrics == own.metrics &&
        result.packed_trajectory == encode_trajectory(own.trajectory)) {
      good("it is the result of this machine to the bit (" + there + ")");
    } else {
      warn("it is not the result of this machine to the bit: here " + here + ", there " + there,
           "Results of both are right, but not the same bytes. Let --slurm-constraint choose nodes of one "
           "kind, or give --numerics portable.");
    }
  }

  static std::string provenance_text(const Provenance& from) {
    return from.cpu + ", " + from.libm + ", " + from.numerics + " numerics";
  }

  const Site& site_;
  const std::function<void(const Finding&)>& tell_;
  const Slurm slurm_;
  Batch batch_;
  std::filesystem::path program_;
  TaskReport last_;                         ///< of the task
  std::optional<Clock::time_point> ended_;  ///< time at which the task was first seen to have ended
};

}  // namespace

bool check_cluster(const Site& site, const std::function<void(const Finding&)>& tell,
                   std::chrono::seconds at_most, const std::function<bool()>& stop_requested) {
  Check check(site, tell);
  return check.ask_for_limits() && check.write_into_folder() && check.try_options() &&
         check.have_a_job_computed(at_most, stop_requested);
}

}  // namespace jobs::cluster
