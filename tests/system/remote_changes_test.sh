#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup retry, extend, move, delete, trajectory, report, open, and the queries of results: each does what its route does.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

start_service store.db
export RPSUP_URL=$url

cat >sweep.json <<'JSON'
{"name": "changes", "parameters": {"duration_s": 0.2, "run_up_s": 0.05}, "sweep": {"clearance_mm": [0, 0.3], "coupler": ["rigid", "flexible"]}}
JSON
id=$("$rpsup" submit sweep.json --watch 2>/dev/null)

# Rows and columns of the results: the bytes of the route's query.
peak=peak_slider_acceleration_m_s2
expect_code 0 "$rpsup" results "$id" --fields "job_id,clearance_mm,$peak" --where coupler=rigid --where 'clearance_mm > 0.1' --format json
cmp out <(get "$url/v1/sweeps/$id/results?fields=job_id,clearance_mm,$peak&coupler=rigid&clearance_mm_gt=0.1")
expect_equal "$(jq -c '[length, (.[0] | keys_unsorted | length)]' out)" '[1,3]' "rows and columns"
job=$(jq -r '.[0].job_id' out)
expect_code 0 "$rpsup" results "$id" --order-by="-clearance_mm,coupler" --limit 2 --fields clearance_mm,coupler
expect_equal "$(tr -d '\r' <out | tr '\n' ' ')" 'clearance_mm,coupler 0.3,flexible 0.3,rigid ' "ordered rows"
for condition in 'clearance_mm>=0.3' 'clearance_mm<=0' 'clearance_mm < 0.3' 'clearance_mm == 0'; do
  expect_code 0 "$rpsup" results "$id" --where "$condition" --fields job_id
  expect_equal "$(wc -l <out | tr -d ' ')" 3 "rows with $condition, and their heading"
done
for condition in clearance_mm '=1' 'clearance_mm=' 'clearance_mm != 0' 'clearance_mm => 0'; do
  expect_code 2 "$rpsup" results "$id" --where "$condition"
  expect_text err "^rpsup: --where $condition: must be a column, one of = < > <= >= and a value$"
done
expect_code 2 "$rpsup" results "$id" --where nonsense=1 --order-by nothing --limit many
expect_text err '^/nonsense: '
expect_text err '^/limit: '
expect_code 2 "$rpsup" results "$id" --output rows.parquet
expect_text err '^rpsup: --output rows.parquet: the name of a table must end in \.json, \.csv or \.ndjson$'
expect_code 0 "$rpsup" results "$id" --output rows.ndjson
cmp rows.ndjson <(get "$url/v1/sweeps/$id/results?format=ndjson")
[ ! -e rows.parquet ] || fail "a refused output was written"

# Lists of other kinds.
expect_code 0 "$rpsup" status --kind job --limit 1 --state succeeded
expect_equal "$(wc -l <out | tr -d ' ')" 2 "one job and the heading"
expect_text out '^job_[a-z0-9]+ +succeeded +- +- +-  -$'
expect_code 0 "$rpsup" status --kind job --state failed
expect_equal "$(wc -l <out | tr -d ' ')" 1 "failed jobs and the heading"
expect_code 0 "$rpsup" status --kind fit --json
expect_equal "$(jq -c .items out)" '[]' "fits"
expect_code 2 "$rpsup" status "$id" --kind job
expect_code 2 "$rpsup" status --state nothing

# A trajectory.
expect_code 0 "$rpsup" trajectory "$job" --channels slider_acceleration_m_s2 --from 0.1 --to 0.15 --points 20
cmp out <(get "$url/v1/jobs/$job/trajectory?channels=slider_acceleration_m_s2&from=0.1&to=0.15&points=20&format=csv")
expect_code 0 "$rpsup" trajectory "$job" --output run.npz
cmp run.npz <(get "$url/v1/jobs/$job/trajectory?format=npz")
expect_code 0 "$rpsup" trajectory "$job" --format json --output -
expect_equal "$(jq -r '.channels[0]' out)" t_s "the first channel as JSON"
expect_code 2 "$rpsup" trajectory "$job" --output run.ndjson
expect_text err '^rpsup: --output run.ndjson: the name of a trajectory must end in \.json, \.csv or \.npz$'
expect_code 2 "$rpsup" trajectory "$job" --channels nothing
expect_text err 'nothing'
expect_code 0 "$rpsup" trajectory "$id" --output all.npz
cmp all.npz <(get "$url/v1/sweeps/$id/trajectories?format=npz")
expect_code 2 "$rpsup" trajectory "$id" --output all.csv
expect_text err '^rpsup: --output all.csv: the name of a file of trajectories must end in \.h5, \.mat or \.npz$'
expect_code 2 "$rpsup" trajectory "$id" --points 20 --output all.h5
expect_text err 'for a job or a measurement'
expect_code 2 "$rpsup" trajectory "${id/swp_/sch_}"
expect_text err "^rpsup: trajectory ${id/swp_/sch_}: is no id of a job, sweep or measurement$"
printf 'time_s,acc\n0,1\n0.1,2\n' >bench.csv
measured=$("$rpsup" measure bench.csv --channel acc=slider_acceleration_m_s2)
expect_code 0 "$rpsup" trajectory "$measured"
expect_equal "$(tail -n 1 out | tr -d '\r')" '0.1,2' "the last sample of a measurement"
expect_code 0 "$rpsup" status "$measured"
expect_text out '^channel +slider_acceleration_m_s2, m/s²$'
expect_code 0 "$rpsup" status --kind measurement
expect_text out "^$measured +- +- +- +-  bench.csv$"

