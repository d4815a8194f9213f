// Results of a sweep as CSV, over HTTP: what a GET takes and how much memory the server needs for it.
//
// usage: bench_results_csv [jobs]

#include <algorithm>
#include <cstdio>
#include <thread>
#include <vector>

#include "server/http.h"
#include "server/routes.h"
#include "tests/bench/path/made_store.h"
#include "tests/bench/path/measure.h"

#include <httplib.h>  // last: resolv.h defines a macro that Eigen uses as a name

namespace {

using namespace path_bench;

constexpr double kBound_ms = 100.0;
constexpr int kTimes = 15;

}  // namespace

int main(int argc, char** argv) {
  const std::size_t jobs = count_argument(argc, argv, 1, 10'000);
  const Folder folder;
  const std::string id = make_store(folder.file("study.db"), 1, jobs);
  jobs::ServiceOptions options;
  options.store = folder.file("study.db");
  jobs::Service service(options);
  server::Routes routes(service);
  server::HttpServer http(routes, {.port = 0});
  const int port = http.bind();
  std::jthread listener([&] { http.listen(); });

  std::vector<double> cpu_ms;
  std::vector<double> elapsed_ms;
  std::size_t bytes = 0;
  const double before_mib = resident_mib();
  for (int i = 0; i < kTimes; ++i) {
    httplib::Client client("127.0.0.1", port);
    const double cpu = process_cpu_s();
    const double elapsed = wall_s();
    const auto answer = client.Get(("/v1/sweeps/" + id + "/results?format=csv").c_str());
    cpu_ms.push_back(1e3 * (process_cpu_s() - cpu));
    elapsed_ms.push_back(1e3 * (wall_s() - elapsed));
    if (!answer || answer->status != 200) {
      std::fprintf(stderr, "the results cannot be read\n");
      return 1;
    }
    bytes = answer->body.size();
  }
  std::ranges::sort(cpu_ms);
  std::ranges::sort(elapsed_ms);
  const std::string what = std::to_string(jobs) + " results as CSV";
  print_figure(what + ": size", static_cast<double>(bytes) / 1048576.0, "MiB");
  print_figure(what + ": memory of the first reads", resident_mib() - before_mib, "MiB");
  print_figure(what + ": CPU of server and client, median", cpu_ms[kTimes / 2], "ms", kBound_ms);
  print_figure(what + ": passing time, median", elapsed_ms[kTimes / 2], "ms", kBound_ms);
  http.stop();
}
