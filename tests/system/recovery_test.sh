#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Killed in the middle of a sweep, the service takes it up again by itself: the results are, byte for byte, those of a
# service that nobody disturbed, on one thread and on two.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

cat >sweep.json <<'JSON'
{"name": "recovery", "parameters": {"duration_s": 2, "run_up_s": 0.05},
 "sweep": {"clearance_mm": [0.1, 0.25, 0.5], "coupler": ["rigid", "flexible"]}}
JSON

undisturbed() {
  start_service "$1" --threads "$2"
  local id
  id=$(submit sweep.json)
  wait_for_end "$id"
  expect_equal "$state" succeeded "state with $2 threads"
  results "$id" >"$3"
  stop_service TERM
  expect_equal "$code" 0 "exit code"
}
undisturbed one.db 1 one.csv
undisturbed two.db 2 two.csv
cmp one.csv two.csv
expect_equal "$(wc -l <one.csv | tr -d ' ')" 7 "lines of the results"

# Killed again and again, each time a little later, until it has all been computed.
start_service killed.db --threads 2
id=$(submit sweep.json)
kills=0
taken_up=0
for pause in 0.1 0.3 0.5; do
  sleep "$pause"
  counts=$(get "$url/v1/sweeps/$id" | jq -c .counts)
  stop_service KILL
  kills=$((kills + 1))
  start_service killed.db --threads 2
  echo "killed at $counts"
  case "$(get "$url/v1/sweeps/$id" | jq -r .state)" in queued | running) taken_up=$((taken_up + 1)) ;; *) break ;; esac
done
[ "$taken_up" -ge 1 ] || fail "the sweep was over before the first kill"
wait_for_end "$id"
expect_equal "$state" succeeded "state after $kills kills"
results "$id" >killed.csv
cmp one.csv killed.csv
stop_service TERM
expect_equal "$(sqlite3 killed.db 'pragma integrity_check; pragma foreign_key_check')" ok "the store after $kills kills"
expect_equal "$(sqlite3 killed.db 'select count(*) from results')" 6 "results, one for each content"
echo "recovery works"
