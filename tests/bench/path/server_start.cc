// SPDX-License-Identifier: Apache-2.0
// Time from the start of the program to its message that it listens, on a store with many jobs.
//
// usage: bench_server_start PROGRAM [sweeps] [jobs of each]

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <vector>

#include "tests/bench/path/made_store.h"
#include "tests/bench/path/measure.h"

namespace {

using namespace path_bench;

constexpr double kBound_s = 0.5;
constexpr int kTimes = 5;

struct Start {
  double elapsed_s = 0.0;
  double memory_mib = 0.0;
};

/// Starts the program, waits for its first line, ends it.
Start start_once(const std::string& program, const std::string& store) {
  int output[2];
  if (::pipe(output) != 0) throw std::runtime_error("no pipe");
  const double begin = wall_s();
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(output[1], STDOUT_FILENO);
    ::close(output[0]);
    ::execl(program.c_str(), program.c_str(), "serve", "--db", store.c_str(), "--port", "0", "--log-level",
            "error", nullptr);
    ::_exit(127);
  }
  ::close(output[1]);
  char text[256];
  const bool ready = ::read(output[0], text, sizeof text) > 0;
  const Start start{.elapsed_s = wall_s() - begin, .memory_mib = ready ? resident_mib(child) : 0.0};
  ::kill(child, SIGTERM);
  ::waitpid(child, nullptr, 0);
  ::close(output[0]);
  if (!ready) throw std::runtime_error("the program did not start");
  return start;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_server_start PROGRAM [sweeps] [jobs of each]\n");
    return 2;
  }
  const std::size_t sweeps = count_argument(argc, argv, 2, 10);
  const std::size_t jobs = count_argument(argc, argv, 3, 10'000);
  const Folder folder;
  const std::string store = folder.file("study.db");
  make_store(store, sweeps, jobs);
  const std::string what = "start on a store of " + std::to_string(sweeps * jobs) + " jobs";
  std::vector<double> elapsed;
  double memory = 0.0;
  for (int i = 0; i < kTimes; ++i) {
    const Start start = start_once(argv[1], store);
    elapsed.push_back(start.elapsed_s);
    memory = start.memory_mib;
  }
  std::ranges::sort(elapsed);
  print_figure(what + ": size of the store",
               static_cast<double>(std::filesystem::file_size(store)) / 1048576.0, "MiB");
  print_figure(what + ": memory of the server", memory, "MiB");
  print_figure(what + ": from exec to the line, median", elapsed[kTimes / 2], "s", kBound_s);
}
