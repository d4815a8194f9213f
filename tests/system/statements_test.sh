#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup paper: results of sweeps held against the paper's statements, by rows whose peaks are known.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

# rows_of COUPLER PEAKS: JSON rows of 0, 0.25 and 0.5 mm at 10 and 15 rad/s each
rows_of() {
  jq -cn --arg coupler "$1" --argjson peaks "$2" '[[0, 0.25, 0.5][] as $c | [10, 15][] as $v | [$c, $v]] | to_entries
    | map({job_id: "job_\(.key)", state: "succeeded", clearance_mm: .value[0], crank_velocity_rad_s: .value[1],
           coupler: $coupler, peak_slider_acceleration_m_s2: $peaks[.key]})'
}
# Growths by 8.5 and 3.5 of the rigid coupler, by 4 and 1.25 of the flexible one.
rows_of rigid '[40, 90, 100, 850, 200, 700]' >rigid.json
rows_of flexible '[40, 90, 80, 320, 200, 250]' >flexible.json

# Two files are one study.
expect_code 0 "$rpsup" paper rigid.json flexible.json
expect_equal "$(grep -cE '^[1-7] .* holds$' out)" 7 "statements that hold"
expect_text out '^2  peak at 15 rad/s over that at 10 rad/s, 0\.25 mm, rigid coupler +8\.5 +8\.5 +holds$'
expect_text out '^5  .* 0\.5 mm, flexible coupler +1\.25 +1\.25 +holds$'
expect_text out '^6  .* below 1 +0\.781 to 0\.824 +holds$'
expect_text out '^   peak with 0\.5 mm over that with 0\.25 mm at 10 rad/s, .* 2 to 2\.5 +does not hold$'
expect_equal "$(wc -l <out | tr -d ' ')" 10 "lines: a heading, seven statements, two at 10 rad/s"
expect_equal "$(wc -c <err | tr -d ' ')" 0 "bytes on standard error"

# Standard input; a statement without its peaks is open.
expect_code 0 "$rpsup" paper - <rigid.json
expect_text out '^2 .* 8\.5 +8\.5 +holds$'
expect_text out '^3 .* 4 +- +-$'

# Peaks that spoil a statement, and several settings.
jq -c 'map(if .clearance_mm == 0.25 and .crank_velocity_rad_s == 10
  then .peak_slider_acceleration_m_s2 = 425 else . end)' rigid.json >slow.json
expect_code 0 "$rpsup" paper slow.json flexible.json
expect_text out '^2 .* 8\.5 +2 +does not hold$'
jq -cs '[(.[0] + .[2])[] + {restitution: 0.9}, ((.[1] + .[2])[] + {restitution: 0.5})]' \
  rigid.json slow.json flexible.json >settings.json
expect_code 0 "$rpsup" paper settings.json
expect_text out '^2 .* 5\.25 +in 50 %$'
expect_text out '^3 .* 4 +in 100 %$'
expect_equal "$(grep -c 'sensitivity' out || true)" 0 "tables of indices of two settings"

# From 50 settings on it tells what decides each ratio. Here the restitution alone decides the growth of the rigid coupler
# with 0.25 mm, and nothing changes that with 0.5 mm.
jq -c '[range(60) as $k | .[]
  | . + {restitution: (0.5 + 0.1 * ($k % 5)), friction_static: (0.1 + 0.01 * ($k / 5 | floor))}
  | if .clearance_mm == 0.25 and .crank_velocity_rad_s == 15
    then .peak_slider_acceleration_m_s2 *= .restitution else . end]' rigid.json >many.json
expect_code 0 "$rpsup" paper many.json
expect_text out '^first-order sensitivity indices'
expect_text out '^2  restitution 1\.00 *$'
expect_text out '^4 *$'

# The program's own results are read. A study of one velocity leaves the growths open.
cat >sweep.json <<'JSON'
{"parameters": {"duration_s": 0.1, "run_up_s": 0.05},
 "sweep": {"clearance_mm": [0, 0.5], "crank_velocity_rad_s": [15], "coupler": ["rigid", "flexible"]}}
JSON
expect_code 0 "$rpsup" sweep sweep.json --db store.db --results own.json
expect_code 0 "$rpsup" paper own.json
expect_text out '^1 .*every velocity +1 +[0-9.]+( to [0-9.]+)? +(holds|does not hold)$'
expect_text out '^2 .* 8\.5 +- +-$'

# Bad input: 2, one line says why, nothing on standard output.
# refused FILE TEXT
refused() {
  expect_code 2 "$rpsup" paper "$1"
  expect_text err "$2"
  expect_equal "$(wc -c <out | tr -d ' ')" 0 "bytes on standard output"
}
echo '{"rows": []}' >object.json
refused object.json 'object\.json: is no list of rows'
echo '[1]' >number.json
refused number.json 'number\.json: a row is no object'
echo '[{' >broken.json
refused broken.json 'broken\.json: not JSON'
refused missing.json 'cannot read missing\.json'
for axis in clearance_mm crank_velocity_rad_s coupler; do
  jq -c "map(del(.$axis))" rigid.json >without.json
  refused without.json "does not vary $axis"
done
echo '[]' >empty.json
refused empty.json 'does not vary clearance_mm'
jq -c 'map(del(.peak_slider_acceleration_m_s2))' rigid.json >peakless.json
refused peakless.json 'peak_slider_acceleration_m_s2'
expect_code 2 "$rpsup" paper
echo "the paper's statements are held against results"
