// SPDX-License-Identifier: Apache-2.0
// Results of a sweep as CSV and as JSON with few fields, and a listing, over HTTP: what a GET takes and how
// much memory the server needs.
//
// usage: bench_results_csv [jobs]

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/http/http.h"
#include "server/http/httplib.h"
#include "server/routes/routes.h"
#include "tests/bench/path/made_store.h"
#include "tests/bench/path/measure.h"

namespace {

using namespace path_bench;

constexpr double kBound_ms = 100.0;
constexpr double kBound_mib = 1e6 / 1048576.0;
constexpr int kTimes = 15;

struct Reading {
  double mib = 0.0, cpu_ms = 0.0, elapsed_ms = 0.0;  ///< medians
};

/// Reads a path again and again. @throws std::runtime_error if it cannot be read
Reading read(int port, const std::string& path) {
  std::vector<double> cpu_ms;
  std::vector<double> elapsed_ms;
  Reading reading;
  for (int i = 0; i < kTimes; ++i) {
    httplib::Client client("127.0.0.1", port);
    const double cpu = process_cpu_s();
    const double elapsed = wall_s();
    const auto answer = client.Get(path.c_str());
    cpu_ms.push_back(1e3 * (process_cpu_s() - cpu));
    elapsed_ms.push_back(1e3 * (wall_s() - elapsed));
    if (!answer || answer->status != 200) throw std::runtime_error(path + " cannot be read");
    reading.mib = static_cast<double>(answer->body.size()) / 1048576.0;
  }
  std::ranges::sort(cpu_ms);
  std::ranges::sort(elapsed_ms);
  reading.cpu_ms = cpu_ms[kTimes / 2];
  reading.elapsed_ms = elapsed_ms[kTimes / 2];
  return reading;
}

void print_times(const std::string& what, const Reading& reading) {
  print_figure(what + ": CPU of server and client, median", reading.cpu_ms, "ms", kBound_ms);
  print_figure(what + ": passing time, median", reading.elapsed_ms, "ms", kBound_ms);
}

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
  const std::string results = "/v1/sweeps/" + id + "/results?";

  const double before_mib = resident_mib();
  const Reading csv = read(port, results + "format=csv");
  const std::string as_csv = std::to_string(jobs) + " results as CSV";
  print_figure(as_csv + ": size", csv.mib, "MiB");
  print_figure(as_csv + ": memory of the first reads", resident_mib() - before_mib, "MiB");
  print_times(as_csv, csv);

  const Reading json = read(port, results + "fields=crank_velocity_rad_s,peak_slider_acceleration_m_s2");
  const std::string as_json = std::to_string(jobs) + " results, two fields, JSON";
  print_figure(as_json + ": size", json.mib, "MiB", kBound_mib);
  print_times(as_json, json);

  const Reading list = read(port, "/v1/jobs?fields=id,state&limit=" + std::to_string(jobs));
  const std::string as_list = std::to_string(jobs) + " jobs listed, two fields";
  print_figure(as_list + ": size", list.mib, "MiB", kBound_mib);
  print_times(as_list, list);
  http.stop();
}
