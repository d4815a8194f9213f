// SPDX-License-Identifier: Apache-2.0
// A service with a fake cluster of 10,000 slots, and a number of jobs of a millisecond: what they cost the
// service, and whether it grows.
//   capacity JOBS [SAMPLES]  the trial; of each trajectory, 3 if left out
//   capacity --slurm FOLDER sbatch|squeue|scancel|scontrol ...   the cluster's commands
//   capacity --nodes FOLDER SAMPLES   its nodes: computes what was submitted until FOLDER/stop is there

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "jobs/cluster/run_task.h"
#include "jobs/service.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr int kSlots = 10'000;
constexpr int kJobsOfASweep = 10'000;
constexpr int kNodeThreads = 64;
constexpr int kFewSamples = 3;

/// A line of FOLDER/arrays.
struct Array {
  std::string name;
  int tasks = 0;
  std::string batch;
  int generation = 0;
};

std::vector<Array> read_arrays(const fs::path& folder) {
  std::ifstream in(folder / "arrays");
  std::vector<Array> arrays;
  for (Array next; in >> next.name >> next.tasks >> next.batch >> next.generation;) arrays.push_back(next);
  return arrays;
}

/// The names of arrays that have been computed.
std::set<std::string> read_done(const fs::path& folder) {
  std::ifstream in(folder / "done");
  std::set<std::string> done;
  for (std::string name; in >> name;) done.insert(name);
  return done;
}

void append_line(const fs::path& file, const std::string& line) {
  // One write: others read at the same time.
  std::ofstream out(file, std::ios::app);
  out << line + "\n" << std::flush;
}

std::string value_of(const std::vector<std::string>& words, const std::string& option) {
  for (const std::string& word : words) {
    if (word.starts_with(option + "=")) return word.substr(option.size() + 1);
  }
  return "";
}

int submit(const fs::path& folder, const std::vector<std::string>& words) {
  const std::string array = value_of(words, "--array");
  const int last = std::stoi(array.substr(array.find('-') + 1));
  const fs::path script = words.back();
  const std::string generation = script.stem().string().substr(1);
  const std::string line = value_of(words, "--job-name") + " " + std::to_string(last + 1) + " " +
                           script.parent_path().string() + " " + generation;
  append_line(folder / "arrays", line);
  std::cout << "1\n";
  return 0;
}

int show_queue(const fs::path& folder, const std::vector<std::string>& words) {
  const auto done = read_done(folder);
  const std::string names = "," + value_of(words, "--name") + ",";
  for (const Array& array : read_arrays(folder)) {
    if (names.find("," + array.name + ",") == std::string::npos) continue;
    for (int i = 0; i < array.tasks; ++i) {
      std::cout << array.name << "|1|" << i
                << (done.contains(array.name) ? "|COMPLETED|1|n1|None\n" : "|RUNNING|1|n1|None\n");
    }
  }
  return 0;
}

int run_command(const fs::path& folder, const std::vector<std::string>& words) {
  if (words.front() == "sbatch") return submit(folder, words);
  if (words.front() == "squeue") return show_queue(folder, words);
  if (words.front() == "scontrol")
    std::cout << "MaxArraySize = " << kSlots + 1 << "\nSLURM_VERSION = 22.05\n";
  return 0;
}

/// As hard to pack as what is computed: the low bits are chance.
std::vector<double> rough_column(double start, int samples) {
  std::vector<double> column;
  for (double x = start; samples-- > 0; x = 3.9 * x * (1.0 - x)) column.push_back(x);
  return column;
}

engine::RunResult millisecond_run(const jobs::JobSpec& spec, int samples) {
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  engine::RunResult result;
  result.metrics.assign(engine::metric_table().size(), spec.parameters.crank_velocity);
  result.trajectory.channels = {{.key = "t_s", .help = "Time"},
                                {.key = "slider_position_m", .help = "Position"}};
  result.trajectory.columns = {{}, rough_column(0.05 * spec.parameters.crank_velocity, samples)};
  for (int k = 0; k < samples; ++k) result.trajectory.columns[0].push_back(k / 1000.0);
  return result;
}

int run_nodes(const fs::path& folder, int samples) {
  const jobs::Runner runner = [samples](const jobs::JobSpec& spec, const engine::StopQuery&) {
    return millisecond_run(spec, samples);
  };
  std::set<std::string> done;
  while (!fs::exists(folder / "stop")) {
    for (const Array& array : read_arrays(folder)) {
      if (!done.insert(array.name).second) continue;
      for (int i = 0; i < array.tasks; ++i) {
        (void)jobs::cluster::run_task(
            {.folder = array.batch,
             .generation = array.generation,
             .index = i,
             .threads = kNodeThreads,
             .runner = runner},
            [] { return false; }, [](const std::string& text) { std::cerr << text << '\n'; });
      }
      append_line(folder / "done", array.name);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return 0;
}

double own_cpu_s() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double resident_mb() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  }
  throw std::runtime_error("the kernel does not tell this process's size");
}

