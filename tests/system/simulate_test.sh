#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# rpsup simulate: exit codes, outputs, and how faults are told.
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"

echo '{"duration_s": 0.1, "run_up_s": 0.05, "clearance_mm": 0.3}' >job.json

expect_code 0 "$rpsup" simulate job.json --trajectory t.csv
expect_equal "$(jq -r .state out)" succeeded "state"
expect_equal "$(jq -r .parameters.clearance_mm out)" 0.3 "a parameter that was given"
expect_equal "$(jq -r .parameters.restitution out)" 0.9 "a default that was filled in"
jq -e '.metrics.peak_slider_acceleration_m_s2 > 0' out >/dev/null || fail "no peak"
expect_equal "$(head -n 1 t.csv | cut -d, -f1)" t_s "the first channel"
# 0 to 0.1 s at 1000 Hz, both ends included, and a heading.
expect_equal "$(wc -l <t.csv | tr -d ' ')" 102 "lines of the trajectory"
expect_equal "$(tail -n 1 t.csv | cut -d, -f1)" 0.1 "the last sample's time"
mv out first.json

# The same parameters give the same bytes, from standard input too.
expect_code 0 "$rpsup" simulate - --trajectory second.csv <job.json
cmp t.csv second.csv
expect_equal "$(jq -cS .metrics out)" "$(jq -cS .metrics first.json)" "metrics of a second run"

# Channels that are asked for, and only those, as JSON with the same numbers.
expect_code 0 "$rpsup" simulate job.json --trajectory t.json --channels slider_position_m,contact_force_n
expect_equal "$(jq -c '.channels | sort' t.json)" '["contact_force_n","slider_position_m","t_s"]' "channels"
column=$(head -n 1 t.csv | tr ',' '\n' | tr -d '\r' | grep -nx slider_position_m | cut -d: -f1)
expect_equal "$(jq -c '.columns.slider_position_m[50]' t.json)" \
  "$(sed -n 52p t.csv | tr -d '\r' | cut -d, -f"$column" | jq -c .)" "a sample in JSON and CSV"

# The same numbers for NumPy, each channel an array.
expect_code 0 "$rpsup" simulate job.json --trajectory t.npz
/usr/bin/python3 - <<'PYTHON'
import json
import numpy
arrays = numpy.load("t.npz")
header = open("t.csv").readline().strip().split(",")
table = numpy.genfromtxt("t.csv", delimiter=",", skip_header=1)
assert sorted(arrays.files) == sorted(header), arrays.files
for column, key in enumerate(header):
    assert arrays[key].dtype == numpy.float64
    assert numpy.array_equal(arrays[key], table[:, column], equal_nan=True), key
assert json.load(open("t.json"))["columns"]["slider_position_m"] == arrays["slider_position_m"].tolist()
PYTHON
# Drawn in characters below the JSON, on standard error, or into a file; beside the trajectory, too.
expect_code 0 "$rpsup" simulate --plot job.json --trajectory plotted.csv
cmp plotted.csv second.csv
expect_text err '^slider acceleration, m/s\^2$'
expect_text err ' 0 \|[^ ]*'
expect_text err '0\.1 s$'
jq -e .metrics out >/dev/null || fail "the plot has got into the JSON"
LC_ALL=C.UTF-8 expect_code 0 "$rpsup" simulate job.json --plot
grep -q $'\xe2\xa0\|\xe2\xa1\|\xe2\xa2\|\xe2\xa3' err || fail "no Braille in a UTF-8 locale"
expect_code 0 "$rpsup" simulate job.json --plot plot.svg
expect_text plot.svg '^<svg '
expect_text plot.svg '</svg>$'
expect_equal "$(wc -c <err | tr -d ' ')" 0 "bytes on standard error beside a plot in a file"
expect_code 2 "$rpsup" simulate job.json --plot=plot.png
expect_text err 'must end in .svg'
expect_code 2 "$rpsup" simulate job.json --plot nowhere/plot.svg

# Bad input: 2, each fault on a line with its pointer, nothing on standard output.
echo '{"clearance_mm": -1, "nonsense": 1}' >bad.json
expect_code 2 "$rpsup" simulate bad.json
expect_text err '^/clearance_mm: '
expect_text err '^/nonsense: '
expect_equal "$(wc -c <out | tr -d ' ')" 0 "bytes on standard output"
echo '{"clearance_mm": }' >broken.json
expect_code 2 "$rpsup" simulate broken.json
expect_text err 'broken.json: not JSON at byte 18'
expect_code 2 "$rpsup" simulate missing.json
expect_text err 'cannot read missing.json'
for name in t.txt t.ndjson t.parquet; do
  expect_code 2 "$rpsup" simulate job.json --trajectory $name
  expect_text err "^rpsup: --trajectory $name: the name of a trajectory must end in \.json, \.csv or \.npz$"
done
expect_code 0 "$rpsup" simulate job.json --trajectory plain --format json
expect_equal "$(jq -r '.channels[0]' plain)" t_s "format of a name without suffix"
expect_code 0 "$rpsup" simulate job.json --trajectory UPPER.CSV
cmp UPPER.CSV t.csv
expect_code 2 "$rpsup" simulate job.json --trajectory u.csv --format npz
expect_text err '^rpsup: --trajectory u.csv: ends in .csv, but --format is npz$'
expect_code 2 "$rpsup" simulate job.json --trajectory u --format ndjson
expect_text err '^rpsup: --format ndjson: a trajectory is json, csv or npz$'
expect_code 2 "$rpsup" simulate job.json --trajectory -
[ ! -e u ] && [ ! -e u.csv ] || fail "a refused output was written"
expect_code 2 "$rpsup" simulate job.json --trajectory nowhere/t.csv
expect_text err 'no folder'
expect_code 2 "$rpsup" simulate job.json --trajectory t.csv --channels no_such_channel
expect_text err '^--channels: .*no_such_channel.*slider_position_m'
expect_code 2 "$rpsup" simulate job.json --unknown-option
expect_code 2 "$rpsup" simulate
expect_code 2 "$rpsup"

# The machine fails: 3.
ln -s /dev/full full.csv
expect_code 3 "$rpsup" simulate job.json --trajectory full.csv
expect_text err 'cannot write full.csv'

# A job that fails: 1, and its reason is told.
echo '{"duration_s": 0.1, "integrator": "rk4", "step_s": 1e-3, "coupler": "flexible"}' >fails.json
expect_code 1 "$rpsup" simulate fails.json
expect_equal "$(jq -r .state out)" failed "state of a job whose step is too long for its coupler"
jq -e '.error' out >/dev/null || fail "no reason"

# Help and version.
for words in --help "simulate --help" "sweep --help" "serve --help" --version; do
  # shellcheck disable=SC2086  # the words are arguments
  expect_code 0 "$rpsup" $words
  expect_text out rpsup
done
echo "simulate works"
