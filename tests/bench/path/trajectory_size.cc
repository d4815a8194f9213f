// SPDX-License-Identifier: Apache-2.0
// Size of a stored trajectory beside the JSON of the service's answer, all channels, default output (5 s at
// 1 kHz), and the cost of encoding and decoding the trajectory.

#include "jobs/results/table_json.h"
#include "jobs/run_job.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "tests/bench/path/measure.h"

namespace {

using namespace path_bench;

constexpr double kBound = 12.0;

}  // namespace

int main() {
  for (const Kind& kind : job_kinds()) {
    const engine::Trajectory trajectory =
        jobs::run_job(kind.parameters, [](double) { return false; }).trajectory;
    constexpr int kTimes = 20;
    std::string blob;
    const double cpu = thread_cpu_s();
    for (int i = 0; i < kTimes; ++i) blob = jobs::encode_trajectory(trajectory);
    const double encoded = thread_cpu_s();
    for (int i = 0; i < kTimes; ++i) (void)jobs::decode_trajectory(std::as_bytes(std::span(blob)), {});
    const double decoded = thread_cpu_s();
    const double json_bytes = static_cast<double>(jobs::to_json_columns(trajectory).size());
    const double engine_json_bytes =
        static_cast<double>(jobs::to_json_columns(simulate(kind.parameters).trajectory).size());
    const double values = static_cast<double>(trajectory.columns.size() * trajectory.columns.front().size());
    print_figure(kind.name + ": values", values, "");
    print_figure(kind.name + ": bytes a value in JSON", json_bytes / values, "B");
    print_figure(kind.name + ": bytes a value stored", static_cast<double>(blob.size()) / values, "B");
    print_figure(kind.name + ": encode, CPU", 1e3 * (encoded - cpu) / kTimes, "ms");
    print_figure(kind.name + ": decode all, CPU", 1e3 * (decoded - encoded) / kTimes, "ms");
    print_ratio(kind.name + ": JSON over stored", json_bytes / static_cast<double>(blob.size()), kBound);
    print_ratio(kind.name + ": JSON of the engine's own digits over stored",
                engine_json_bytes / static_cast<double>(blob.size()), kBound);
  }
}
