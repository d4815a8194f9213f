#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup search, wear, optimise, fit and sweep: the same answers with a store of their own and by a running service.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

start_service store.db

common='"parameters": {"duration_s": 0.2, "run_up_s": 0.1}'
printf '{%s, "sweep": {"coupler": ["rigid", "flexible"]}}' "$common" >sweep.json
printf '{%s, "over": {"clearance_mm": {"from": 0.02, "to": 0.3, "tolerance": 0.1}}, "metric": "peak_contact_force_n", "bound": 0, "sweep": {"coupler": ["rigid"]}}' \
  "$common" >search.json
printf '{%s, "hours": 100, "max_cycles": 3}' "$common" >wear.json
printf '{%s, "over": {"clearance_mm": {"from": 0.1, "to": 0.3}}, "objectives": [{"metric": "peak_slider_acceleration_m_s2"}], "budget": 10, "population": 5, "starts": 1}' \
  "$common" >optimise.json
echo '{"duration_s": 0.2, "run_up_s": 0.05, "clearance_mm": 0}' >rig.json
"$rpsup" simulate rig.json --trajectory rig.csv --channels slider_position_m >/dev/null
cat >fit.json <<'JSON'
{"parameters": {"run_up_s": 0.05},
 "over": {"sensor.slider_position_m.gain": {"from": 0.5, "to": 2}}, "intervals": "linearised", "budget": 60,
 "measurements": [{"file": "rig.csv", "columns": ["slider_position_m:slider_position_m"],
                   "sensors": {"slider_position_m": {"offset": 0}}, "parameters": {"clearance_mm": 0}}]}
JSON

answers() { grep -vE '^(sweep|search|wear study|optimisation|fit|swp|sch|wst|opt|fit_)|^[0-9]+ of [0-9]+ jobs' err || true; }
rows_of() { jq -c 'map(del(.job_id, .job_ids))' "$1"; }
for command in sweep search wear optimise fit; do
  expect_code 0 "$rpsup" $command $command.json --db alone.db --results alone.json
  answers >alone
  expect_code 0 "$rpsup" --url "$url" $command $command.json --results there.json
  answers >there
  cmp alone there || fail "$command answers otherwise by a service"
  expect_equal "$(rows_of there.json)" "$(rows_of alone.json)" "rows of $command by a service"
  [ "$command" = sweep ] || [ -s there ] || fail "$command gives no answer"
  cp err "err.$command"
done
expect_code 0 "$rpsup" search search.json --db alone.db --format csv
expect_text err '^clearance_mm at coupler = "rigid": always_exceeded, beyond the bound at 0.02$'
expect_code 0 "$rpsup" wear wear.json --db alone.db
expect_text err '^hours_reached: clearance 0\.25[0-9]* mm, deepest wear [0-9.]+ um after 100 h$'

# Kinds of requests, and ids of every kind.
export RPSUP_URL=$url
for command in search:search wear-study:wear optimisation:optimise; do
  expect_code 0 "$rpsup" submit --watch --kind ${command%:*} ${command#*:}.json
  id=$(cat out)
  expect_text err "^$id succeeded$"
  expect_code 0 "$rpsup" status "$id"
  expect_text out '^state +succeeded$'
  expect_text out '^sweep +swp_'
  expect_code 0 "$rpsup" results "$id" --limit 1
  expect_equal "$(wc -l <out | tr -d ' ')" 2 "the first row of a study"
  expect_code 2 "$rpsup" cancel "$id"
  expect_code 0 "$rpsup" open "$id"
  expect_code 0 "$rpsup" delete "$id"
done
expect_code 2 "$rpsup" submit --kind nothing search.json
expect_text err 'wear-study'
id=$(sed -n 's/^search \(sch_[a-z0-9]*\) at .*/\1/p' err.search)
expect_code 0 "$rpsup" status "$id"
expect_text out '^clearance_mm at coupler = "rigid": always_exceeded'
fit=$(sed -n 's/^fit \(fit_[a-z0-9]*\) at .*/\1/p' err.fit)
measurement=$(get "$url/v1/fits/$fit" | jq -r '.request.measurements[0].id')
expect_code 2 "$rpsup" delete "$measurement"
expect_code 0 "$rpsup" fit fit.json
expect_equal "$(get "$url/v1/measurements" | jq '.items | length')" 1 "measurements of a file that was sent twice"

# A study that is cancelled and tried again.
printf '{"parameters": {"duration_s": 300}, "hours": 100, "max_cycles": 3}' >long.json
id=$("$rpsup" submit --kind wear-study long.json)
expect_code 0 "$rpsup" cancel "$id"
expect_equal "$(cat out)" "$id cancelled" "what cancel says of a study"
expect_code 1 "$rpsup" watch "$id"
expect_code 0 "$rpsup" retry "$id"
expect_equal "$(cat out)" "$id running" "what retry says of a study"
expect_code 0 "$rpsup" cancel "$id"

# Where it is computed: --db or --url of the command line, then a store of the environment.
expect_code 2 "$rpsup" sweep sweep.json --db other.db --url "$url"
expect_text err '^rpsup: --db and --url exclude each other'
expect_code 2 "$rpsup" sweep sweep.json --threads 1
expect_text err '^rpsup: --threads needs --db'
RPSUP_DB=other.db expect_code 0 "$rpsup" sweep sweep.json --url "$url"
[ ! -e other.db ] || fail "a store was made beside a service"
RPSUP_DB=other.db expect_code 0 "$rpsup" sweep sweep.json
[ -e other.db ] || fail "the store of the environment was not used"
expect_code 0 "$rpsup" --db third.db sweep sweep.json
[ -e third.db ] || fail "the store before the command was not used"
stop_service TERM
expect_code 3 "$rpsup" search search.json
expect_text err "no answer from $url: nothing answers there.*--db"
echo "studies work with a store and by a service"
