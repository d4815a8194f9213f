#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the snippets in other languages that a document shows below a line `<!-- run by a test, in LANGUAGE -->`, against a service that
# has a sweep.   readme_snippets.sh RPSUP DOCUMENT
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
readme=$2

# snippet LANGUAGE: the block below the mark
snippet() {
  awk -v mark="<!-- run by a test, in $1 -->" '
    $0 == mark { marked = 1; next }
    marked && /^```[a-z]+$/ { inside = 1; marked = 0; blocks++; next }
    inside && /^```$/ { inside = 0; next }
    inside { print }
    END { if (blocks != 1) { print "not one block is marked as " mark > "/dev/stderr"; exit 1 } }
  ' "$readme" | sed "s#http://127\.0\.0\.1:8080#$url#g"
}

# The one that comes with Debian first: another one on the path need not have its packages.
find_python() {
  for python in /usr/bin/python3 python3; do
    if "$python" -c 'import pandas' 2>/dev/null; then return 0; fi
  done
  return 1
}

start_service store.db
echo '{"parameters": {"duration_s": 0.3, "run_up_s": 0.1}, "sweep": {"clearance_mm": [0, 0.25], "coupler": ["rigid", "flexible"]}}' >sweep.json
id=$(submit sweep.json)
wait_for_end "$id"
# What both are to find: the largest peak of all.
peak=$(get "$url/v1/sweeps/$id/results" | jq -r 'map(.peak_slider_acceleration_m_s2) | max | . * 100 | round / 100')
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
else
  skipped="$skipped Octave"
fi

stop_service TERM
expect_equal "$code" 0 "exit code of the service"
[ -z "$skipped" ] || { echo "skipped, because not installed:$skipped (script/setup all)"; exit 77; }
echo "the snippets of $readme work"
