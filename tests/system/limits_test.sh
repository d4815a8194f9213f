#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup serve with limits: jobs that reach one fail with its name, a store that is full refuses, and everything else goes on.
#   limits_test.sh RPSUP [SANITIZER]
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
sanitizer=${2:-}

# reason PARAMETERS: why the job has failed
reason() {
  local job
  job=$(get --data "$1" "$url/v1/jobs" | jq -r .id)
  for ((tenths = 0; tenths < 300; ++tenths)); do
    case "$(get --output job "$url/v1/jobs/$job" && jq -r .state job)" in queued | running) sleep 0.1 ;; *) break ;; esac
  done
  jq -r '.error.reason // .state' job
}

start_service store.db --job-steps 20000 --job-memory-mb 2
expect_equal "$(reason '{"duration_s": 0.05, "run_up_s": 0.02}')" succeeded "a small job"
expect_equal "$(reason '{"integrator": "rk4", "duration_s": 1}')" step_limit "a job of 100,000 steps"
expect_equal "$(reason '{"duration_s": 60, "output_rate_hz": 1000}')" memory_limit "a job of 60,000 samples"
expect_text job 'output_rate_hz'
stop_service TERM

start_service store.db --job-time-s 0.5
expect_equal "$(reason '{"duration_s": 3000, "output_rate_hz": 10, "coupler": "flexible"}')" time_limit "a job that takes hours"
[ "$(jq '.error.t_s > 0 and .run.wall_time_s >= 0.5 and .run.wall_time_s < 5' job)" = true ] || { cat job; fail "the job was stopped at another time"; }
stop_service TERM

# The store may hold 1 MB.
start_service full.db --store-limit-mb 1
echo '{"parameters": {"duration_s": 0.1, "run_up_s": 0.05}, "sweep": {"clearance_mm": [0, 0.2]}}' >small.json
id=$(submit small.json)
wait_for_end "$id"
echo '{"sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 9000}}}' >large.json
expect_equal "$(curl --silent --max-time 100 --data @large.json --output answer --write-out '%{http_code}' "$url/v1/sweeps")" 507 "a sweep that has no room"
expect_equal "$(jq -r .detail answer)" 'the store may hold 1 MB and has no room for this; delete sweeps that are not needed any more' "what is said of it"
for path in /readyz /v1/sweeps "/v1/sweeps/$id" "/v1/sweeps/$id/results" /v1/jobs /v1/store; do
  expect_equal "$(status_of "$url$path")" 200 "reading $path"
done
expect_equal "$(get "$url/v1/sweeps" | jq '.items | length')" 1 "sweeps in the store"
again=$(submit small.json)
wait_for_end "$again"
expect_equal "$state" succeeded "a small sweep"
expect_equal "$(status_of -X DELETE "$url/v1/sweeps/$again")" 204 "deleting"
stop_service TERM
[ "$(stat --format=%s full.db)" -le 1100000 ] || fail "the store is larger than it may be"

# No disk has so much left: nothing new is taken, and everything else goes on.
start_service full.db --disk-reserve-mb 999999999
expect_equal "$(curl --silent --max-time 20 --data @small.json --output answer --write-out '%{http_code}' "$url/v1/sweeps")" 507 "a sweep on a disk without its reserve"
expect_equal "$(jq -r .detail answer | sed 's/has [0-9]* MB/has N MB/')" \
  'the disk that holds the store has N MB left, and 999999999 MB of it are kept free; make room on it, or delete sweeps that are not needed any more' "what is said of it"
for path in /readyz /v1/sweeps "/v1/sweeps/$id/results" /v1/store; do
  expect_equal "$(status_of "$url$path")" 200 "reading $path on such a disk"
done
expect_equal "$(status_of -X DELETE "$url/v1/sweeps/$id")" 204 "deleting on such a disk"
stop_service TERM

expect_code 2 "$rpsup" serve --db a.db --job-time-s -1
expect_code 2 "$rpsup" serve --db a.db --store-limit-mb many

# A bomb is refused before anything is allocated, with its size, and soon.
start_service bombs.db
before=$(awk '/^VmRSS:/ { print $2 }' "/proc/$service/status")
axes=$(for key in clearance_mm crank_velocity_rad_s restitution gravity_m_s2 duration_s; do printf '"%s": {"from": 0.5, "to": 0.6, "count": 9223372036854775807},' "$key"; done)
axes=${axes%,}
while read -r what body; do
  seconds=$(curl --silent --max-time 20 --data "$body" --output answer --write-out '%{http_code} %{time_total}' "$url/v1/sweeps")
  expect_equal "${seconds% *}" 422 "$what"
  echo "$what: refused in $(awk '{ printf "%.1f ms", 1000 * $2 }' <<<"$seconds"): $(jq -r '.errors[0].detail' answer)"
  awk '{ exit $2 < 1 ? 0 : 1 }' <<<"$seconds" || fail "$what took $seconds"
done <<EOB
axes {"sweep": {$axes}}
product {"sweep": {${axes//9223372036854775807/1000000000}}}
range {"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 1000000}}}
replicates {"sweep": {"clearance_mm": [0.1]}, "replicates": {"count": 1000000000}}
design {"design": {"type": "sobol", "count": 9223372036854775807, "over": {"clearance_mm": {"from": 0.05, "to": 0.5}}}}
count {"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 1e300}}}
step {"parameters": {"integrator": "rk4", "duration_s": 3600, "output_rate_hz": 10, "step_s": 1e-8}}
samples {"parameters": {"duration_s": 3600, "output_rate_hz": 100000}}
elements {"parameters": {"coupler": "flexible", "rigid_elements": 1000000}}
EOB
# Bodies too large for a command line: as many cases as fit, and 200 bodies, each a beam.
jq --null-input --compact-output '{cases: [range(300000) | {}]}' >cases.json
jq --null-input '{linkage: {bodies: ([range(200) | {key: "b\(.)", value: {mass_kg: 1, beam: {length_m: 1, diameter_mm: 9, elements: 64}}}] | from_entries),
  joints: ([range(200) | {key: "j\(.)", value: {kind: "free", from: (if . == 0 then "ground" else "b\(. - 1)" end), to: "b\(.)"}}] | from_entries)}}' >beams.json
jq '{parameters: .}' beams.json >beams_sweep.json
for body in cases beams_sweep; do
  seconds=$(curl --silent --max-time 20 --data @$body.json --output answer --write-out '%{http_code} %{time_total}' "$url/v1/sweeps")
  expect_equal "${seconds% *}" 422 "$body"
  echo "$body: refused in $(awk '{ printf "%.1f ms", 1000 * $2 }' <<<"$seconds"): $(jq -r '.errors[0].detail' answer)"
done

# A body that is small until it is decoded: 256 MiB of blanks.
head -c 268435456 /dev/zero | tr '\0' ' ' | gzip -1 >bomb.gz
seconds=$(curl --silent --max-time 20 --header 'Content-Encoding: gzip' --data-binary @bomb.gz --output answer --write-out '%{http_code} %{time_total}' "$url/v1/sweeps")
expect_equal "${seconds% *}" 413 "a body that grows when it is decoded"
echo "$(stat --format=%s bomb.gz) bytes that decode to 256 MiB: refused in $(awk '{ printf "%.1f ms", 1000 * $2 }' <<<"$seconds")"

grown=$(($(awk '/^VmRSS:/ { print $2 }' "/proc/$service/status") - before))
echo "resident memory grew by $grown kB"
# The thread sanitizer keeps several times of its own for each byte that was ever used.
[ "$sanitizer" = thread ] || [ "$grown" -lt 32768 ] || fail "the bombs took $grown kB"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"
