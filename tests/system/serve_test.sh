#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup serve: a session with curl, a second instance, and how it ends.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

ulimit -S -n 256
start_service store.db
expect_equal "$(cat ready)" "rpsup listens on $url" "what stands on standard output"
expect_equal "$(get "$url/readyz" | jq -r .status)" ready "readiness"

# A sweep from the request to its results.
cat >sweep.json <<'JSON'
{"name": "session", "parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "sweep": {"clearance_mm": [0, 0.3]}}
JSON
get --include --data @sweep.json "$url/v1/sweeps" >created
expect_text created '^HTTP/1.1 201 '
place=$(tr -d '\r' <created | sed -n 's/^Location: //p')
id=${place##*/}
wait_for_end "$id"
expect_equal "$state" succeeded "state of the sweep"
get "$url$place/results" >rows.json
expect_equal "$(jq -c '[.[].clearance_mm]' rows.json)" '[0,0.3]' "rows"
results "$id" >rows.csv
expect_equal "$(wc -l <rows.csv | tr -d ' ')" 3 "lines of the CSV"

# One job and its trajectory.
job=$(jq -r '.[1].job_id' rows.json)
expect_equal "$(get "$url/v1/jobs/$job" | jq -c '.metrics.peak_slider_acceleration_m_s2')" \
  "$(jq -c '.[1].peak_slider_acceleration_m_s2' rows.json)" "the peak of the job and of its row"
get "$url/v1/jobs/$job/trajectory?channels=slider_acceleration_m_s2&from=0.05&to=0.06" >trajectory.json
expect_equal "$(jq -c '.columns.t_s | [length, first, last]' trajectory.json)" '[11,0.05,0.06]' "times"

# Results that the client has are not sent again. Results and trajectories have other forms, too.
tag=$(get --include "$url$place/results" | tr -d '\r' | sed -n 's/^ETag: //p')
expect_equal "$(status_of --header "If-None-Match: $tag" "$url$place/results")" 304 "results that the client has"
expect_equal "$(get "$url$place/results?format=ndjson&order_by=-clearance_mm&fields=clearance_mm" | jq -c .clearance_mm | tr '\n' ' ')" '0.3 0 ' "rows as lines"
get "$url/v1/jobs/$job/trajectory?format=npz" >trajectory.npz
/usr/bin/python3 -c 'import numpy; assert numpy.load("trajectory.npz")["t_s"].shape == (101,)'
expect_equal "$(get "$url/v1/jobs/$job/trajectory?points=10&channels=slider_acceleration_m_s2" | jq '.columns.t_s | length <= 10')" true "few points"

# A sweep that grows, is waited for and followed.
get --data '{"sweep": {"clearance_mm": [0.3, 0.4]}}' --output /dev/null "$url$place/extend"
expect_equal "$(get --header 'Prefer: wait=60' "$url$place" | jq -c '[.state, .counts.total, .request.sweep.clearance_mm]')" \
  '["succeeded",3,[0,0.3,0.4]]' "the extended sweep"
get --no-buffer "$url$place/events" >events
expect_equal "$(grep -c '^event: job' events)" 3 "events of jobs"
expect_equal "$(grep '^event: ' events | tail -n 1)" 'event: done' "the last event"
last=$(sed -n 's/^id: //p' events | tail -n 1)
expect_equal "$(status_of --header "Last-Event-ID: $last" "$url$place/events")" 204 "nothing to follow any more"
get -X POST --output /dev/null "$url$place/retry"
results "$id" >rows.csv

# A copy of the store, from the service and beside it.
get --output copy.db "$url/v1/store"
expect_equal "$(sqlite3 copy.db 'PRAGMA integrity_check; SELECT count(*) FROM jobs')" "$(printf 'ok\n3')" "the copy of the store"
expect_code 0 "$rpsup" export --db store.db beside.db
expect_equal "$(sqlite3 beside.db 'SELECT count(*) FROM jobs')" 3 "the copy beside the service"
expect_code 2 "$rpsup" export --db store.db beside.db
expect_text err 'exists already'
expect_code 2 "$rpsup" export --db nowhere.db other-copy.db
[ ! -e store.db.rpsup-copy ] || fail "a copy was left behind"

# Repeated parameters are not computed again: the metrics are those of the first job, whatever the new one is called.
echo '{"name": "again", "parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "sweep": {"clearance_mm": [0, 0.3, 0.4]}}' >again.json
again=$(submit again.json)
wait_for_end "$again"
expect_equal "$(results "$again")" "$(cat rows.csv)" "results of the same sweep again"

# The page asks for nothing of another site, and is served with a strict policy.
get --include "$url/" >page
expect_text page "^Content-Security-Policy: default-src 'none';"
! grep -E '(src|href)="(https?:)?//' page || fail "the page asks another site"

# A sweep above 8 KiB as `curl -d` sends it, as a form; and it may have many connections, whatever the shell allows.
{ cat sweep.json; head -c 20000 /dev/zero | tr '\0' ' '; } >padded.json
expect_equal "$(status_of --data @padded.json "$url/v1/sweeps")" 201 "a large request without a header of its own"
[ "$(awk '/^Max open files/ { print $4 }' "/proc/$service/limits")" -ge 4096 ] || fail "few files may be open"

# Refused requests.
expect_equal "$(status_of --data '{' "$url/v1/sweeps")" 400 "broken JSON"
expect_equal "$(status_of --data '{"sweep": {"clearance_mm": [-1]}}' "$url/v1/sweeps")" 422 "a clearance below zero"
expect_equal "$(status_of "$url/v1/sweeps/none")" 404 "no such sweep"
expect_equal "$(status_of -X PATCH "$url/v1/sweeps")" 405 "no such method"
expect_equal "$(status_of -H 'Host: evil.com' "$url/v1/sweeps")" 403 "another name"
expect_equal "$(status_of -X DELETE "$url/v1/sweeps/$again")" 204 "deleting"
expect_equal "$(status_of "$url/v1/sweeps/$again")" 404 "the deleted sweep"

# A second instance: the store is in use, the port is taken.
expect_code 3 "$rpsup" serve --db store.db --port 0
expect_text err 'rpsup: '
expect_code 3 "$rpsup" serve --db other.db --port "${url##*:}"
expect_text err 'cannot listen'
expect_code 3 "$rpsup" sweep sweep.json --db store.db

expect_code 2 "$rpsup" serve --db never.db --cors-origin 'https://lab.example.org,*'
expect_text err "cors-origin \*: must be like https://"
expect_code 2 "$rpsup" serve --db never.db --cors-origin https://lab.example.org/pages
expect_code 2 "$rpsup" serve --db never.db --base-path rpsup
expect_text err "base-path rpsup: must be like /rpsup"
expect_code 2 "$rpsup" serve --db never.db --base-path //rpsup
[ ! -e never.db ] || fail "a refused command has made a store"

# Cancelling ends a running job soon, although nothing is sent but the request line.
echo '{"parameters": {"duration_s": 500, "coupler": "flexible"}, "sweep": {"clearance_mm": [0.3, 0.4, 0.5]}}' >long.json
long=$(submit long.json)
for ((tenths = 0; tenths < 100; ++tenths)); do
  running=$(get "$url/v1/sweeps/$long" | jq .counts.running)
  [ "$running" -lt 2 ] || break
  sleep 0.1
done
expect_equal "$running" 2 "jobs that run on two threads"
get -X POST "$url/v1/sweeps/$long/cancel" >/dev/null
wait_for_end "$long"
expect_equal "$state" cancelled "state of the cancelled sweep"
# Both threads are free again, long before the jobs would have ended: another sweep is computed.
echo '{"parameters": {"duration_s": 0.01}}' >short.json
short=$(submit short.json)
wait_for_end "$short"
expect_equal "$state" succeeded "state of the sweep after the cancelled one"

# Ends soon and in order while jobs run; they are still there after a new start.
long=$(submit long.json)
started=$SECONDS
stop_service TERM
expect_equal "$code" 0 "exit code after SIGTERM"
[ $((SECONDS - started)) -le 5 ] || fail "the end took too long"
start_service store.db
case "$(get "$url/v1/sweeps/$long" | jq -r .state)" in queued | running) ;; *) fail "the sweep did not survive" ;; esac
get -X POST "$url/v1/sweeps/$long/cancel" >/dev/null
stop_service INT
expect_equal "$code" 0 "exit code after SIGINT"
echo "serve works"
