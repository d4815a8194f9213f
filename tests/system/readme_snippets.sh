#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the snippets in other languages that a document shows below a line `<!-- run by a test, in LANGUAGE -->`, against a service that
# has a sweep.   readme_snippets.sh RPSUP DOCUMENT PACKAGE CLASS
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
readme=$2
export PYTHONPATH=$3 PYTHONDONTWRITEBYTECODE=1
class=$4

# snippet LANGUAGE: the block below the mark
snippet() {
  awk -v mark="<!-- run by a test, in $1 -->" '
    $0 == mark { marked = 1; next }
    marked && /^```[a-z]+$/ { inside = 1; marked = 0; blocks++; next }
    inside && /^```$/ { inside = 0; next }
    inside { print }
    END { if (blocks != 1) { print "not one block is marked as " mark > "/dev/stderr"; exit 1 } }
  ' "$readme" | sed -e "s#http://127\.0\.0\.1:8080#$url#g" -e "s#server/octave#$class#g"
}

# The one that comes with Debian first: another one on the path need not have its packages.
find_python() {
  for python in /usr/bin/python3 python3; do
    if "$python" -c 'import pandas' 2>/dev/null; then return 0; fi
  done
  return 1
}

start_service store.db
# The second job ends before its window: it has no peak, and stands before the one with the largest.
echo '{"parameters": {"run_up_s": 0.1}, "cases": [{"clearance_mm": 0, "coupler": "rigid", "duration_s": 0.3},
  {"clearance_mm": 0.1, "coupler": "rigid", "duration_s": 0.05}, {"clearance_mm": 0.25, "coupler": "rigid", "duration_s": 0.3},
  {"clearance_mm": 0.25, "coupler": "flexible", "duration_s": 0.3}]}' >sweep.json
id=$(submit sweep.json)
wait_for_end "$id"
# The largest peak of all, which both snippets are to find.
worst=$(get "$url/v1/sweeps/$id/results" | jq -c 'max_by(.peak_slider_acceleration_m_s2)')
peak=$(jq -r '.peak_slider_acceleration_m_s2 | . * 100 | round / 100' <<<"$worst")
expect_equal "$(get "$url/v1/sweeps/$id/results" | jq 'map(.peak_slider_acceleration_m_s2 == null) | index(true)')" 1 "the row without a peak"
skipped=

snippet Python >snippet.py
if find_python; then
  expect_code 0 "$python" snippet.py
  grep -qF "$peak" out || { cat out; fail "pandas does not show the peak $peak"; }
else
  skipped="$skipped pandas"
fi

snippet Octave >snippet.m
if command -v octave-cli >/dev/null; then
  expect_code 0 octave-cli --norc --quiet snippet.m
  grep -qF "$peak" out || { cat out; fail "Octave does not show the peak $peak"; }
  named=$(jq -r '"at \(.clearance_mm) mm, \(.coupler) coupler"' <<<"$worst")
  grep -qF "$named" out || { cat out; fail "Octave names another job than the one $named"; }
else
  skipped="$skipped Octave"
fi

stop_service TERM
expect_equal "$code" 0 "exit code of the service"
[ -z "$skipped" ] || { echo "skipped, because not installed:$skipped (script/setup all)"; exit 77; }
echo "the snippets of $readme work"