# The report, and links of the dashboard.
expect_code 0 "$rpsup" report "$id" --output report.html
expect_text report.html '</html>'
cmp report.html <(get "$url/v1/sweeps/$id/report")
expect_code 0 "$rpsup" report "$id" --metric impact_count --rows --output counts.html
expect_text counts.html 'Largest impact count'
expect_text counts.html 'Appendix: all jobs'
expect_code 2 "$rpsup" report "$id" --metric beauty --output counts.html
expect_code 2 "$rpsup" report "$id" --output report.pdf
expect_text err '^rpsup: --output report.pdf: the name must end in \.html$'
expect_code 0 "$rpsup" open "$id" "$job" "$measured"
expect_equal "$(tr '\n' ' ' <out)" "$url/#/sweeps/$id $url/#/jobs/$job $url/#/measurements/$measured " "links"
expect_code 2 "$rpsup" open swp_none

# Extended: only the new jobs run.
echo '{"sweep": {"clearance_mm": [0.2]}}' >more.json
expect_code 0 "$rpsup" extend "$id" more.json --watch
expect_text err '^6 of 6 jobs$'
expect_equal "$(get "$url/v1/sweeps/$id/results" | jq -r .[].job_id | grep -c "$job")" 1 "the job that was there before"
expect_code 2 "$rpsup" extend "$job" more.json
expect_text err "^rpsup: extend $job: is no id of a sweep$"

# Cancelled, then tried again. Cancelled and failed jobs leave the bar open.
echo '{"parameters": {"duration_s": 3600, "output_rate_hz": 10}, "sweep": {"clearance_mm": [0.3, 0.4, 0.5]}}' >long.json
long=$("$rpsup" submit long.json)
if has_terminals; then
  # script(1) writes late without --flush, and can lose what a program prints as its last.
  script --quiet --flush --return --command "stty cols 70 rows 24; $rpsup watch $long; code=\$?; sleep 0.3; exit \$code" terminal </dev/null >/dev/null &
  watcher=$!
  for ((tenths = 0; tenths < 100; ++tenths)); do
    ! grep -q 'job_.*  clearance_mm 0\.' terminal 2>/dev/null || break
    sleep 0.1
  done
fi
expect_code 0 "$rpsup" move "$long" --executor local
expect_equal "$(cat out)" "$long running" "what move says"
expect_code 2 "$rpsup" move "$long" --executor slurm
expect_code 2 "$rpsup" move "$long"
expect_code 2 "$rpsup" delete "$long"
expect_text err '^rpsup: the sweep has not ended'
expect_code 0 "$rpsup" cancel "$long"
if has_terminals; then
  code=0
  wait "$watcher" || code=$?
  expect_equal "$code" 1 "exit code of a watch over a cancelled sweep"
  grep -qF '3 of 3 jobs, 3 cancelled' terminal || fail "the end is not shown"
  grep -q 'job_.*  clearance_mm 0\.' terminal || fail "no running job was shown"
  ! grep -qF '###' terminal || fail "the bar of a cancelled sweep is filled"
fi
expect_code 0 "$rpsup" retry "$long"
expect_text out "^$long (queued|running)$"
expect_code 0 "$rpsup" cancel "$long"
expect_code 2 "$rpsup" retry "$job"
expect_text err "^rpsup: retry $job: is no id of a sweep, search, wear study, optimisation or fit$"

# Deleted, several kinds at once; one id that is none deletes nothing.
single=$("$rpsup" submit --kind job - <<<'{"duration_s": 0.05}')
code=0
"$rpsup" watch "$single" 2>/dev/null || code=$?
expect_equal "$code" 0 "exit code of a watch over a job"
expect_code 2 "$rpsup" delete "$single" nothing
expect_code 0 "$rpsup" status "$single"
expect_code 0 "$rpsup" delete "$long" "$single" "$measured"
expect_equal "$(tr '\n' ' ' <out)" "$long deleted $single deleted $measured deleted " "what delete says"
expect_code 2 "$rpsup" status "$single"
expect_text err "^rpsup: there is no job $single$"
expect_code 2 "$rpsup" delete "$job"
expect_text err 'sweep'

# Options before the command, and words that are misspelt.
unset RPSUP_URL
expect_code 0 "$rpsup" --url "$url" status "$id"
expect_code 0 "$rpsup" --url="$url" --json status "$id"
expect_equal "$(jq -r .id out)" "$id" "the id after options before the command"
expect_code 2 "$rpsup" stauts
expect_equal "$(cat err)" 'rpsup: there is no command stauts; did you mean status?' "a misspelt command"
expect_code 2 "$rpsup" --url "$url" resluts "$id"
expect_equal "$(cat err)" 'rpsup: there is no command resluts; did you mean results?' "a misspelt command after an option"
expect_code 2 "$rpsup" status --ulr="$url"
expect_equal "$(cat err)" 'rpsup: there is no option --ulr of status; did you mean --url?' "a misspelt option"

stop_service TERM
for words in "retry $id" "delete $id" "extend $id more.json" "move $id --executor local" "trajectory $job" "report $id" "open $id" "status --ids status"; do
  # shellcheck disable=SC2086  # the words are arguments
  expect_code 3 "$rpsup" --url "$url" $words
  expect_text err "no answer from $url: nothing answers there"
done
echo "the commands that change a service work"
