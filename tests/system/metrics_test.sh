#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# /metrics: promtool finds nothing to say about it, and a Prometheus server scrapes it and answers the queries of the dashboard.
#   metrics_test.sh RPSUP DASHBOARD
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
dashboard=$2
# script/setup keeps Debian's programs there, unpacked: as an installed package it would be a service of this machine.
PATH=$PATH:$(dirname "$dashboard")/../../build/prometheus/usr/bin
for program in promtool prometheus; do
  command -v "$program" >/dev/null || { echo "skipped, because not installed: $program (script/setup all)"; exit 77; }
done

# A port for Prometheus, which takes no free one by itself: the one that a service had which has ended.
start_service other.db
port=${url##*:}
stop_service TERM
start_service store.db
cat >sweep.json <<'JSON'
{"parameters": {"duration_s": 0.05, "integrator": "rk4", "step_s": 1e-3}, "sweep": {"clearance_mm": [0, 0.25], "coupler": ["rigid", "flexible"]}}
JSON
id=$(submit sweep.json)
wait_for_end "$id"
failed=$(get "$url/v1/sweeps/$id" | jq .counts.failed)
[ "$failed" -ge 1 ] || fail "no job has failed"

get --include "$url/metrics" | tr -d '\r' >answer
expect_text answer '^Content-Type: text/plain; version=0.0.4'
get "$url/metrics" >metrics
promtool check metrics <metrics >out 2>&1 || { cat out; fail "promtool"; }
expect_equal "$(cat out)" '' "what promtool says"
for metric in jobs_queued jobs_running job_duration_seconds_bucket job_failures_total store_bytes http_request_duration_seconds_bucket build_info; do
  expect_text metrics "^rpsup_$metric"
done

# One that scrapes.
cat >prometheus.yml <<YAML
global: {scrape_interval: 1s}
scrape_configs:
  - job_name: rpsup
    static_configs: [{targets: ["${url#http://}"]}]
YAML
prometheus --config.file=prometheus.yml --storage.tsdb.path=data --web.listen-address="127.0.0.1:$port" >prometheus.log 2>&1 &
scraper=$!
trap 'kill -KILL "$scraper" 2>/dev/null || true; leave' EXIT

# query EXPRESSION: the number of series
query() {
  curl --silent --max-time 20 --get --data-urlencode "query=$1" "http://127.0.0.1:$port/api/v1/query" | jq -r 'if .status == "success" then .data.result | length else .error end'
}
for ((tenths = 0; tenths < 300; ++tenths)); do
  kill -0 "$scraper" 2>/dev/null || { tail -n 5 prometheus.log; fail "prometheus ended"; }
  [ "$(query 'sum(count_over_time(up{job="rpsup"}[1m])) >= 4' || true)" != 1 ] || break
  sleep 0.1
done
expect_equal "$(query 'up{job="rpsup"} == 1')" 1 "services that are up for Prometheus"
expect_equal "$(query "sum(rpsup_job_failures_total) == $failed")" 1 "failures that Prometheus counts"
jq -r '.panels[].targets[] | .expr // empty' "$dashboard" >expressions
[ "$(wc -l <expressions)" -ge 7 ] || fail "the dashboard has no queries for Prometheus"
while read -r expression; do
  [[ $(query "$expression") =~ ^[1-9][0-9]*$ ]] || fail "Prometheus answers to '$expression': $(query "$expression")"
done <expressions
kill -TERM "$scraper"
wait "$scraper" || true
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
echo "promtool and Prometheus take the metrics"
