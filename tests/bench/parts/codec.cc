// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <string>

#include <benchmark/benchmark.h>

#include "engine/simulate_rpsup.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "tests/bench/parts/register_parts.h"
#include "tests/bench/support/cases.h"

namespace bench {

namespace {

/// The trajectory of a job with clearance: 1001 samples of all channels.
engine::Trajectory make_trajectory() {
  engine::RpsupParameters parameters = linkage(engine::Coupler::kRigid, 0.25e-3, 10.0);
  parameters.run_up = 0.5;
  engine::Trajectory trajectory = engine::simulate_rpsup(parameters, {.duration = 1.0}, {}).trajectory;
  // as jobs keep them
  for (engine::QuantityInfo& channel : trajectory.channels) channel.single_precision = channel.key != "t_s";
  return trajectory;
}

void encode(benchmark::State& run) {
  const engine::Trajectory trajectory = make_trajectory();
  std::size_t bytes = 0;
  for (auto _ : run) bytes = jobs::encode_trajectory(trajectory).size();
  run.counters["bytes"] = static_cast<double>(bytes);
}

void decode(benchmark::State& run) {
  const std::string blob = jobs::encode_trajectory(make_trajectory());
  for (auto _ : run) benchmark::DoNotOptimize(jobs::decode_trajectory(std::as_bytes(std::span(blob)), {}));
}

}  // namespace

void register_codec() {
  benchmark::RegisterBenchmark("trajectory/encode", encode)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("trajectory/decode", decode)->Unit(benchmark::kMillisecond);
}

}  // namespace bench