double bytes_of(const fs::path& store) {
  double bytes = 0.0;
  for (const char* const end : {"", "-wal"}) {
    std::error_code none;
    const auto size = fs::file_size(store.string() + end, none);
    if (!none) bytes += static_cast<double>(size);
  }
  return bytes;
}

/// 100 speeds by 100 clearances, for each sweep with another restitution.
ordered_json make_sweep(int number) {
  return {{"parameters", {{"restitution", 0.5 + 1e-4 * number}, {"duration_s", 1.0}, {"run_up_s", 0.5}}},
          {"sweep", {{"clearance_mm", {{"from", 0.1}, {"to", 0.5}, {"count", 100}}},
                     {"crank_velocity_rad_s", {{"from", 5}, {"to", 12}, {"count", 100}}}}}};
}

jobs::ServiceOptions make_options(const fs::path& folder) {
  jobs::ServiceOptions options;
  options.store = folder / "store.db";
  options.threads = 1;
  options.executor = "slurm";
  options.site.folder = folder;
  options.site.program = "/bin/true";
  options.site.prefix = {"/proc/" + std::to_string(::getpid()) + "/exe", "--slurm", folder.string()};
  options.site.slots = kSlots;
  options.site.queue_poll = std::chrono::milliseconds(1'000);
  options.site.folder_poll = std::chrono::milliseconds(100);
  options.log = [](const std::string& text) { std::cerr << text << '\n'; };
  return options;
}

void check(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error("failed: " + what);
}

/// Prints what a job costs; how long it takes is not judged, as sanitizers and busy machines have times of
/// their own.
int try_out(int count, const fs::path& folder) {
  jobs::Service service(make_options(folder));
  const int sweeps = count / kJobsOfASweep;
  double early_mb = 0.0, largest_mb = 0.0, planning_cpu_s = 0.0;
  std::vector<std::string> ids;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < sweeps; ++i) {
    const double before_s = own_cpu_s();
    ids.push_back(service.submit_sweep(make_sweep(i)).at("id"));
    planning_cpu_s += own_cpu_s() - before_s;
    // A few are under way at a time, as the queue's limit would have it.
    if (i >= 3)
      check(service.wait_for_sweep(ids[static_cast<std::size_t>(i) - 3], std::chrono::minutes(10)),
            "a sweep has not ended");
    const double now_mb = resident_mb();
    if (i < std::max(5, sweeps / 5)) early_mb = std::max(early_mb, now_mb);
    largest_mb = std::max(largest_mb, now_mb);
  }
  for (const std::string& id : ids) {
    check(service.wait_for_sweep(id, std::chrono::minutes(10)), "a sweep has not ended");
    check(service.find_sweep(id)->at("counts").at("succeeded") == kJobsOfASweep, "a sweep has not succeeded");
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const double jobs = static_cast<double>(sweeps) * kJobsOfASweep;
  const double cpu_ms = 1e3 * own_cpu_s() / jobs;
  std::printf(
      "%.0f jobs in %.0f s: %.3f ms of the service's time a job (%.3f of it while sweeps are submitted), "
      "%.0f bytes of store a job,\n"
      "%.0f MB of memory in the first fifth, %.0f MB at most\n",
      jobs, took.count(), cpu_ms, 1e3 * planning_cpu_s / jobs, bytes_of(folder / "store.db") / jobs, early_mb,
      largest_mb);
  check(largest_mb < 1.25 * early_mb, "the service grows");
  return 0;
}

/// The nodes are a process of their own: their time and memory are not the service's.
pid_t start_nodes(const fs::path& folder, int samples) {
  const pid_t nodes = ::fork();
  if (nodes == 0) {
    const std::string text = folder.string(), count = std::to_string(samples);
    ::execl("/proc/self/exe", "capacity", "--nodes", text.c_str(), count.c_str(), nullptr);
    std::_Exit(1);
  }
  return nodes;
}

int run_trial(int count, int samples) {
  std::string pattern = (fs::temp_directory_path() / "rpsup-capacity-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const fs::path folder = pattern;
  const pid_t nodes = start_nodes(folder, samples);
  int code = 1;
  try {
    code = try_out(count, folder);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  std::ofstream(folder / "stop").flush();
  ::waitpid(nodes, nullptr, 0);
  fs::remove_all(folder);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() >= 3 && words[0] == "--slurm")
    return run_command(words[1], {words.begin() + 2, words.end()});
  if (words.size() == 3 && words[0] == "--nodes") return run_nodes(words[1], std::stoi(words[2]));
  return run_trial(std::stoi(words.at(0)), words.size() > 1 ? std::stoi(words[1]) : kFewSamples);
}
