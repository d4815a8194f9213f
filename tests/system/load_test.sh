#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A dashboard of many panels asks 20 things at once, again and again, while every core computes: each is answered. How fast is told, not
# judged: this machine may be busy with other things.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
cores=$(nproc)
start_service store.db --threads "$cores"
echo '{"parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 20}}}' >small.json
id=$(submit small.json)
wait_for_end "$id"
job=$(get "$url/v1/sweeps/$id/results" | jq -r '.[0].job_id')
echo '{"parameters": {"duration_s": 600, "coupler": "flexible"}, "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 64}}}' >long.json
long=$(submit long.json)
for ((tenths = 0; tenths < 100; ++tenths)); do
  running=$(get "$url/v1/sweeps/$long" | jq .counts.running)
  [ "$running" -lt "$cores" ] || break
  sleep 0.1
done
expect_equal "$running" "$cores" "jobs that run"

paths=(/v1/sweeps "/v1/sweeps/$id" "/v1/sweeps/$long" "/v1/sweeps/$id/results" "/v1/sweeps/$id/results?format=csv" "/v1/jobs?limit=100" "/v1/jobs/$job"
  "/v1/jobs/$job/trajectory" /metrics /healthz)
for ((i = 0; i < 20; ++i)); do
  printf 'url = "%s%s"\noutput = "answer.%d"\n' "$url" "${paths[i % ${#paths[@]}]}" "$i"
done >requests
: >times
for ((round = 0; round < 25; ++round)); do
  curl --no-progress-meter --max-time 20 --parallel --parallel-immediate --parallel-max 20 --write-out '%{http_code} %{time_total}\n' --config requests >>times
done
expect_equal "$(wc -l <times | tr -d ' ')" 500 "answers"
expect_equal "$(cut -d' ' -f1 times | sort -u)" 200 "their statuses"
expect_equal "$(get "$url/v1/sweeps/$long" | jq .counts.running)" "$cores" "jobs that still run"
cut -d' ' -f2 times | sort -n | awk '{ t[NR] = 1000 * $1 } END { printf "500 GETs, 20 at a time, %d jobs running: p50 %.1f ms, p99 %.1f ms, largest %.1f ms\n", '"$cores"', t[int(NR * 0.5)], t[int(NR * 0.99)], t[NR] }'
get -X POST "$url/v1/sweeps/$long/cancel" >/dev/null
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
