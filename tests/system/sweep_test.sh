#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup sweep: a sweep without a server, interrupted and taken up again, on one thread and on two.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

cat >sweep.json <<'JSON'
{"name": "small", "parameters": {"duration_s": 0.1, "run_up_s": 0.05},
 "sweep": {"clearance_mm": [0, 0.25, 0.5], "crank_velocity_rad_s": [5, 12]}}
JSON

expect_code 0 "$rpsup" sweep sweep.json --db one.db --results one.csv --threads 1
expect_text err '^6 of 6 jobs$'
expect_equal "$(wc -l <one.csv | tr -d ' ')" 7 "lines of the results"
expect_equal "$(head -n 1 one.csv | cut -d, -f1-4 | tr -d '\r')" job_id,state,clearance_mm,crank_velocity_rad_s "columns"
expect_equal "$(wc -c <out | tr -d ' ')" 0 "bytes on standard output beside --results"

# Two threads and standard output: the same bytes.
expect_code 0 "$rpsup" sweep - --db two.db --threads 2 <sweep.json
without_job_id <out >two.txt
without_job_id <one.csv | cmp - two.txt

# Again on the same store: the same bytes, and nothing is computed.
expect_code 0 "$rpsup" sweep sweep.json --db one.db --results again.csv
without_job_id <again.csv | cmp - two.txt

# JSON where the name says so. A folder that is missing is said before anything is computed.
expect_code 0 "$rpsup" sweep sweep.json --db one.db --results one.json
expect_equal "$(jq -c '[length, .[0].state]' one.json)" '[6,"succeeded"]' "rows of the results as JSON"
expect_code 0 "$rpsup" sweep sweep.json --db one.db --results one.ndjson
expect_equal "$(jq -s length one.ndjson)" 6 "rows of the results line by line"
expect_code 2 "$rpsup" sweep sweep.json --db none.db --results nowhere/one.csv
expect_text err '^rpsup: --results nowhere/one.csv: there is no folder .*/nowhere$'
mkdir folder
expect_code 2 "$rpsup" sweep sweep.json --db none.db --results folder
expect_text err '^rpsup: --results folder: it is a folder$'
expect_equal "$(test -e none.db && echo there || echo none)" none "store of a sweep whose results have no place"

# Interrupted, then given again: it ends with what an undisturbed sweep gives.
cat >longer.json <<'JSON'
{"parameters": {"duration_s": 3, "run_up_s": 0.05, "coupler": "flexible"}, "sweep": {"clearance_mm": [0.1, 0.2, 0.3, 0.4]}}
JSON
"$rpsup" sweep longer.json --db broken.db --results broken.csv --threads 1 >/dev/null 2>progress &
service=$!
for ((tenths = 0; tenths < 600; ++tenths)); do
  ! grep -qE '^[123] of 4' progress || break
  sleep 0.1
done
stop_service TERM
expect_equal "$code" 130 "exit code of an interrupted sweep"
expect_text progress 'interrupted'
[ ! -e broken.csv ] || fail "an interrupted sweep has written results"
expect_code 0 "$rpsup" sweep longer.json --db broken.db --results broken.csv
expect_code 0 "$rpsup" sweep longer.json --db whole.db --results whole.csv
expect_equal "$(without_job_id <broken.csv | cksum)" "$(without_job_id <whole.csv | cksum)" "results after an interruption"

# Bad input: 2, with pointers; and no store is left behind for a file that cannot be read.
echo '{"sweep": {"clearance_mm": [0, -1]}, "parameters": {"nonsense": 1}}' >bad.json
expect_code 2 "$rpsup" sweep bad.json --db one.db
expect_text err '^/sweep/clearance_mm/1: '
expect_text err '^/parameters/nonsense: '
expect_code 2 "$rpsup" sweep missing.json --db none.db
[ ! -e none.db ] || fail "a store was made for nothing"
expect_code 3 "$rpsup" sweep sweep.json --db nowhere/a.db

# A job that fails: 1, and its row is there.
cat >fails.json <<'JSON'
{"parameters": {"duration_s": 0.05, "integrator": "rk4", "step_s": 1e-3}, "sweep": {"clearance_mm": [0, 0.25]}}
JSON
expect_code 1 "$rpsup" sweep fails.json --db fails.db --results fails.csv
expect_equal "$(cut -d, -f2 fails.csv | tr -d '\r' | tr '\n' ' ')" 'state succeeded failed ' "states"
echo "sweep works"
