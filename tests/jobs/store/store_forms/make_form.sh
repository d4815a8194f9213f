#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Writes a store as a program makes it, for the test that later programs take it over: make_form.sh RPSUP >form_N.sql
# To be run before a change of the store's form, with the last program that does not know it.
set -euo pipefail

rpsup=$(realpath "$1")
folder=$(mktemp -d)
service=
leave() {
  if [ -n "$service" ]; then kill "$service" && wait "$service"; fi
  rm -rf "$folder"
}
trap leave EXIT
cd "$folder"

"$rpsup" serve --db store.db --port 0 >said 2>log &
service=$!
until url=$(grep -o 'http://[0-9.:]*' said 2>/dev/null); do sleep 0.1; done

# post PATH KEY BODY: prints the id of what was made
post() { curl --silent --fail --header "Idempotency-Key: $2" --data "$3" "$url/v1/$1" | jq -r .id; }

# await PATH: until it has ended
await() {
  until curl --silent --fail "$url/v1/$1" | jq -e '.state | IN("succeeded", "failed", "cancelled")' >ended; do sleep 0.1; done
}

run='"duration_s": 0.01, "run_up_s": 0.005, "output_rate_hz": 100'
sweep=$(post sweeps sweep-key "{\"name\": \"kept\", \"priority\": 3, \"parameters\": {$run}, \"sweep\": {\"clearance_mm\": [0, 0.3]}}")
await "sweeps/$sweep"
# Programs of forms 1 and 2 know no searches.
search=$(post searches search-key "{\"name\": \"limit\", \"parameters\": {$run}, \"over\": {\"clearance_mm\": {\"from\": 0.1, \"to\": 0.4, \"tolerance\": 0.2}},
  \"metric\": \"peak_slider_acceleration_m_s2\", \"bound\": 1e9}" || true)
if [ -n "$search" ]; then await "searches/$search"; fi

kill "$service"
wait "$service" || true
service=
sqlite3 store.db .dump
