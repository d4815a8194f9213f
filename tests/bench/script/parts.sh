# SPDX-License-Identifier: Apache-2.0
# Table of the parts of a job: the least of some repetitions, by turns. Sourced by script/bench --record; $@ options of Google Benchmark.
measured=$(mktemp)
trap 'rm -f "$measured"' EXIT
"$root/build/bench/bench_parts" --benchmark_min_time=0.05 --benchmark_repetitions=7 --benchmark_enable_random_interleaving=true \
  --benchmark_out="$measured" --benchmark_out_format=json "$@" >&2
echo
echo "| part | CPU |"
echo "|---|---:|"
jq -r '[.benchmarks[] | select(.run_type == "iteration" and (.error_occurred | not))] | group_by(.family_index)[] | min_by(.cpu_time) | [.run_name, .cpu_time, .time_unit] | @tsv' \
  "$measured" | awk -F '\t' '{printf "| %s | %.3g %s |\n", $1, $2, $3}'
