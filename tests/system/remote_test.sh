#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup submit, status, watch, results, cancel: a session with a service that runs, and what is said when there is none.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

start_service store.db
export RPSUP_URL=$url

cat >sweep.json <<'JSON'
{"name": "a session", "parameters": {"duration_s": 0.2, "run_up_s": 0.05}, "sweep": {"clearance_mm": [0, 0.3], "coupler": ["rigid", "flexible"]}}
JSON

# From the request to its results: each byte as the service gives it.
expect_code 0 "$rpsup" submit sweep.json
id=$(cat out)
expect_equal "$(get "$url/v1/sweeps/$id" | jq -r .name)" 'a session' "the sweep that was submitted"
expect_code 0 "$rpsup" watch "$id"
expect_text err '^4 of 4 jobs$'
expect_text err "^$id succeeded$"
expect_equal "$(wc -c <out | tr -d ' ')" 0 "bytes on standard output of watch"
expect_code 0 "$rpsup" results "$id"
cmp out <(get "$url/v1/sweeps/$id/results?format=csv")
expect_code 0 "$rpsup" results "$id" --format json --output rows.json
cmp rows.json <(get "$url/v1/sweeps/$id/results")
expect_code 0 "$rpsup" results "$id" --format ndjson
cmp out <(get "$url/v1/sweeps/$id/results?format=ndjson")
expect_code 0 "$rpsup" status "$id"
expect_text out '^state +succeeded$'
expect_text out '^jobs +4: 4 succeeded$'
expect_code 0 "$rpsup" status
expect_text out "^$id +succeeded +100 % +- +4  a session$"
expect_code 0 "$rpsup" status "$id" --json
expect_equal "$(jq -r .id out)" "$id" "the resource as JSON"

# From standard input, to its end. The bar of a terminal is drawn over itself; `script` makes one.
expect_code 0 "$rpsup" submit - --watch <sweep.json
expect_text err ' succeeded$'
if has_terminals; then
  script --quiet --return --command "$rpsup watch $id" terminal </dev/null >/dev/null
  grep -qF '[##############################] 100 %  4 of 4 jobs' terminal || fail "no bar on a terminal"
fi

# A name that would forge a row, rename the window and clear the line.
printf '%s' '{"name": "x\u001b]0;owned\u0007\u001b[2K\r\nswp_0  failed\u009b2J\u202e ü", "parameters": {"duration_s": 0.02, "run_up_s": 0.01}}' >forged.json
expect_code 0 "$rpsup" submit --watch forged.json
forged=$(cat out)
shown='x\x1b]0;owned\x07\x1b[2K\x0d\x0aswp_0  failed\u{009b}2J\u{202e} ü'
expect_code 0 "$rpsup" status
grep -qF "$shown" out || fail "the name is not shown as text: $(cat -v out)"
expect_equal "$(tr -d '\n -~ü' <out | wc -c | tr -d ' ')" 0 "control characters in the list"
expect_code 0 "$rpsup" status "$forged"
grep -qF "$shown" out || fail "the name is not shown as text: $(cat -v out)"
expect_code 0 "$rpsup" status "$forged" --json
expect_equal "$(jq -r .name out | tail -n 1 | cut -c1-13)" 'swp_0  failed' "the name in the JSON, as it was sent"
if has_terminals; then
  script --quiet --return --command "$rpsup status $forged --json" terminal </dev/null >/dev/null
  if grep -qP '\xc2\x9b' terminal; then fail "a control character of the JSON has reached the terminal"; fi
fi

# One job, watched and cancelled.
echo '{"duration_s": 500}' >long.json
expect_code 0 "$rpsup" submit --job long.json
job=$(cat out)
expect_code 0 "$rpsup" status "$job"
expect_text out '^state +(queued|running)$'
expect_code 0 "$rpsup" cancel "$job"
expect_equal "$(cat out)" "$job cancelled" "what cancel says"
expect_code 1 "$rpsup" watch "$job"
expect_code 2 "$rpsup" cancel "$id"
expect_text err '^rpsup: the sweep has ended'

# A job that fails: 1.
echo '{"parameters": {"duration_s": 0.05, "integrator": "rk4", "step_s": 1e-3}, "sweep": {"clearance_mm": [0, 0.25]}}' >fails.json
expect_code 1 "$rpsup" submit --watch fails.json
failed=$(cat out)
expect_text err '1 failed'
expect_code 1 "$rpsup" status "$failed"
expect_text out '^jobs +2: .*1 failed'
expect_code 1 "$rpsup" status "$("$rpsup" results "$failed" --format json | jq -r '.[] | select(.state == "failed") | .job_id')"
expect_text out '^error +[a-z_]+: '

