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
expect_code 0 "$rpsup" sweep sweep.json --db one.db --format ndjson
rows_of() { jq -c 'del(.job_id)' "$1"; }
expect_equal "$(rows_of out)" "$(rows_of one.ndjson)" "rows on standard output in the format that is asked for"
for name in one.parquet one.txt one.npz; do
  expect_code 2 "$rpsup" sweep sweep.json --db none.db --results $name
  expect_text err "^rpsup: --results $name: the name of a table must end in \.json, \.csv or \.ndjson$"
done
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

# No output is written over a file that the command reads, nor over the store: by its name, by a link of either kind, before there is a
# store, and as standard output.
cp sweep.json kept.json
ln -s kept.json symbolic.csv
ln kept.json hard.csv
ln -s not_yet.db later.csv
refuse() { expect_code 2 "$@" && expect_text err 'is the same file as'; }
for output in kept.json symbolic.csv hard.csv ./kept.json; do
  refuse "$rpsup" sweep kept.json --db not_yet.db --results "$output"
done
for output in not_yet.db ./not_yet.db later.csv not_yet.db-wal not_yet.db-shm not_yet.db.lock; do
  refuse "$rpsup" sweep kept.json --db not_yet.db --results "$output"
done
ln -s one.db link.db
for output in one.db link.db; do
  refuse "$rpsup" sweep kept.json --db link.db --results "$output"
  RPSUP_RESULTS=$output refuse "$rpsup" sweep kept.json --db one.db
done
code=0
"$rpsup" sweep - --db other.db <kept.json >>kept.json 2>err || code=$?
expect_equal "$code" 2 "exit code with standard input as the output"
"$rpsup" sweep kept.json --db one.db >>one.db 2>err && fail "the table was added to the store"
expect_text err 'standard output: is the same file as --db one.db'
expect_code 2 "$rpsup" export --db one.db one.db-wal
cmp kept.json sweep.json || fail "an input has changed"
expect_equal "$(sqlite3 one.db 'PRAGMA integrity_check')" ok "the store"
[ ! -e not_yet.db ] || fail "a refused command has made a store"
echo '{"duration_s": 0.05}' >p.json
ln -s p.json p.csv
refuse "$rpsup" simulate p.json --trajectory p.csv
ln -s t.csv t.svg
refuse "$rpsup" simulate p.json --trajectory t.csv --plot t.svg
expect_equal "$(cat p.json)" '{"duration_s": 0.05}' "the parameters"

# An output is the old file or the whole new one: other names of the old file keep it, a link leads to the new one, and the mode stays.
echo old >table.csv
chmod 640 table.csv
ln table.csv old_name.csv
ln -s table.csv link.csv
expect_code 0 "$rpsup" sweep sweep.json --db one.db --results link.csv
expect_equal "$(cat old_name.csv)" old "the former file under its other name"
expect_equal "$(readlink link.csv) $(stat --format=%a table.csv) $(head -c 6 table.csv)" 'table.csv 640 job_id' "the new file"
[ -z "$(find . -name '*.part')" ] || fail "a part of an output is left over"

# A job that fails: 1, and its row is there.
cat >fails.json <<'JSON'
{"parameters": {"duration_s": 0.05, "integrator": "rk4", "step_s": 1e-3}, "sweep": {"clearance_mm": [0, 0.25]}}
JSON
expect_code 1 "$rpsup" sweep fails.json --db fails.db --results fails.csv
expect_equal "$(cut -d, -f2 fails.csv | tr -d '\r' | tr '\n' ' ')" 'state succeeded failed ' "states"
echo "sweep works"
