// SPDX-License-Identifier: Apache-2.0
// The parts of a job, each by itself, with Google Benchmark: bench_parts --help

#include <benchmark/benchmark.h>

#include "tests/bench/parts/register_parts.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  bench::register_evaluations();
  bench::register_runs();
  bench::register_codec();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