# Bad input: 2, every fault with its place, as without a service.
echo '{"parameters": {"nonsense": 1}, "sweep": {"clearance_mm": [-1]}}' >bad.json
expect_code 2 "$rpsup" submit bad.json
expect_text err '^/parameters/nonsense: '
expect_text err '^/sweep/clearance_mm/0: '
expect_code 2 "$rpsup" submit missing.json
expect_code 2 "$rpsup" status none
expect_text err '^rpsup: status none: is no id of a sweep, job, search, wear study, optimisation, fit or measurement$'
expect_code 2 "$rpsup" status swp_none
expect_text err '^rpsup: there is no sweep swp_none$'
expect_code 2 "$rpsup" results none
expect_code 2 "$rpsup" watch ../../healthz
expect_code 2 "$rpsup" status --url 127.0.0.1:8080
expect_text err 'must be like http://'
expect_code 2 "$rpsup" results "$id" --format xml
expect_code 2 "$rpsup" results "$id" --output nowhere/rows.csv

# Interrupted, watching ends and the sweep goes on. A service that is started again is found again.
echo '{"parameters": {"duration_s": 300}, "sweep": {"clearance_mm": [0.3, 0.4]}}' >longer.json
id=$("$rpsup" submit longer.json)
: >watched
"$rpsup" watch "$id" 2>watched &
watcher=$!
for ((tenths = 0; tenths < 100; ++tenths)); do
  ! grep -q '^0 of 2' watched || break
  sleep 0.1
done
stop_service TERM
for ((tenths = 0; tenths < 100; ++tenths)); do
  ! grep -q 'trying again' watched || break
  sleep 0.1
done
expect_text watched "no answer from $url: nothing answers there.*trying again"
: >ready
"$rpsup" serve --db store.db --port "${url##*:}" >ready 2>>log &
service=$!
until grep -q listens ready; do sleep 0.1; done
"$rpsup" cancel "$id" >/dev/null
code=0
wait "$watcher" || code=$?
expect_equal "$code" 1 "exit code of a watch over a sweep that was cancelled"
expect_text watched "^$id cancelled$"
id=$("$rpsup" submit longer.json)
: >watched
"$rpsup" watch "$id" 2>watched &
watcher=$!
until grep -q '^0 of 2' watched; do sleep 0.1; done
kill -TERM "$watcher"
code=0
wait "$watcher" || code=$?
expect_equal "$code" 130 "exit code of an interrupted watch"
expect_text watched 'goes on'
case "$(get "$url/v1/sweeps/$id" | jq -r .state)" in queued | running) ;; *) fail "the sweep did not go on" ;; esac
"$rpsup" cancel "$id" >/dev/null

# Where the service is: command line before environment, that before the file, which has it once for all commands.
unset RPSUP_URL
mkdir -p config/rpsup
printf 'url=%s\ntoken=abc\n[results]\nformat=json\n' "$url" >config/rpsup/config.ini
chmod 600 config/rpsup/config.ini
expect_code 0 "$rpsup" status "$id"
expect_code 0 "$rpsup" results "$id"
expect_text out '^\{"job_id"'
RPSUP_FORMAT=csv expect_code 0 "$rpsup" results "$id"
expect_text out '^job_id,'
RPSUP_URL=http://127.0.0.1:1 expect_code 3 "$rpsup" status "$id"
expect_text err 'no answer from http://127.0.0.1:1: nothing answers there; is the service running'
RPSUP_URL=http://127.0.0.1:1 expect_code 0 "$rpsup" status "$id" --url "$url"
printf 'url=%s\n[serve]\nurl=%s\n' "$url" "$url" >wrong.ini
expect_code 2 "$rpsup" --config wrong.ini status "$id"
printf 'uri=%s\n' "$url" >wrong.ini
expect_code 2 "$rpsup" --config wrong.ini status "$id"
expect_text err uri

# Nothing is there: 3, and at once.
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
echo '{}' >one.json
for words in "submit one.json" "submit --job one.json" status "status $id" "watch $id" "results $id" "cancel $id"; do
  # shellcheck disable=SC2086  # the words are arguments
  expect_code 3 "$rpsup" $words
  expect_text err "no answer from $url: nothing answers there"
done
echo "the commands that speak to a service work"
