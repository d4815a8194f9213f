#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every test that the tables of tests/README.md name is there, and every TEST of a source is in a program that ctest runs; heavy
# ones may run as a group:
#   named_tests_exist.sh SOURCE-FOLDER BUILD-FOLDER
set -euo pipefail
tests=$(ctest --test-dir "$2" --show-only | sed -n 's/^ *Test *#[0-9]*: //p')
[ -n "$tests" ] || { echo "there are no tests in $2"; exit 1; }
rows=0 bad=0
while IFS='|' read -r _ row _ names _; do
  rows=$((rows + 1))
  for name in $(grep -o '`[^`]*`' <<<"$names" | tr -d '`'); do
    pattern=$(sed 's/[.]/[.]/g; s/[*]/.*/g' <<<"$name")
    grep -qxE "$pattern" <<<"$tests" || { echo "$row names a test that is not there: $name"; bad=1; }
  done
done < <(grep -E '^\| ([PRS][0-9]+|`[^|]*|every document) \|' "$1/tests/README.md")
[ "$rows" -ge 50 ] || { echo "the tables have $rows rows instead of 50 or more"; bad=1; }
written=$(find "$1/tests" -name '*.cc' -exec sed -nE '/, *Heavy/d; s/^TEST(_F)?\((\w+), *(\w+)\).*/\2.\3/p' {} +)
[ "$(wc -l <<<"$written")" -ge 1000 ] || { echo "the sources have less than 1000 tests"; bad=1; }
missing=$(comm -23 <(sort -u <<<"$written") <(grep -oE '[A-Za-z0-9_]+[.][A-Za-z0-9_]+$' <<<"$tests" | sort -u))
[ -z "$missing" ] || { echo "no program has these tests: $(tr '\n' ' ' <<<"$missing")"; bad=1; }
exit "$bad"
